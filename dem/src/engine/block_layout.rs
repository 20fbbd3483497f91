//! Memory order of bodies.
//!
//! Recursive bisection across the longest side gives compact blocks. Within a block, cell order (z, y, x)
//! suits hardware prefetching better than space-filling curves. The order depends on positions only and fixes
//! rounding of sums.

use super::model::Model;
use super::state::BlockLists;
use crate::base::Vec3;
use crate::bodies::block::{Block, Rotation};
use crate::bodies::table::BodyKind;
use crate::contact::narrow_phase::KINDS;
use crate::lanes::vec4::Vec4;
use crate::pairs::cross::Cross;
use crate::pairs::groups::Groups;
use crate::pairs::list::PairList;

/// Non-sphere bodies per block.
const SOLIDS: usize = 256;

pub(crate) fn blocks(model: &Model, positions: &[Vec3], present: impl Fn(usize) -> bool) -> Vec<Vec<u32>> {
    let of_kind = |solids: bool| -> Vec<u32> {
        (0..positions.len() as u32)
            .filter(|&b| present(b as usize) && (model.bodies.kind(b as usize) == BodyKind::Solid) == solids)
            .collect()
    };
    let mut round = of_kind(false);
    let mut out = Vec::new();
    if !round.is_empty() {
        sort(&mut round, model, positions, model.block, &mut out);
    }
    let mut solids = of_kind(true);
    if solids.len() > SOLIDS {
        sort(&mut solids, model, positions, SOLIDS, &mut out);
    } else if !solids.is_empty() {
        out.push(solids);
    }
    out
}

fn sort(bodies: &mut [u32], model: &Model, positions: &[Vec3], size: usize, out: &mut Vec<Vec<u32>>) {
    let radius = bodies.iter().map(|&b| model.body(b as usize).radius).sum::<f64>() / bodies.len() as f64;
    halve(bodies, positions, size, 2.0 * radius, out);
}

fn halve(bodies: &mut [u32], positions: &[Vec3], size: usize, cell: f64, out: &mut Vec<Vec<u32>>) {
    let count = bodies.len().div_ceil(size);
    let at = |b: u32, d: usize| positions[b as usize][d];
    if count <= 1 {
        bodies.sort_by_cached_key(|&b| [2, 1, 0].map(|d| (at(b, d) / cell).floor() as i64));
        out.push(bodies.to_vec());
        return;
    }
    let (lo, hi) =
        bodies.iter().fold((Vec3::repeat(f64::INFINITY), Vec3::repeat(-f64::INFINITY)), |(lo, hi), &b| {
            (lo.inf(&positions[b as usize]), hi.sup(&positions[b as usize]))
        });
    let axis = (hi - lo).imax();
    let middle = count / 2 * size;
    bodies.sort_unstable_by(|&a, &b| at(a, axis).total_cmp(&at(b, axis)).then(a.cmp(&b)));
    let (left, right) = bodies.split_at_mut(middle);
    halve(left, positions, size, cell, out);
    halve(right, positions, size, cell, out);
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyState {
    pub centre: Vec4,
    pub velocity: Vec4,
    pub spin: Vec4,
    pub rotation: Rotation,
}

impl BodyState {
    pub fn at_rest(model: &Model, body: usize, centre: &Vec3, rotation: Rotation) -> BodyState {
        let b = model.body(body);
        BodyState {
            centre: Vec4([centre.x, centre.y, centre.z, b.radius]),
            velocity: Vec4([0.0, 0.0, 0.0, b.inverse_mass]),
            spin: Vec4([0.0, 0.0, 0.0, f64::from(b.material)]),
            rotation,
        }
    }
}

pub(crate) fn block(model: &Model, bodies: Vec<u32>, row: impl Fn(u32) -> BodyState) -> Block {
    let rigid = bodies.iter().any(|&b| model.bodies.kind(b as usize) != BodyKind::Sphere);
    let mut block = Block::default();
    for &body in &bodies {
        let row = row(body);
        block.centre.push(row.centre);
        block.velocity.push(row.velocity);
        block.spin.push(row.spin);
        if rigid {
            block.rotation.push(row.rotation);
        }
    }
    block.bodies = bodies;
    block.fit();
    block
}

/// Ascending.
pub(crate) fn materials(block: &Block) -> Vec<u32> {
    let mut all: Vec<u32> = (0..block.spin.len()).map(|k| block.material(k)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Rolling springs are stored only if a material pair needs them.
pub(crate) fn lists(model: &Model, block: &Block) -> (BlockLists, Cross) {
    let own = materials(block);
    let planes: Vec<u32> = model.planes.iter().map(|p| p.material as u32).collect();
    let within = BlockLists {
        pairs: Groups::new(model.laws.rolls_among(&own, &own)),
        planes: Groups::new(model.laws.rolls_among(&own, &planes)),
        ..BlockLists::default()
    };
    let rolls = model.laws.rolls_among(&own, &model.body_materials);
    let kinds = KINDS.iter().filter(|_| model.solids).map(|_| PairList::default()).collect();
    (within, Cross::new(rolls, kinds))
}
