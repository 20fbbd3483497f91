//! A static solid: one solve, its reactions, its tables.

use super::frames;
use super::summary::{StageRecord, StaticsRecord, Summary};
use crate::failure::Failure;
use crate::model::Job;
use crate::model::solid::SolidPart;
use crate::write::csv::{Column, History};
use crate::write::pvd;
use std::path::Path;
use std::time::Instant;
use trackbed_fem as fem;
use trackbed_fem::State;
use trackbed_fem::element::stiffness_points;
use trackbed_fem::model::Model;

/// Solves the static problem of a scene and writes its results into `dir`, which `prepare` makes once there is a
/// solution.
///
/// # Errors
/// The body is not held, or the result is no solution.
pub fn run(
    job: &Job,
    solid: &SolidPart,
    dir: &Path,
    prepare: impl Fn() -> Result<(), Failure>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    let begun = Instant::now();
    let model = &solid.model;
    let mut load = model.gravity_load();
    solid.add_loads(0.0, &mut load);
    let result = fem::statics::solve(model, &load).map_err(|e| solid.failure(&e))?;
    let mut state = fem::state::State::new(model);
    state.u.copy_from_slice(&result.u);

    prepare()?;
    let vtu = dir.join("frames/solid_00000.vtu");
    let dat = dir.join("tecplot/solid_00000.dat");
    let view = super::system::SolidView { model, state: &state };
    frames::write_solid(
        view,
        job.output.vtk.then_some(vtu.as_path()),
        job.output.tecplot.then_some((dat.as_path(), 0.0)),
    )?;
    if job.output.vtk {
        let mut series = pvd::Series::new(&dir.join("results.pvd"));
        series.push(0.0, 0, "solid", "frames/solid_00000.vtu");
        series.write()?;
    }
    if job.output.tables {
        write_tables(model, &state, &result.reactions, dir)?;
    }

    let (mut total, mut reaction, mut scale) = ([0.0; 3], [0.0; 3], 0.0);
    for (i, (l, r)) in load.iter().zip(&result.reactions).enumerate() {
        total[i % 3] += l;
        reaction[i % 3] += r;
        scale += l.abs() + r.abs();
    }
    let imbalance: f64 = (0..3).map(|d| (total[d] + reaction[d]).powi(2)).sum::<f64>().sqrt();
    let length = |n: usize| result.u[3 * n..3 * n + 3].iter().map(|u| u * u).sum::<f64>().sqrt();
    let farthest =
        (0..model.mesh().node_count()).max_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
    summary.statics = Some(StaticsRecord {
        load: total,
        reaction,
        equilibrium_error: if scale > 0.0 { imbalance / scale } else { 0.0 },
        largest_displacement: (length(farthest), model.mesh().node_ids[farthest]),
        strain_energy: fem::energy::strain(model, &state),
    });
    summary.stages.push(StageRecord {
        name: "static".into(),
        seconds: begun.elapsed().as_secs_f64(),
        grain_steps: 0,
        solid_steps: 1,
    });
    Ok(())
}

/// Writes `nodes.csv` (displacement and reaction of every node) and `gauss.csv` (stress at every Gauss point; of a plastic
/// solid also the equivalent plastic strain).
///
/// # Errors
/// A value is not finite, or the disk refuses.
pub fn write_tables(model: &Model, state: &State, reactions: &[f64], dir: &Path) -> Result<(), Failure> {
    let (mesh, u) = (model.mesh(), &state.u);
    let columns =
        |names: &[(&str, &str)]| names.iter().map(|(n, unit)| Column::new(*n, *unit)).collect::<Vec<_>>();
    let mut nodes = History::create(
        &dir.join("nodes.csv"),
        columns(&[
            ("node", ""),
            ("ux", "m"),
            ("uy", "m"),
            ("uz", "m"),
            ("rx", "N"),
            ("ry", "N"),
            ("rz", "N"),
        ]),
    )?;
    for (n, &id) in mesh.node_ids.iter().enumerate() {
        let mut row = vec![f64::from(id)];
        row.extend_from_slice(&u[3 * n..3 * n + 3]);
        row.extend_from_slice(&reactions[3 * n..3 * n + 3]);
        nodes.row(&row)?;
    }
    let mut names = vec![
        ("element", ""),
        ("xi", ""),
        ("eta", ""),
        ("zeta", ""),
        ("sxx", "Pa"),
        ("syy", "Pa"),
        ("szz", "Pa"),
        ("sxy", "Pa"),
        ("syz", "Pa"),
        ("szx", "Pa"),
    ];
    let plastic = !state.points.is_empty();
    if plastic {
        names.push(("equivalent_plastic_strain", ""));
    }
    let mut gauss = History::create(&dir.join("gauss.csv"), columns(&names))?;
    for (e, &id) in mesh.element_ids.iter().enumerate() {
        let points = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        let elastic = if plastic { Vec::new() } else { fem::stress::gauss(model, u, e) };
        for (i, point) in points.iter().enumerate() {
            let mut row = vec![f64::from(id)];
            row.extend_from_slice(&point.xi);
            if plastic {
                let at = &state.points[model.point_start(e) + i];
                row.extend_from_slice(&at.stress);
                row.push(at.kappa);
            } else {
                row.extend_from_slice(&elastic[i]);
            }
            gauss.row(&row)?;
        }
    }
    Ok(())
}
