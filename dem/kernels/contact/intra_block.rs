//! Contacts between spheres of one block.

use super::body_lanes::{LocalBodies, within};
use super::group_history::{Dissipation, FAR, LawLanes, side_by_side};
use super::prefetch::Prefetch;
use super::sphere_pair::contacts;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::{BlockTotals, ForceTorque};
use crate::lanes::vec4::Vec4;
use crate::lanes::{self, Kernel, Simd4, SimdPack};
use crate::law::{ContactLaw, PairTable};
use crate::pairs::groups::{Group, Groups};

/// Loop passes between prefetch portions.
const PORTION: usize = 4;

/// Adds force and torque to a body.
///
/// # Safety
/// If `CLUMPS = false`, `body` is below the number of sums.
#[inline(always)]
unsafe fn add_record<R: SimdPack, const CLUMPS: bool>(
    record: R::Vec4Pair,
    sums: &mut [ForceTorque],
    body: usize,
) {
    // SAFETY: promised by the caller.
    let sum = if CLUMPS { &mut sums[body] } else { unsafe { sums.get_unchecked_mut(body) } };
    R::add_record(record, &mut sum.0);
}

pub struct Interior<'a, L, const CLUMPS: bool, const ROLLING: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub members: &'a BlockBodies,
    pub totals: &'a mut BlockTotals,
    pub next: Prefetch<'a>,
    pub dt: f64,
}

impl<L: ContactLaw, const CLUMPS: bool, const ROLLING: bool> Kernel for Interior<'_, L, CLUMPS, ROLLING> {
    type Output = ();

    #[inline(always)]
    fn run<R: SimdPack>(self) {
        let Interior { laws, block, pairs, members, totals, next, dt } = self;
        let [i, j] = pairs.most();
        assert!(CLUMPS || within(block, totals, i.max(j)), "names of contacts are places of bodies");
        let mut sums = std::mem::take(&mut totals.sums);
        let law = LawLanes::<L, R>::new(laws, members.material, members.material);
        let mut dissipated = Dissipation::new();
        let mut deepest = None;
        let len = pairs.len();
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Vec4::default(); 4], [Vec4::default(); 4]);
        let count = len.div_ceil(4);
        // Groups per prefetch portion.
        let some = if next.is_empty() { count.max(1) } else { PORTION * R::GROUPS };
        let mut next = next.portions(count.div_ceil(some));
        for from in (0..count).step_by(some) {
            next.fetch::<CLUMPS>();
            for g in (from..count.min(from + some)).step_by(R::GROUPS) {
                lanes::ahead(&pairs.groups, g + FAR, R::GROUPS);
                let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
                let turns = if ROLLING {
                    side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
                } else {
                    (&mut no_turn, &mut spare_turn)
                };
                let ((p, first), (q, second)) = (p.parts(), q.parts());
                // SAFETY: compared above.
                let a = unsafe { LocalBodies::<CLUMPS>::new::<R>(block, members, [&p[0], &q[0]]) };
                // SAFETY: compared above.
                let b = unsafe { LocalBodies::<CLUMPS>::new::<R>(block, members, [&p[1], &q[1]]) };
                let (there, springs) = (R::below(len - 4 * g), (first, second));
                let Some(out) = contacts::<L, R, CLUMPS, ROLLING>(
                    &law,
                    &a,
                    &b,
                    springs,
                    turns,
                    there,
                    &mut dissipated,
                    dt,
                ) else {
                    continue;
                };
                let f = &out.forces;
                let (on_a, on_b) = R::opposed(f.force.array(), f.torque_a.array(), f.torque_b.array());
                for l in 0..R::LANES {
                    // SAFETY: compared above.
                    unsafe {
                        add_record::<R, CLUMPS>(on_a[l], &mut sums, a.body(l));
                        add_record::<R, CLUMPS>(on_b[l], &mut sums, b.body(l));
                    }
                }
                if out.deep != 0 && deepest.is_none() {
                    deepest = Some(out.too_deep(g));
                }
            }
        }
        totals.sums = sums;
        totals.balance.dissipated_dashpot += dissipated.dashpot.sum();
        totals.balance.dissipated_friction += dissipated.friction.sum();
        if let (Some((k, overlap, bound)), None) = (deepest, totals.failure) {
            let [i, j] = pairs.name(k).map(|sphere| block.bodies[members.body(sphere) as usize]);
            totals.failure =
                Some(Failure::Overlap { body: i, partner: Partner::Body(j as usize), overlap, bound });
        }
    }
}
