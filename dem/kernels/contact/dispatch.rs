//! Selects a block's contact loops. Independent of the surface type, hence compiled once.

use super::gather::Gathering;
use super::inter_block::Between;
use super::intra_block::Interior;
use super::patch_forces::{PatchForce, PatchLaw};
use super::planes::{PlanePose, Planes};
use super::prefetch::Prefetch;
use super::scalar::StepContext;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::bodies::sums::{BlockTotals, ForceTorque};
use crate::lanes::{self, Kernel, Portable, Simd};
use crate::law::with_law;
use crate::pairs::cross::{Cross, CrossForces, Shares, Slots};
use crate::pairs::groups::Groups;

macro_rules! build {
    ($loop:ident, $rigid:literal, $turning:literal, { $($field:ident),+ }) => {
        $loop::<_, $rigid, $turning> { $($field),+ }
    };
}

macro_rules! select {
    ($rigid:expr, $turning:expr, $loop:ident, $run:ident, $simd:ident, $fields:tt) => {
        match ($rigid, $turning) {
            (false, false) => $run($simd, build!($loop, false, false, $fields)),
            (false, true) => $run($simd, build!($loop, false, true, $fields)),
            (true, false) => $run($simd, build!($loop, true, false, $fields)),
            (true, true) => $run($simd, build!($loop, true, true, $fields)),
        }
    };
}

/// Runs a kernel by plain arrays: old processors have one kernel for all laws, with the same bits.
#[inline(never)]
fn run_any<K: Kernel>(_: Simd, kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

/// Evaluates with the table in use and the function that runs kernels of it.
///
/// Unit tests of this crate run no loop over bodies, which spares them the compilation of 140 loops; those of
/// `dem` run all.
macro_rules! by_law {
    ($laws:ident, $simd:ident, $run:ident => $body:expr) => {
        if cfg!(test) {
            unreachable!("loops over bodies are tested in `dem`");
        } else if $simd.any_law_only() {
            let $laws = &$laws.any;
            use run_any as $run;
            $body
        } else {
            use lanes::run_native as $run;
            with_law!($laws, $laws => $body)
        }
    };
}

/// `clumps`: the model may contain clumps.
pub fn between(
    StepContext { laws, simd, dt }: StepContext<'_>,
    clumps: bool,
    (blocks, members): (BlockSlice<'_, Block>, BlockSlice<'_, BlockBodies>),
    material: Option<u32>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
) {
    let turning = lists.spheres.turning;
    by_law!(laws, simd, run => {
        select!(clumps, turning, Between, run, simd, { laws, blocks, members, material, b, lists, out, dt })
    });
}

/// Prefetches body records, read in random order.
pub fn fetch(block: &Block) {
    lanes::prefetch(&block.centre);
    lanes::prefetch(&block.velocity);
    lanes::prefetch(&block.spin);
}

pub fn gather(simd: Simd, shares: &Shares, sums: &mut [ForceTorque], slots: Slots<'_>) {
    if shares.wide {
        lanes::run(simd, Gathering::<true> { shares, sums, slots });
    } else {
        lanes::run(simd, Gathering::<false> { shares, sums, slots });
    }
}

pub fn interior(
    StepContext { laws, simd, dt }: StepContext<'_>,
    (block, members): (&Block, &BlockBodies),
    pairs: &mut Groups<2>,
    totals: &mut BlockTotals,
    next: Prefetch<'_>,
) {
    let (rigid, turning) = (members.rigid, pairs.turning);
    by_law!(laws, simd, run => {
        select!(rigid, turning, Interior, run, simd, { laws, block, pairs, members, totals, next, dt })
    });
}

/// `material`: common material of the planes.
pub fn planes(
    StepContext { laws, simd, dt }: StepContext<'_>,
    planes: &[PlanePose],
    material: Option<u32>,
    (block, members): (&Block, &BlockBodies),
    pairs: &mut Groups<2>,
    totals: &mut BlockTotals,
) {
    let (rigid, turning) = (members.rigid, pairs.turning);
    by_law!(laws, simd, run => {
        select!(rigid, turning, Planes, run, simd, { laws, planes, material, block, pairs, members, totals, dt })
    });
}

/// `turning`: resistance against rolling or twisting, or adhesion possible.
pub fn patch_forces(setting: &StepContext<'_>, turning: bool, block: &Block, forces: &mut [PatchForce]) {
    let &StepContext { laws, simd, dt } = setting;
    by_law!(laws, simd, run => if turning {
        run(simd, PatchLaw::<_, true> { laws, block, forces, dt });
    } else {
        run(simd, PatchLaw::<_, false> { laws, block, forces, dt });
    });
}
