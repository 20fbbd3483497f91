//! The hot loops of contact, over the lanes of one group of four or two: detect, ask the law, add the forces. Generic in the law, in whether
//! bodies are spheres only (`RIGID = false`: the sphere is the body) or also clumps and boxes, and in whether rolling
//! is resisted (`ROLL`). Contacts that do not touch add zeros, so that they change no bit of a sum.

use super::coming::{self, Coming};
use super::groups::{Group, Groups, Springs};
use crate::Vec3;
use crate::detect;
use crate::error::Partner;
use crate::lanes::{self, Four, Kernel, Pack, Real, V3};
use crate::law::{ContactLaw, FRESH, LawInput, LawOutput, Memory, PairTable};
use crate::state::{Block, Cross, Lanes, xyz};
use crate::threads::{Part, Slots};
use crate::work::{BlockWork, CrossWork, Failure, Sums};

/// Motion of one body as a contact needs it.
pub(crate) struct Motion<'a> {
    pub velocity: &'a Lanes,
    spin: &'a Lanes,
    /// From the body's centre to the contact point.
    pub arm: Vec3,
}

impl Motion<'_> {
    #[inline(always)]
    pub fn spin(&self) -> Vec3 {
        xyz(self.spin)
    }

    #[inline(always)]
    pub fn at_point(&self) -> Vec3 {
        xyz(self.velocity) + xyz(self.spin).cross(&self.arm)
    }
}

#[inline(always)]
pub(crate) fn motion<'a>(block: &'a Block, body: usize, point: &Vec3) -> Motion<'a> {
    let arm = point - xyz(&block.centre[body]);
    Motion { velocity: &block.velocity[body], spin: &block.spin[body], arm }
}

/// A number per lane; of four lanes only, the others are not used.
pub(crate) type Names = [usize; 8];

/// One partner of the contacts in lanes: its sphere, and of its body the centre, the velocity and the spin.
pub(crate) trait End {
    fn sphere(&self, lane: usize) -> &Lanes;
    fn centre(&self, lane: usize) -> &Lanes;
    fn velocity(&self, lane: usize) -> &Lanes;
    fn spin(&self, lane: usize) -> &Lanes;
}

/// Bodies of one block.
pub(crate) struct Own<'a, const RIGID: bool> {
    spheres: &'a [Lanes],
    centre: &'a [Lanes],
    velocity: &'a [Lanes],
    spin: &'a [Lanes],
    names: [&'a [u32; 4]; 2],
    /// Of clumps and boxes only.
    body: Names,
}

impl<'a, const RIGID: bool> Own<'a, RIGID> {
    /// `names`: of spheres, by lane.
    ///
    /// # Safety
    /// Single spheres (`RIGID = false`): every name is below the number of the block's bodies.
    #[inline(always)]
    pub unsafe fn new<R: Pack>(
        block: &'a Block,
        w: &'a BlockWork,
        names: [&'a [u32; 4]; 2],
    ) -> Own<'a, RIGID> {
        let mut body = [0; 8];
        if RIGID {
            for l in 0..R::LANES {
                body[l] = w.owner[names[l / 4][l % 4] as usize] as usize;
            }
        }
        let Block { centre, velocity, spin, .. } = block;
        Own { spheres: &w.spheres, centre, velocity, spin, names, body }
    }

    #[inline(always)]
    pub fn body(&self, lane: usize) -> usize {
        if RIGID { self.body[lane] } else { self.names[lane / 4][lane % 4] as usize }
    }

