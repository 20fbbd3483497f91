//! Selection of sphere pairs to bond.

use crate::base::Vec3;
use crate::lanes::vec4::Vec4;
use crate::spatial::cells::Cells;

/// Pairs (a, b), a < b, with surface gap below `gap` [m] that `accept` selects, ascending. `spheres`:
/// centres, radii [m].
pub fn within_gap(
    spheres: &[(Vec3, f64)],
    gap: f64,
    accept: impl Fn(usize, usize) -> bool,
) -> Vec<[usize; 2]> {
    let points: Vec<_> = spheres.iter().map(|(c, r)| Vec4([c.x, c.y, c.z, *r])).collect();
    let radii = points.iter().fold((f64::INFINITY, 0.0_f64), |(lo, hi), p| (lo.min(p[3]), hi.max(p[3])));
    let mut out = Vec::new();
    if points.is_empty() {
        return out;
    }
    let mut cells = Cells::default();
    cells.build(&points, radii, gap.max(0.0));
    for (a, p) in points.iter().enumerate() {
        let first = out.len();
        cells.neighbours(p, gap.max(0.0), |b| {
            let (b, q) = (b as usize, &points[b as usize]);
            let reach = p[3] + q[3] + gap;
            let distance = (spheres[a].0 - spheres[b].0).norm();
            if b > a && distance < reach && accept(a, b) {
                out.push([a, b]);
            }
        });
        out[first..].sort_unstable();
    }
    out
}
