//! The loops of a step on one block, chosen by law and by what the block holds. Nothing here depends on the type of the
//! external surface, so these loops are compiled once, with this crate.

use super::between::Between;
use super::gather::Gathering;
use super::interior::Interior;
use super::patch_forces::{PatchForce, PatchLaw};
use super::planes::{PlaneNow, Planes};
use super::prefetch::Prefetch;
use super::single::Setting;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::part::Part;
use crate::bodies::sums::{Sums, Tally};
use crate::lanes::{self, Simd};
use crate::law::with_law;
use crate::pairs::cross::{Cross, CrossForces, Shares, Slots};
use crate::pairs::groups::Groups;

macro_rules! build {
    ($loop:ident, $rigid:literal, $turning:literal, { $($field:ident),+ }) => {
        $loop::<_, $rigid, $turning> { $($field),+ }
    };
}

/// Runs the one of four loops that two flags choose.
macro_rules! select {
    ($rigid:expr, $turning:expr, $loop:ident, $simd:expr, $fields:tt) => {
        match ($rigid, $turning) {
            (false, false) => lanes::run($simd, build!($loop, false, false, $fields)),
            (false, true) => lanes::run($simd, build!($loop, false, true, $fields)),
            (true, false) => lanes::run($simd, build!($loop, true, false, $fields)),
            (true, true) => lanes::run($simd, build!($loop, true, true, $fields)),
        }
    };
}

/// Contacts of spheres of block `b` with spheres of others. `clumps`: any body of the model may be a clump.
pub(crate) fn between(
    Setting { laws, simd, dt }: Setting<'_>,
    clumps: bool,
    (blocks, members): (Part<'_, Block>, Part<'_, Members>),
    material: Option<u32>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
) {
    let turning = lists.spheres.turning;
    with_law!(laws, laws => {
        select!(clumps, turning, Between, simd, { laws, blocks, members, material, b, lists, out, dt })
    });
}

/// Has the records of a block's bodies fetched, which contacts read in no order.
pub(crate) fn fetch(block: &Block) {
    lanes::prefetch(&block.centre);
    lanes::prefetch(&block.velocity);
    lanes::prefetch(&block.spin);
}

/// Adds up what other blocks left for a block.
pub(crate) fn gather(simd: Simd, shares: &Shares, sums: &mut [Sums], slots: Slots<'_>) {
    if shares.wide {
        lanes::run(simd, Gathering::<true> { shares, sums, slots });
    } else {
        lanes::run(simd, Gathering::<false> { shares, sums, slots });
    }
}

/// Contacts between spheres of a block.
pub(crate) fn interior(
    Setting { laws, simd, dt }: Setting<'_>,
    (block, members): (&Block, &Members),
    pairs: &mut Groups<2>,
    tally: &mut Tally,
    next: Prefetch<'_>,
) {
    let (rigid, turning) = (members.rigid, pairs.turning);
    with_law!(laws, laws => {
        select!(rigid, turning, Interior, simd, { laws, block, pairs, members, tally, next, dt })
    });
}

/// Contacts of spheres of a block with planes, which are of one `material` where that is given.
pub(crate) fn planes(
    Setting { laws, simd, dt }: Setting<'_>,
    planes: &[PlaneNow],
    material: Option<u32>,
    (block, members): (&Block, &Members),
    pairs: &mut Groups<2>,
    tally: &mut Tally,
) {
    let (rigid, turning) = (members.rigid, pairs.turning);
    with_law!(laws, laws => {
        select!(rigid, turning, Planes, simd, { laws, planes, material, block, pairs, members, tally, dt })
    });
}

/// Forces of contacts of a block's spheres with patches. `turning`: any may resist rolling or twisting, or adhere.
pub(crate) fn patch_forces(setting: &Setting<'_>, turning: bool, block: &Block, forces: &mut [PatchForce]) {
    let &Setting { laws, simd, dt } = setting;
    with_law!(laws, laws => if turning {
        lanes::run(simd, PatchLaw::<_, true> { laws, block, forces, dt });
    } else {
        lanes::run(simd, PatchLaw::<_, false> { laws, block, forces, dt });
    });
}
