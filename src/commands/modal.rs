//! `trackbed modal`: natural frequencies and modes of the solid.

use crate::cli::ModalArgs;
use trackbed_input::model::{read_scene, solid};
use trackbed_io::columns::modes;
use trackbed_io::failure::Failure;
use trackbed_run as run;

use std::fmt::Write;
use std::path::Path;
use trackbed_fem as fem;
use trackbed_fem::modal::{ModalError, Modes};
use trackbed_input::scene::Document;
use trackbed_input::scene::units::vector;
use trackbed_io::write;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::pvd;

/// Masses whose squares are accurate [kg].
const MASS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// Writes `modes.csv`, `results.pvd` and a `.vtu` per mode.
///
/// # Errors
/// Input errors; missing modes.
pub fn modal(args: &ModalArgs) -> Result<String, Failure> {
    let mut document = Document::open(&args.scene)?;
    document.set_all(&args.set)?;
    let scene = read_scene(&document)?;
    let Some(part) = &scene.solid else {
        return Err(document.error("solid", "nothing", "a solid").into());
    };
    run::thread_pool(args.threads)?.install(|| {
        // Sleepers are free on the grains.
        let part = solid::build(&document, part, vector(&scene.gravity), true, None)?;
        let unknowns = part.model.free_dof_count();
        if args.count == 0 || args.count > unknowns {
            let expected = format!("1 to {unknowns} (number of unknowns)");
            return Err(Failure::Input(format!("-n: found {}, expected {expected}", args.count)));
        }
        let mass = part.model.total_mass();
        if mass > 0.0 && !MASS.contains(&mass) {
            return Err(document.beyond_range("the square of the mass of the solid").into());
        }
        let modes = fem::modal::solve(&part.model, args.count).map_err(|e| match e {
            ModalError::Solve(e) => part.failure(&e),
            other => Failure::Numerical(format!("modes: {other}")),
        })?;
        let dir = args.out.clone().unwrap_or_else(|| {
            let mut folder = run::default_folder(&args.scene, &args.set).into_os_string();
            folder.push("_modes");
            folder.into()
        });
        let _lock = run::Lock::take(&dir)?;
        if dir.join("results.pvd").exists() && !dir.join("modes.csv").exists() {
            let found = "an unrelated results.pvd";
            return Err(Failure::Input(format!("{}: found {found}, expected another --out", dir.display())));
        }
        write_modes(&part.model, &modes, &dir)?;
        let mut text = format!("{}\n  mode  frequency [Hz]  effective mass x, y, z [kg]\n", scene.title);
        for (i, f) in modes.frequencies.iter().enumerate() {
            let [x, y, z] = modes.effective_mass[i];
            writeln!(text, "  {:4}  {f:14.6}  {x:.4e} {y:.4e} {z:.4e}", i + 1)
                .expect("writing to a string does not fail");
        }
        if !part.model.is_linear() {
            text += "  note: plastic materials vibrate with their elastic stiffness\n";
        }
        let total = part.model.total_mass();
        writeln!(text, "  total mass {total:.6e} kg; modes in {}", dir.display())
            .expect("writing to a string does not fail");
        Ok(text)
    })
}

const MODES: [Field<[f64; 6]>; 6] = [
    (modes::MODE, |r| r[0]),
    (modes::FREQUENCY, |r| r[1]),
    (modes::RESIDUAL, |r| r[2]),
    (modes::EFFECTIVE_MASS_X, |r| r[3]),
    (modes::EFFECTIVE_MASS_Y, |r| r[4]),
    (modes::EFFECTIVE_MASS_Z, |r| r[5]),
];

fn write_modes(model: &fem::Model, modes: &Modes, dir: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(dir.join("frames"))
        .map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
    let row = |i: usize| {
        let [x, y, z] = modes.effective_mass[i];
        [(i + 1) as f64, modes.frequencies[i], modes.residuals[i], x, y, z]
    };
    write_table(&dir.join("modes.csv"), &MODES, (0..modes.shapes.len()).map(row))?;
    let mut series = pvd::Series::new(&dir.join("results.pvd"));
    for (i, shape) in modes.shapes.iter().enumerate() {
        let largest = shape.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let unit: Vec<f64> = shape.iter().map(|u| u / largest).collect();
        let name = format!("frames/mode_{:03}.vtu", i + 1);
        write::vtu::write_mode(&dir.join(&name), model.mesh(), &unit)?;
        series.push((i + 1) as f64, 0, "mode", &name);
    }
    series.write()?;
    Ok(())
}
