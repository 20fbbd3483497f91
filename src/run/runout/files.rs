//! Files `runout.vti`, `runout.png`, `outline.csv`, `fragments.csv`, `origins.csv`.

use super::deposit::Deposit;
use super::records::FragmentRecord;
use crate::system::GrainsView;
use std::path::Path;
use trackbed_dem::{self as dem, Vec3};
use trackbed_io::columns::{fragments, origins, outline};
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::depth_map::{self, DepthMap};

/// Line index, position.
type Corner = (usize, [f64; 2]);

const OUTLINE: [Field<Corner>; 3] =
    [(outline::LINE, |(line, _)| *line as f64), (outline::X, |(_, x)| x[0]), (outline::Y, |(_, x)| x[1])];

const FRAGMENTS: [Field<FragmentRecord>; 7] = [
    (fragments::BODIES, |f| f.bodies as f64),
    (fragments::VOLUME, |f| f.volume),
    (fragments::MASS, |f| f.mass),
    (fragments::DIAMETER, |f| libm::cbrt(6.0 * f.volume / std::f64::consts::PI)),
    (fragments::X, |f| f.centre[0]),
    (fragments::Y, |f| f.centre[1]),
    (fragments::Z, |f| f.centre[2]),
];

struct Origin {
    body: usize,
    from: Vec3,
    to: Vec3,
    fragment: u32,
}

const ORIGINS: [Field<Origin>; 8] = [
    (origins::ID, |o| o.body as f64),
    (origins::X0, |o| o.from.x),
    (origins::Y0, |o| o.from.y),
    (origins::Z0, |o| o.from.z),
    (origins::X, |o| o.to.x),
    (origins::Y, |o| o.to.y),
    (origins::Z, |o| o.to.z),
    (origins::FRAGMENT, |o| f64::from(o.fragment)),
];

/// Writes all files.
///
/// # Errors
/// I/O errors.
pub fn write(
    dir: &Path,
    view: GrainsView<'_>,
    map: &Deposit,
    fragments: &[FragmentRecord],
    (bodies, from): (&[usize], &[Vec3]),
) -> Result<(), Failure> {
    let plan = &map.plan;
    let lowest = map.ground.iter().copied().fold(f64::INFINITY, f64::min);
    let drawn = DepthMap {
        low: [plan.low[0], plan.low[1], lowest],
        cell: plan.cell,
        counts: plan.counts,
        ground: &map.ground,
        depth: &map.depth,
        solid: &map.solid,
        travel: &map.travel,
        inside: &map.inside,
    };
    depth_map::write_vti(&dir.join("runout.vti"), &drawn)?;
    let deepest = map.depth.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    depth_map::write_png(&dir.join("runout.png"), &drawn, deepest)?;
    let corners = map.outlines().into_iter().enumerate();
    let corners: Vec<Corner> = corners.flat_map(|(k, line)| line.into_iter().map(move |x| (k, x))).collect();
    write_table(&dir.join("outline.csv"), &OUTLINE, &corners)?;
    write_table(&dir.join("fragments.csv"), &FRAGMENTS, fragments)?;
    let pieces = dem::measure::fragments(view.model, view.state);
    let origins = bodies.iter().map(|&body| Origin {
        body,
        from: from[body],
        to: view.state.position(body),
        fragment: pieces.of[body],
    });
    write_table(&dir.join("origins.csv"), &ORIGINS, origins)?;
    Ok(())
}
