//! Spheres around bodies: clumps are searched body by body before their spheres are, since those of one body never touch each
//! other and most of two bodies are apart.

use crate::base::Vec3;
use crate::bodies::members::Members;
use crate::lanes::record::{Record, xyz};
use crate::spatial::cells::Cells;
use std::ops::Range;

/// Spheres around all bodies that have spheres, in the order of these.
pub(super) struct Hulls {
    /// Sphere around each body.
    pub around: Vec<Record>,
    /// The same in cells.
    pub cells: Cells,
    /// First sphere of each body, and one past the last.
    first: Vec<u32>,
    /// First body of each block, and one past the last.
    blocks: Vec<u32>,
}

impl Hulls {
    /// Around the bodies of `members`, whose spheres are `points`; those of each block begin at `first`. For searches that reach
    /// `skin` beyond touch [m].
    pub fn new(members: &[Members], points: &[Record], first: &[u32], skin: f64) -> Hulls {
        let mut hulls = Hulls {
            around: Vec::new(),
            cells: Cells::default(),
            first: Vec::new(),
            blocks: Vec::with_capacity(members.len() + 1),
        };
        let mut radii = (f64::INFINITY, 0.0_f64);
        for (own, &start) in members.iter().zip(first) {
            hulls.blocks.push(hulls.around.len() as u32);
            let mut k = 0;
            while k < own.count {
                let body = own.body(k as u32);
                let count = (k..own.count).take_while(|&j| own.body(j as u32) == body).count();
                let begin = start as usize + k;
                let sphere = around(&points[begin..begin + count]);
                radii = (radii.0.min(sphere[3]), radii.1.max(sphere[3]));
                hulls.around.push(sphere);
                hulls.first.push(begin as u32);
                k += count;
            }
        }
        hulls.blocks.push(hulls.around.len() as u32);
        hulls.first.push(points.len() as u32);
        hulls.cells.build(&hulls.around, radii, skin);
        hulls
    }

    /// Bodies of a block.
    pub fn of_block(&self, block: usize) -> Range<u32> {
        self.blocks[block]..self.blocks[block + 1]
    }

    /// Spheres of a body.
    pub fn spheres(&self, body: u32) -> Range<u32> {
        self.first[body as usize]..self.first[body as usize + 1]
    }
}

/// A sphere that holds others: about the middle of the box around them, a little larger than rounding needs.
fn around(spheres: &[Record]) -> Record {
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
    Record([middle.x, middle.y, middle.z, radius * (1.0 + 1e-12) + 1e-12 * middle.norm()])
}
