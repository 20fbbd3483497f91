//! Halo of a search: bodies near the blocks of other ranks.

use super::ghosts::BodyLocation;
use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::lanes::vec4::xyz;
use std::ops::Range;

/// Bounding box: lower and upper corner [m]; inverted if empty.
pub(super) type Bounds = [Vec3; 2];

pub(super) fn bounds(block: &Block) -> Bounds {
    let nothing = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    block
        .centre
        .iter()
        .fold(nothing, |[lo, hi], p| [lo.inf(&xyz(p).add_scalar(-p[3])), hi.sup(&xyz(p).add_scalar(p[3]))])
}

fn meet(a: &Bounds, b: &Bounds, reach: f64) -> bool {
    (0..3).all(|d| a[0][d] - reach <= b[1][d] && b[0][d] - reach <= a[1][d])
}

/// Bodies of `own` within `reach` of the boxes of `other` [m].
pub(super) fn near(
    blocks: &[Block],
    boxes: &[Bounds],
    (own, other): (Range<usize>, Range<usize>),
    reach: f64,
    out: &mut Vec<BodyLocation>,
) {
    out.clear();
    let mut close: Vec<&Bounds> = Vec::new();
    for b in own {
        close.clear();
        close.extend(boxes[other.clone()].iter().filter(|there| meet(&boxes[b], there, reach)));
        if close.is_empty() {
            continue;
        }
        for (k, p) in blocks[b].centre.iter().enumerate() {
            let body = [xyz(p).add_scalar(-p[3]), xyz(p).add_scalar(p[3])];
            if close.iter().any(|there| meet(&body, there, reach)) {
                out.push([b as u32, k as u32]);
            }
        }
    }
}
