//! Contacts of a block's spheres with spheres of other blocks.

use super::body_lanes::{LocalBodies, RemoteBodies};
use super::group_history::{Dissipation, FAR, LawLanes, four, records, side_by_side};
use super::prefetch;
use super::sphere_pair::contacts;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::lanes::vec4::Vec4;
use crate::lanes::{self, Kernel, Simd4, SimdPack, V3};
use crate::law::{ContactLaw, PairTable};
use crate::pairs::cross::{Cross, CrossForces};
use crate::pairs::groups::Group;

/// Prefetch distance [groups].
const AHEAD: usize = 4;

/// Contacts of block `b` with other blocks; forces go to slots.
pub struct Between<'a, L, const CLUMPS: bool, const ROLLING: bool> {
    pub laws: &'a PairTable<L>,
    pub blocks: BlockSlice<'a, Block>,
    pub members: BlockSlice<'a, BlockBodies>,
    /// Common material, if any.
    pub material: Option<u32>,
    pub b: usize,
    pub lists: &'a mut Cross,
    pub out: &'a mut CrossForces,
    pub dt: f64,
}

impl<L: ContactLaw, const CLUMPS: bool, const ROLLING: bool> Kernel for Between<'_, L, CLUMPS, ROLLING> {
    type Output = ();

    #[inline(always)]
    fn run<R: SimdPack>(self) {
        let Between { laws, blocks, members, material, b: own, lists, out, dt } = self;
        let (mine, own) = (&blocks[own], &members[own]);
        let pairs = &mut lists.spheres;
        let len = pairs.len();
        let law = LawLanes::<L, R>::new(laws, material, material);
        let mut dissipated = Dissipation::new();
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Vec4::default(); 4], [Vec4::default(); 4]);
        let n = mine.centre.len();
        let even = mine.velocity.len() == n && mine.spin.len() == n;
        assert!(CLUMPS || len == 0 || even && (pairs.most()[0] as usize) < n, "names are places of bodies");
        let mut deepest = None;
        for g in (0..len.div_ceil(4)).step_by(R::GROUPS) {
            lanes::ahead(&pairs.groups, g + FAR, R::GROUPS);
            if !CLUMPS {
                for ahead in pairs.groups.iter().skip(g + AHEAD).take(R::GROUPS) {
                    prefetch::partners(blocks, ahead);
                }
            }
            let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
            let turns = if ROLLING {
                side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
            } else {
                (&mut no_turn, &mut spare_turn)
            };
            let count = (len - 4 * g).min(R::LANES);
            let ((p, first), (q, second)) = (p.parts(), q.parts());
            // SAFETY: compared above.
            let a = unsafe { LocalBodies::<CLUMPS>::new::<R>(mine, own, [&p[0], &q[0]]) };
            let (block, sphere) = ([&p[1], &q[1]], [&p[2], &q[2]]);
            let mut b = RemoteBodies { blocks, members, rigid: CLUMPS, block, sphere, body: [0; 8] };
            if CLUMPS {
                for l in 0..count {
                    b.body[l] = members[b.block(l)].body(sphere[l / 4][l % 4]) as usize;
                }
            }
            let (there, springs) = (R::below(count), (first, second));
            let width = if CLUMPS || ROLLING { 3 } else { 2 };
            lanes::ahead(&out.slots, (4 * g + 2 * FAR) * width, R::LANES * width);
            let slots = &mut out.slots[4 * g * width..(4 * g + count) * width];
            match contacts::<L, R, CLUMPS, ROLLING>(&law, &a, &b, springs, turns, there, &mut dissipated, dt)
            {
                None => slots.fill(Vec4::default()),
                Some(found) => {
                    let o = &found.forces;
                    if CLUMPS || ROLLING {
                        let on_a = records::<R>(o.force, o.torque_a);
                        let on_b = records::<R>(o.torque_b, V3::zero());
                        let mut last = [Vec4::default(); 2];
                        for (l, slot) in slots.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                            let [force, torque_a, torque_b] = slot;
                            R::store_record(on_a[l], &mut last);
                            [*force, *torque_a] = last;
                            R::store_record(on_b[l], &mut last);
                            *torque_b = last[0];
                        }
                    } else {
                        let (la, lb) = (o.levers.0.only(found.on), o.levers.1.only(found.on));
                        let rows = R::records(four(o.force, la), four(o.moment, lb));
                        for (l, slot) in slots.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                            R::store_record(rows[l], slot);
                        }
                    }
                    if found.deep != 0 && deepest.is_none() {
                        deepest = Some(found.too_deep(g));
                    }
                }
            }
        }
        if let (Some((k, overlap, bound)), None) = (deepest, out.failure) {
            let [i, block, j] = pairs.name(k);
            let (other, there) = (&blocks[block as usize], members[block as usize].body(j));
            let (body, partner) = (mine.bodies[own.body(i) as usize], other.bodies[there as usize]);
            let partner = Partner::Body(partner as usize);
            out.failure = Some(Failure::Overlap { body, partner, overlap, bound });
        }
        out.dashpot += dissipated.dashpot.sum();
        out.friction += dissipated.friction.sum();
    }
}
