//! The loops of a step on one block, chosen by law and kind of body. Nothing here depends on the type of the external
//! surface, so these loops are compiled once, with this crate.

use super::coming::Coming;
use super::hits::{Ask, Hit};
use super::pass::{Between, Gathering, Interior};
use super::planes::{PlaneNow, Planes};
use crate::contact::groups::Groups;
use crate::integrate::leapfrog::Advance;
use crate::lanes::{self, Simd};
use crate::law::with_law;
use crate::model::Model;
use crate::state::{Block, Cross};
use crate::threads::{Part, Slots};
use crate::work::{Applied, BlockWork, CrossWork};

/// Contacts of spheres of block `b` with spheres of others.
pub(crate) fn between(
    model: &Model,
    simd: Simd,
    (blocks, works): (Part<'_, Block>, Part<'_, BlockWork>),
    material: Option<u32>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossWork,
) {
    let dt = model.dt();
    with_law!(&model.laws, laws => match (model.rigid, laws.rolls()) {
        (false, false) => lanes::run(simd, Between::<_, false, false> { laws, blocks, works, material, b, lists, out, dt }),
        (false, true) => lanes::run(simd, Between::<_, false, true> { laws, blocks, works, material, b, lists, out, dt }),
        (true, false) => lanes::run(simd, Between::<_, true, false> { laws, blocks, works, material, b, lists, out, dt }),
        (true, true) => lanes::run(simd, Between::<_, true, true> { laws, blocks, works, material, b, lists, out, dt }),
    });
}

/// Has the records of a block's bodies fetched, which contacts read in no order.
pub(crate) fn fetch(block: &Block) {
    lanes::prefetch(&block.centre);
    lanes::prefetch(&block.velocity);
    lanes::prefetch(&block.spin);
}

/// Adds up what other blocks left for a block.
pub(crate) fn gather(model: &Model, simd: Simd, w: &mut BlockWork, cross: Slots<'_>) {
    if model.rigid || model.laws.rolls() {
        lanes::run(simd, Gathering::<true> { w, cross });
    } else {
        lanes::run(simd, Gathering::<false> { w, cross });
    }
}

/// Contacts between spheres of a block.
pub(crate) fn interior(
    model: &Model,
    simd: Simd,
    block: &Block,
    pairs: &mut Groups<2>,
    w: &mut BlockWork,
    coming: Coming<'_>,
) {
    let dt = model.dt();
    with_law!(&model.laws, laws => match (model.rigid, laws.rolls()) {
        (false, false) => lanes::run(simd, Interior::<_, false, false> { laws, block, pairs, w, coming, dt }),
        (false, true) => lanes::run(simd, Interior::<_, false, true> { laws, block, pairs, w, coming, dt }),
        (true, false) => lanes::run(simd, Interior::<_, true, false> { laws, block, pairs, w, coming, dt }),
        (true, true) => lanes::run(simd, Interior::<_, true, true> { laws, block, pairs, w, coming, dt }),
    });
}

/// Contacts of spheres of a block with planes.
pub(crate) fn planes(
    model: &Model,
    simd: Simd,
    planes: &[PlaneNow],
    material: Option<u32>,
    block: &Block,
    pairs: &mut Groups<2>,
    w: &mut BlockWork,
) {
    let dt = model.dt();
    with_law!(&model.laws, laws => match (model.rigid, laws.rolls()) {
        (false, false) => lanes::run(simd, Planes::<_, false, false> { laws, planes, material, block, pairs, w, dt }),
        (false, true) => lanes::run(simd, Planes::<_, false, true> { laws, planes, material, block, pairs, w, dt }),
        (true, false) => lanes::run(simd, Planes::<_, true, false> { laws, planes, material, block, pairs, w, dt }),
        (true, true) => lanes::run(simd, Planes::<_, true, true> { laws, planes, material, block, pairs, w, dt }),
    });
}

/// Forces of contacts of a block's spheres with patches.
pub(crate) fn hits(model: &Model, simd: Simd, block: &Block, hits: &mut [Hit]) {
    let dt = model.dt();
    with_law!(&model.laws, laws => if laws.rolls() {
        lanes::run(simd, Ask::<_, true> { laws, block, hits, dt });
    } else {
        lanes::run(simd, Ask::<_, false> { laws, block, hits, dt });
    });
}

/// Moves the bodies of a block.
pub(crate) fn advance(model: &Model, simd: Simd, block: &mut Block, w: &mut BlockWork, applied: &[Applied]) {
    let dt = model.dt();
    match (model.rigid, w.plain() && applied.is_empty()) {
        (false, false) => lanes::run(simd, Advance::<false, false> { model, block, w, applied, dt }),
        (false, true) => lanes::run(simd, Advance::<false, true> { model, block, w, applied, dt }),
        (true, false) => lanes::run(simd, Advance::<true, false> { model, block, w, applied, dt }),
        (true, true) => lanes::run(simd, Advance::<true, true> { model, block, w, applied, dt }),
    }
}
