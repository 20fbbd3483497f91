//! Final grain files: `radial.csv`, `packing.csv`.

use crate::system::GrainsView;
use std::fmt::Write as _;
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::measure;
use trackbed_input::model::grains::{GrainsPart, MeasurePlan, RadialPlan};
use trackbed_io::columns::radial;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::{WriteError, atomic};

/// At shell centres.
pub(super) fn write_radial(
    dir: &Path,
    view: GrainsView<'_>,
    measures: &[MeasurePlan],
    is_grain: impl Fn(usize) -> bool,
) -> Result<(), Failure> {
    let columns: [Field<[f64; 3]>; 3] =
        [(radial::MEASURE, |r| r[0]), (radial::DISTANCE, |r| r[1]), (radial::G, |r| r[2])];
    let rows = measures.iter().enumerate().flat_map(|(i, m)| {
        let g = m.radial.and_then(|RadialPlan { reach, bins }| {
            let g = measure::radial_distribution(view.model, view.state, &m.region, &is_grain, reach, bins)?;
            let row = |(k, g): (usize, f64)| [i as f64, (k as f64 + 0.5) * reach / bins as f64, g];
            Some(g.into_iter().enumerate().map(row).collect::<Vec<_>>())
        });
        g.unwrap_or_default()
    });
    Ok(write_table(&dir.join("radial.csv"), &columns, rows)?)
}

/// Read by `[[grains]] packing`.
pub(super) fn write_packings(dir: &Path, view: GrainsView<'_>, grains: &GrainsPart) -> Result<(), Failure> {
    let groups = grains.groups.first_shape.len();
    for group in 0..groups {
        let name = if groups == 1 { "packing.csv".to_string() } else { format!("packing_{group}.csv") };
        let file = dir.join(name);
        let text = packing(view, group as u32, grains.groups.first_shape[group]);
        atomic::write(&file, |out| {
            out.write_all(text.as_bytes()).map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
    }
    Ok(())
}

/// `x,y,z,r` of spheres; position, quaternion, scale, library index of others. Shortest exact decimals.
fn packing(view: GrainsView<'_>, part: u32, first_shape: usize) -> String {
    let GrainsView { model, state } = view;
    let own = || (0..model.body_count()).filter(|&b| state.present(b) && model.part(b) == part);
    let single = |b: usize| matches!(model.shape(b), dem::Shape::Sphere { .. });
    let mut text = String::new();
    let mut line = |row: &[f64]| {
        let fields: Vec<String> = row.iter().map(f64::to_string).collect();
        writeln!(text, "{}", fields.join(",")).expect("writing to a string does not fail");
    };
    let spheres = own().all(single);
    for b in own() {
        let x = model.wrap(&state.position(b));
        if spheres {
            line(&[x.x, x.y, x.z, model.radius(b)]);
        } else {
            let q = state.orientation(model, b);
            let stone = model.shape_number(b) - first_shape;
            line(&[x.x, x.y, x.z, q.w, q.i, q.j, q.k, model.scale(b), stone as f64]);
        }
    }
    let heading = if spheres { "x,y,z,r\n" } else { "x,y,z,qw,qx,qy,qz,scale,stone\n" };
    heading.to_string() + &text
}