    #[inline(always)]
    fn of_body(&self, list: &'a [Lanes], lane: usize) -> &'a Lanes {
        let k = self.body(lane);
        // SAFETY: as whoever called `new` has promised; the block's lists are of one length.
        if RIGID { &list[k] } else { unsafe { list.get_unchecked(k) } }
    }
}

/// Whether a block's lists of records and its sums are of one length, and `most` is below it.
pub(crate) fn within(block: &Block, w: &BlockWork, most: u32) -> bool {
    let n = block.centre.len();
    block.velocity.len() == n && block.spin.len() == n && w.sums.len() == n && (most as usize) < n
}

impl<const RIGID: bool> End for Own<'_, RIGID> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Lanes {
        if RIGID { &self.spheres[self.names[lane / 4][lane % 4] as usize] } else { self.centre(lane) }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Lanes {
        self.of_body(self.centre, lane)
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Lanes {
        self.of_body(self.velocity, lane)
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Lanes {
        self.of_body(self.spin, lane)
    }
}

/// Bodies of several blocks.
struct Far<'a> {
    blocks: Part<'a, Block>,
    works: Part<'a, BlockWork>,
    rigid: bool,
    block: [&'a [u32; 4]; 2],
    sphere: [&'a [u32; 4]; 2],
    body: Names,
}

impl<'a> Far<'a> {
    #[inline(always)]
    fn block(&self, lane: usize) -> usize {
        self.block[lane / 4][lane % 4] as usize
    }
    #[inline(always)]
    fn body(&self, lane: usize) -> usize {
        if self.rigid { self.body[lane] } else { self.sphere[lane / 4][lane % 4] as usize }
    }
}

impl End for Far<'_> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Lanes {
        if self.rigid {
            &self.works[self.block(lane)].spheres[self.sphere[lane / 4][lane % 4] as usize]
        } else {
            self.centre(lane)
        }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Lanes {
        &self.blocks[self.block(lane)].centre[self.body(lane)]
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Lanes {
        &self.blocks[self.block(lane)].velocity[self.body(lane)]
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Lanes {
        &self.blocks[self.block(lane)].spin[self.body(lane)]
    }
}

/// Differences of records, by lane of each number; the fourth numbers are multiplied by `last` (1, 0 or −1) before.
#[inline(always)]
fn difference<R: Pack>(p: [R; 4], q: [R; 4], last: f64) -> [R; 4] {
    let sign = R::record(&[1.0, 1.0, 1.0, last]);
    R::columns([p[0].less(q[0], sign), p[1].less(q[1], sign), p[2].less(q[2], sign), p[3].less(q[3], sign)])
}

/// The groups for the lanes, from the first of `list`; where there is one only, the spare one as the second.
#[inline(always)]
pub(crate) fn side_by_side<'a, R: Pack, T>(list: &'a mut [T], spare: &'a mut T) -> (&'a mut T, &'a mut T) {
    let (first, rest) = list.split_at_mut(1);
    (&mut first[0], if R::GROUPS > 1 { &mut rest[0] } else { spare })
}

/// The law of the contacts in lanes: one for all, or mixed lane by lane.
pub(crate) struct Mix<'a, L: ContactLaw, R: Real> {
    laws: &'a PairTable<L>,
    /// Set where either side is of one material.
    one: Option<L::Lanes<R>>,
}

impl<'a, L: ContactLaw, R: Pack> Mix<'a, L, R> {
    /// `a`, `b`: the material of each side, where it has only one.
    #[inline(always)]
    pub fn new(laws: &'a PairTable<L>, a: Option<u32>, b: Option<u32>) -> Mix<'a, L, R> {
        Mix { laws, one: a.zip(b).map(|(a, b)| laws.get(a, b).splat()) }
    }

    /// For materials in lanes.
    #[inline(always)]
    pub fn of(&self, a: R, b: R) -> L::Lanes<R> {
        match self.one {
            Some(law) => law,
            None => self.laws.lanes(a, b),
        }
    }
}

/// Energy that contacts took, by lane of a group.
pub(crate) struct Taken<Q> {
    pub dashpot: Q,
    pub friction: Q,
}

impl<Q: Four> Taken<Q> {
    #[inline(always)]
    pub fn new() -> Taken<Q> {
        Taken { dashpot: Q::zero(), friction: Q::zero() }
    }
}

/// Reads the memory of groups.
#[inline(always)]
pub(crate) fn recall<R: Pack, const ROLL: bool>(
    springs: &(&mut Springs, &mut Springs),
    turns: &(&mut [Lanes; 4], &mut [Lanes; 4]),
) -> Memory<R> {
    let (p, q) = springs;
    let [x, y, z] = [0, 1, 2].map(|d| (&p.spring[d], &q.spring[d]));
    let spring = V3::new(R::join(x.0, x.1), R::join(y.0, y.1), R::join(z.0, z.1));
    let rate = R::join(&p.rate, &q.rate);
    if ROLL {
        let [x, y, z, t] = [0, 1, 2, 3].map(|d| (&turns.0[d], &turns.1[d]));
        let roll = V3::new(R::join(x.0, x.1), R::join(y.0, y.1), R::join(z.0, z.1));
        Memory { spring, rate, roll, twist: R::join(t.0, t.1) }
    } else {
        Memory { spring, rate, roll: V3::zero(), twist: R::zero() }
    }
}

/// Writes the memory of groups: that of the lanes `on`, nothing for the others.
#[inline(always)]
pub(crate) fn remember<R: Pack, const ROLL: bool>(
    springs: &mut (&mut Springs, &mut Springs),
    turns: &mut (&mut [Lanes; 4], &mut [Lanes; 4]),
    memory: &Memory<R>,
    on: R::Mask,
) {
    let (p, q) = springs;
    let spring = memory.spring.only(on);
    spring.x.split(&mut p.spring[0], &mut q.spring[0]);
    spring.y.split(&mut p.spring[1], &mut q.spring[1]);
    spring.z.split(&mut p.spring[2], &mut q.spring[2]);
    R::select(on, memory.rate, R::splat(FRESH)).split(&mut p.rate, &mut q.rate);
    if ROLL {
        let (p, q) = turns;
        let roll = memory.roll.only(on);
        roll.x.split(&mut p[0], &mut q[0]);
        roll.y.split(&mut p[1], &mut q[1]);
        roll.z.split(&mut p[2], &mut q[2]);
        memory.twist.only(on).split(&mut p[3], &mut q[3]);
    }
}

/// Forces of contacts in lanes: on a, and the torques on a and b; and what to complain of.
struct Outcome<R: Real> {
    force: V3<R>,
    torque_a: V3<R>,
    torque_b: V3<R>,
    /// Of single spheres: force times normal, and the levers of both.
    moment: V3<R>,
    levers: (R, R),
    on: R::Mask,
    /// Lanes that overlap by more than the smaller radius.
    deep: u32,
    overlap: R,
    bound: R,
}

impl<R: Pack> Outcome<R> {
    /// The first contact that is too deep: its number in a list where the lanes begin with group `g`, the overlap and
    /// its bound.
    #[cold]
    fn too_deep(&self, g: usize) -> (usize, f64, f64) {
        let l = self.deep.trailing_zeros() as usize;
        (4 * g + l, self.overlap.numbers()[l], self.bound.numbers()[l])
    }
}

/// Contacts between spheres. `None` when none of them touches. `law` mixes constants for materials in lanes.
#[inline(always)]
fn contacts<L: ContactLaw, R: Pack, const RIGID: bool, const ROLL: bool>(
    law: &Mix<'_, L, R>,
    a: &impl End,
    b: &impl End,
    mut springs: (&mut Springs, &mut Springs),
    mut turns: (&mut [Lanes; 4], &mut [Lanes; 4]),
    present: R::Mask,
    taken: &mut Taken<R::Quad>,
    dt: f64,
) -> Option<Outcome<R>> {
    // Differences of whole records, so that one transposition serves both partners; radii are added by the same token.
    let (xa, xb) = (R::rows(|l| a.sphere(l)), R::rows(|l| b.sphere(l)));
    let [dx, dy, dz, reach] = difference(xa, xb, -1.0);
    let between = V3::new(dx, dy, dz);
    let distance2 = between.norm2();
    let on = distance2.lt(reach * reach) & present;
    let mut memory = recall::<R, ROLL>(&springs, &turns);
    let ended = !on & memory.rate.lt(R::splat(FRESH));
    if R::any(ended) {
        let (ma, mb) = (R::columns(R::rows(|l| a.spin(l)))[3], R::columns(R::rows(|l| b.spin(l)))[3]);
        let left = L::stored_in_springs::<R, ROLL>(&law.of(ma, mb), &memory).only(ended);
        taken.friction = left.add_to(taken.friction);
        remember::<R, ROLL>(&mut springs, &mut turns, &memory, on);
    }
    if !R::any(on) {
        return None;
    }
    let (va, wa) = R::two_rows(|l| (a.velocity(l), a.spin(l)));
    let (vb, wb) = R::two_rows(|l| (b.velocity(l), b.spin(l)));
    let distance = distance2.sqrt();
    // distance/distance² rather than 1/distance: the division need not wait for the root.
    let mut normal = between * (distance * (R::splat(1.0) / distance2));
    let apart = R::zero().lt(distance);
    if !R::all(apart) {
        normal = V3::select(apart, normal, V3::new(R::zero(), R::zero(), R::splat(1.0)));
    }
    let overlap = reach - distance;
    let ra = R::columns(xa)[3];
    let rb = reach - ra;
    // From the centres to the contact point, which halves the overlap.
    let la = ra - R::splat(0.5) * overlap;
    let lb = distance - la;

    let [ux, uy, uz, softness] = difference(va, vb, -1.0);
    let [wax, way, waz, ma] = R::columns(wa);
    let [wbx, wby, wbz, mb] = R::columns(wb);
    let (wa, wb) = (V3::new(wax, way, waz), V3::new(wbx, wby, wbz));
    let translation = V3::new(ux, uy, uz);
    let (mut arm_a, mut arm_b) = (V3::zero(), V3::zero());
    let velocity = if RIGID {
        let [ax, ay, az, _] = difference(xa, R::rows(|l| a.centre(l)), 0.0);
        let [bx, by, bz, _] = difference(xb, R::rows(|l| b.centre(l)), 0.0);
        arm_a = V3::new(ax, ay, az) - normal * la;
        arm_b = V3::new(bx, by, bz) + normal * lb;
        translation + wa.cross(arm_a) - wb.cross(arm_b)
    } else {
        translation + normal.cross(wa * la + wb * lb)
    };
    let touch = LawInput {
        mass: R::splat(1.0) / softness,
        radius: ra * rb / reach,
        overlap,
        normal,
        velocity,
        spin: wa - wb,
    };
    let LawOutput { force, moment, dashpot, friction, .. } =
        L::evaluate::<R, ROLL>(&law.of(ma, mb), &touch, &mut memory, on, dt);
    remember::<R, ROLL>(&mut springs, &mut turns, &memory, on);
    taken.dashpot = dashpot.only(on).add_to(taken.dashpot);
    taken.friction = friction.only(on).add_to(taken.friction);
    let force = force.only(on);
    let lever = force.cross(normal).only(on);
    let (mut torque_a, mut torque_b) =
        if RIGID { (arm_a.cross(force), -arm_b.cross(force)) } else { (lever * la, lever * lb) };
    if RIGID || ROLL {
        let moment = moment.only(on);
        torque_a = (torque_a + moment).only(on);
        torque_b = (torque_b - moment).only(on);
    }
    let bound = ra.min(rb);
    Some(Outcome {
        force,
        torque_a,
        torque_b,
        moment: lever,
        levers: (la, lb),
        on,
        deep: R::mask_bits(overlap.gt(bound) & on),
        overlap,
        bound,
    })
}

/// A vector per lane as a record with a fourth number.
#[inline(always)]
pub(crate) fn four<R: Real>(v: V3<R>, last: R) -> [R; 4] {
    [v.x, v.y, v.z, last]
}

/// Force and torque of each lane, for the sums of bodies.
#[inline(always)]
pub(crate) fn records<R: Pack>(force: V3<R>, torque: V3<R>) -> [R::Record; 8] {
    R::records(four(force, R::zero()), four(torque, R::zero()))
}

/// Adds force and torque to the sums of a body.
///
/// # Safety
/// Single spheres (`RIGID = false`): `body` is below the number of sums.
#[inline(always)]
unsafe fn give<R: Pack, const RIGID: bool>(record: R::Record, sums: &mut [Sums], body: usize) {
    // SAFETY: as the caller has promised.
    let sum = if RIGID { &mut sums[body] } else { unsafe { sums.get_unchecked_mut(body) } };
    R::give(record, &mut sum.0);
}

/// Contacts between spheres of one block.
pub(crate) struct Interior<'a, L, const RIGID: bool, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub w: &'a mut BlockWork,
    pub coming: Coming<'a>,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Interior<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let Interior { laws, block, pairs, w, coming, dt } = self;
        let [i, j] = pairs.most();
        assert!(RIGID || within(block, w, i.max(j)), "names of contacts are places of bodies");
        let mut sums = std::mem::take(&mut w.sums);
        let own = &*w;
        let law = Mix::<L, R>::new(laws, own.material, own.material);
        let mut taken = Taken::new();
        let mut deepest = None;
        let len = pairs.len();
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Lanes::default(); 4], [Lanes::default(); 4]);
        let count = len.div_ceil(4);
        // Groups per portion of what is coming; with nothing to fetch, one loop over all.
        let some = if coming.is_empty() { count.max(1) } else { PORTION * R::GROUPS };
        let mut coming = coming.portions(count.div_ceil(some));
        for from in (0..count).step_by(some) {
            coming.fetch::<RIGID>();
            for g in (from..count.min(from + some)).step_by(R::GROUPS) {
                lanes::ahead(&pairs.groups, g + FAR, R::GROUPS);
                let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
                let turns = if ROLL {
                    side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
                } else {
                    (&mut no_turn, &mut spare_turn)
                };
                let ((p, first), (q, second)) = (p.parts(), q.parts());
                // SAFETY: compared above.
                let a = unsafe { Own::<RIGID>::new::<R>(block, own, [&p[0], &q[0]]) };
                let b = unsafe { Own::<RIGID>::new::<R>(block, own, [&p[1], &q[1]]) };
                let (there, springs) = (R::below(len - 4 * g), (first, second));
                let Some(out) =
                    contacts::<L, R, RIGID, ROLL>(&law, &a, &b, springs, turns, there, &mut taken, dt)
                else {
                    continue;
                };
                let (on_a, on_b) = R::opposed(out.force.array(), out.torque_a.array(), out.torque_b.array());
                for l in 0..R::LANES {
                    // SAFETY: compared above.
                    unsafe {
                        give::<R, RIGID>(on_a[l], &mut sums, a.body(l));
                        give::<R, RIGID>(on_b[l], &mut sums, b.body(l));
                    }
                }
                if out.deep != 0 && deepest.is_none() {
                    deepest = Some(out.too_deep(g));
                }
            }
        }
        w.sums = sums;
        w.ledger.dissipated_dashpot += taken.dashpot.sum();
        w.ledger.dissipated_friction += taken.friction.sum();
        if let (Some((k, overlap, bound)), None) = (deepest, w.failure) {
            let [i, j] = pairs.name(k).map(|sphere| block.bodies[w.body(sphere) as usize]);
            w.failure =
                Some(Failure::Overlap { body: i, partner: Partner::Body(j as usize), overlap, bound });
        }
    }
}

