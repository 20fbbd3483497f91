//! Bounding spheres of bodies: most pairs of clumps are apart.

use crate::base::Vec3;
use crate::lanes::vec4::{Vec4, xyz};
use crate::spatial::cells::Cells;
use std::ops::Range;

pub(super) struct ClumpBounds {
    pub around: Vec<Vec4>,
    pub cells: Cells,
    /// First sphere of each body, plus end.
    first: Vec<u32>,
    /// First body of each block, plus end.
    blocks: Vec<u32>,
}

impl ClumpBounds {
    /// `points`: spheres in body order; `owners`: block and slot of each sphere's body; `skin`: search skin
    /// [m].
    pub fn new(
        points: &[Vec4],
        owners: impl Iterator<Item = (u32, u32)>,
        blocks: usize,
        skin: f64,
    ) -> ClumpBounds {
        let mut clump_bounds = ClumpBounds {
            around: Vec::new(),
            cells: Cells::default(),
            first: Vec::new(),
            blocks: Vec::with_capacity(blocks + 1),
        };
        let mut last = None;
        for (k, (block, place)) in owners.enumerate() {
            if last != Some((block, place)) {
                let body = clump_bounds.first.len() as u32;
                clump_bounds.blocks.resize(block as usize + 1, body);
                clump_bounds.first.push(k as u32);
                last = Some((block, place));
            }
        }
        clump_bounds.blocks.resize(blocks + 1, clump_bounds.first.len() as u32);
        clump_bounds.first.push(points.len() as u32);
        let spheres = clump_bounds.first.windows(2).map(|w| w[0] as usize..w[1] as usize);
        clump_bounds.around = spheres.map(|spheres| around(&points[spheres])).collect();
        let radii = clump_bounds.around.iter().map(|s| s[3]);
        let radii = radii.fold((f64::INFINITY, 0.0_f64), |(lo, hi), r| (lo.min(r), hi.max(r)));
        clump_bounds.cells.build(&clump_bounds.around, radii, skin);
        clump_bounds
    }

    pub fn of_block(&self, block: usize) -> Range<u32> {
        self.blocks[block]..self.blocks[block + 1]
    }

    pub fn spheres(&self, body: u32) -> Range<u32> {
        self.first[body as usize]..self.first[body as usize + 1]
    }
}

/// Bounding sphere about the box centre, with margin for rounding.
fn around(spheres: &[Vec4]) -> Vec4 {
    if let [one] = spheres {
        return *one;
    }
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for p in spheres {
        low = low.inf(&xyz(p).add_scalar(-p[3]));
        high = high.sup(&xyz(p).add_scalar(p[3]));
    }
    let middle = 0.5 * (low + high);
    let radius = spheres.iter().map(|p| (xyz(p) - middle).norm() + p[3]).fold(0.0, f64::max);
    Vec4([middle.x, middle.y, middle.z, radius * (1.0 + 1e-12) + 1e-12 * middle.norm()])
}
