//! Files of a slide: `runout.vti` and `runout.png` (depth map), `outline.csv`, `fragments.csv`, `origins.csv`.

use super::deposit::Deposit;
use super::records::FragmentRecord;
use crate::failure::Failure;
use crate::run::system::GrainsView;
use crate::write::csv::{Field, write_table};
use crate::write::depth_map::{self, DepthMap};
use std::path::Path;
use trackbed_dem::{self as dem, Vec3};

/// A corner of an outline: number of the line, place.
type Corner = (usize, [f64; 2]);

const OUTLINE: [Field<Corner>; 3] =
    [("line", "", |(line, _)| *line as f64), ("x", "m", |(_, x)| x[0]), ("y", "m", |(_, x)| x[1])];

const FRAGMENTS: [Field<FragmentRecord>; 7] = [
    ("bodies", "", |f| f.bodies as f64),
    ("volume", "m3", |f| f.volume),
    ("mass", "kg", |f| f.mass),
    ("diameter", "m", |f| libm::cbrt(6.0 * f.volume / std::f64::consts::PI)),
    ("x", "m", |f| f.centre[0]),
    ("y", "m", |f| f.centre[1]),
    ("z", "m", |f| f.centre[2]),
];

/// A grain: number, place at the start, at the end, fragment.
struct Origin {
    body: usize,
    from: Vec3,
    to: Vec3,
    fragment: u32,
}

const ORIGINS: [Field<Origin>; 8] = [
    ("id", "", |o| o.body as f64),
    ("x0", "m", |o| o.from.x),
    ("y0", "m", |o| o.from.y),
    ("z0", "m", |o| o.from.z),
    ("x", "m", |o| o.to.x),
    ("y", "m", |o| o.to.y),
    ("z", "m", |o| o.to.z),
    ("fragment", "", |o| f64::from(o.fragment)),
];

/// Writes all of them.
///
/// # Errors
/// The disk refuses.
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
    depth_map::write_png(&dir.join("runout.png"), &drawn)?;
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