/// Passes of the loop between two portions of what is coming.
const PORTION: usize = 4;

/// Groups between the fetching of groups and their use: more than a page.
pub(crate) const FAR: usize = 32;

/// Groups between the fetching of records and their use: those of other blocks lie far away in large beds.
const AHEAD: usize = 4;

/// Contacts of block `b`'s spheres with spheres of other blocks: forces go to slots.
pub(crate) struct Between<'a, L, const RIGID: bool, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub blocks: Part<'a, Block>,
    pub works: Part<'a, BlockWork>,
    /// The material of all bodies, where there is only one.
    pub material: Option<u32>,
    pub b: usize,
    pub lists: &'a mut Cross,
    pub out: &'a mut CrossWork,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Between<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let Between { laws, blocks, works, material, b: own, lists, out, dt } = self;
        let (mine, wa) = (&blocks[own], &works[own]);
        let pairs = &mut lists.spheres;
        let len = pairs.len();
        let law = Mix::<L, R>::new(laws, material, material);
        let mut taken = Taken::new();
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Lanes::default(); 4], [Lanes::default(); 4]);
        let n = mine.centre.len();
        let even = mine.velocity.len() == n && mine.spin.len() == n;
        assert!(RIGID || len == 0 || even && (pairs.most()[0] as usize) < n, "names are places of bodies");
        let mut deepest = None;
        for g in (0..len.div_ceil(4)).step_by(R::GROUPS) {
            lanes::ahead(&pairs.groups, g + FAR, R::GROUPS);
            if !RIGID {
                for ahead in pairs.groups.iter().skip(g + AHEAD).take(R::GROUPS) {
                    coming::partners(blocks, ahead);
                }
            }
            let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
            let turns = if ROLL {
                side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
            } else {
                (&mut no_turn, &mut spare_turn)
            };
            let count = (len - 4 * g).min(R::LANES);
            let ((p, first), (q, second)) = (p.parts(), q.parts());
            // SAFETY: compared above.
            let a = unsafe { Own::<RIGID>::new::<R>(mine, wa, [&p[0], &q[0]]) };
            let (block, sphere) = ([&p[1], &q[1]], [&p[2], &q[2]]);
            let mut b = Far { blocks, works, rigid: RIGID, block, sphere, body: [0; 8] };
            if RIGID {
                for l in 0..count {
                    b.body[l] = works[b.block(l)].owner[sphere[l / 4][l % 4] as usize] as usize;
                }
            }
            let (there, springs) = (R::below(count), (first, second));
            let width = if RIGID || ROLL { 3 } else { 2 };
            lanes::ahead(&out.slots, (4 * g + 2 * FAR) * width, R::LANES * width);
            let slots = &mut out.slots[4 * g * width..(4 * g + count) * width];
            match contacts::<L, R, RIGID, ROLL>(&law, &a, &b, springs, turns, there, &mut taken, dt) {
                None => slots.fill(Lanes::default()),
                Some(o) => {
                    if RIGID || ROLL {
                        let on_a = records::<R>(o.force, o.torque_a);
                        let on_b = records::<R>(o.torque_b, V3::zero());
                        let mut last = [Lanes::default(); 2];
                        for (l, slot) in slots.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                            let [force, torque_a, torque_b] = slot;
                            R::put(on_a[l], &mut last);
                            [*force, *torque_a] = last;
                            R::put(on_b[l], &mut last);
                            *torque_b = last[0];
                        }
                    } else {
                        let (la, lb) = (o.levers.0.only(o.on), o.levers.1.only(o.on));
                        let rows = R::records(four(o.force, la), four(o.moment, lb));
                        for (l, slot) in slots.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                            R::put(rows[l], slot);
                        }
                    }
                    if o.deep != 0 && deepest.is_none() {
                        deepest = Some(o.too_deep(g));
                    }
                }
            }
        }
        if let (Some((k, overlap, bound)), None) = (deepest, out.failure) {
            let [i, block, j] = pairs.name(k);
            let (other, there) = (&blocks[block as usize], works[block as usize].body(j));
            let (body, partner) = (mine.bodies[wa.body(i) as usize], other.bodies[there as usize]);
            let partner = Partner::Body(partner as usize);
            out.failure = Some(Failure::Overlap { body, partner, overlap, bound });
        }
        out.dashpot += taken.dashpot.sum();
        out.friction += taken.friction.sum();
    }
}

/// Contacts of block `b`'s spheres with boxes, one by one; their slots follow those of the spheres.
pub(crate) fn boxes<L: ContactLaw>(
    laws: &PairTable<L>,
    blocks: Part<'_, Block>,
    works: Part<'_, BlockWork>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossWork,
    dt: f64,
) {
    let first = lists.spheres.len();
    let (mine, wa) = (&blocks[b], &works[b]);
    for k in 0..lists.boxes.len() {
        let [i, block, j] = lists.boxes.name(k).map(|n| n as usize);
        let (other, wb) = (&blocks[block], &works[block]);
        let (a, p) = (wa.owner[i] as usize, &wa.spheres[i]);
        let law = laws.get(mine.spin[a][3] as u32, other.spin[j][3] as u32);
        let mut history = lists.boxes.history(k);
        let (x, q) = (xyz(&other.centre[j]), &other.rotation[j].orientation);
        let slot = &mut out.slots[3 * (first + k)..][..3];
        let Some(g) = detect::sphere_box(&xyz(p), p[3], &x, q, &wb.half[j]) else {
            if !history.is_fresh() {
                out.friction += law.release(&mut history);
                lists.boxes.set_history(k, &history);
            }
            slot.fill(Lanes::default());
            continue;
        };
        let (ma, mb) = (motion(mine, a, &g.point), motion(other, j, &g.point));
        let mass = 1.0 / (ma.velocity[3] + mb.velocity[3]);
        let (velocity, spin) = (ma.at_point() - mb.at_point(), ma.spin() - mb.spin());
        let f = law.evaluate_one(mass, &g, &velocity, &spin, &mut history, dt);
        lists.boxes.set_history(k, &history);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        let lanes = |v: Vec3| Lanes([v.x, v.y, v.z, 0.0]);
        slot[0] = lanes(f.force);
        slot[1] = lanes(ma.arm.cross(&f.force) + f.moment);
        slot[2] = lanes(-(mb.arm.cross(&f.force) + f.moment));
        // The nearest face resolves a centre inside the box, up to one more radius.
        let bound = 2.0 * p[3];
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[j] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}

/// Adds the slots of contacts with other blocks, in their fixed order. `WIDE`: slots hold both torques.
pub(crate) struct Gathering<'a, const WIDE: bool> {
    pub w: &'a mut BlockWork,
    pub cross: Slots<'a>,
}

impl<const WIDE: bool> Kernel for Gathering<'_, WIDE> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let Gathering { w, cross } = self;
        let width = if WIDE { 3 } else { 2 };
        let three = R::Quad::load(&[1.0, 1.0, 1.0, 0.0]);
        for (k, entry) in w.gather.iter().enumerate() {
            if let Some(next) = w.gather.get(k + FAR / 2) {
                lanes::ahead(&cross.of(next.block as usize).slots, next.slot().0 * width, width);
            }
            let (slot, first) = entry.slot();
            let slot = &cross.of(entry.block as usize).slots[slot * width..][..width];
            let sums = &mut w.sums[entry.place as usize].0;
            let sign = three * R::Quad::splat(if first { 1.0 } else { -1.0 });
            let force = R::Quad::load(&slot[0]) * sign;
            let torque = if WIDE {
                R::Quad::load(&slot[if first { 1 } else { 2 }])
            } else {
                let lever = slot[usize::from(!first)][3];
                R::Quad::load(&slot[1]) * (three * R::Quad::splat(lever))
            };
            (R::Quad::load(&sums[0]) + force).store(&mut sums[0]);
            (R::Quad::load(&sums[1]) + torque).store(&mut sums[1]);
        }
    }
}
