//! The passes over the bonds of a step: between blocks into slots, within a block straight onto its bodies; then, one
//! by one in a fixed order, what the breaks leave behind.

use super::kernel::{self, COUNT, Memory, Motion, carry, respond};
use super::remnant::{self, Remnant};
use super::store::{BondList, Entry, Group};
use super::{Break, BreakMode};
use crate::Vec3;
use crate::contact::History;
use crate::lanes::{self, Four, Kernel, Pack, Portable, Simd, V3};
use crate::model::Model;
use crate::state::{Block, Lanes, State, xyz};
use crate::work::{BlockWork, Failure, Sums, Work};
use rayon::prelude::*;

/// Force on the first body, and torques on both.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BondSlot {
    force: Lanes,
    torque_a: Lanes,
    torque_b: Lanes,
}

/// One body's share in a slot.
#[derive(Clone, Copy, Debug)]
struct Share {
    place: u32,
    block: u32,
    slot: u32,
    first: bool,
}

/// A bond that broke in this step.
#[derive(Clone, Copy, Debug)]
struct Broken {
    /// Position in its list.
    at: u32,
    mode: BreakMode,
    /// Energy that it held half a step ago [J].
    energy: f64,
    /// Pressure in its tension spring and the energy of that [N, J].
    pressure: f64,
    pressed: f64,
    /// Speed of approach [m/s].
    approach: f64,
    place: Vec3,
}

/// Scratch of one list.
#[derive(Clone, Debug, Default)]
pub(crate) struct ListWork {
    constants: Vec<[Lanes; COUNT]>,
    slots: Vec<BondSlot>,
    found: Vec<u32>,
    broken: Vec<Broken>,
    power: f64,
    dashpot: f64,
    friction: f64,
    failure: Option<Failure>,
}

/// Scratch of the bonds.
#[derive(Clone, Debug)]
pub(crate) struct BondWork {
    simd: Simd,
    cross: Vec<ListWork>,
    shares: Vec<Vec<Share>>,
}

impl Default for BondWork {
    fn default() -> BondWork {
        BondWork { simd: Simd::best(), cross: Vec::new(), shares: Vec::new() }
    }
}

/// Lays constants and slots out in the state's present order.
pub(crate) fn arrange(model: &Model, state: &State, work: &mut Work) {
    let blocks = state.blocks.len();
    work.bonds.cross.resize_with(blocks, ListWork::default);
    work.bonds.shares.resize_with(blocks, Vec::new);
    if model.bonds.is_empty() {
        return;
    }
    for (w, block) in work.blocks.iter_mut().zip(&state.blocks) {
        block.bonds.constants(model, &mut w.bonds.constants);
    }
    for (w, list) in work.bonds.cross.iter_mut().zip(&state.bonds.cross) {
        list.constants(model, &mut w.constants);
    }
    link(state, &mut work.bonds);
}

/// Gives each bond between blocks, then each remnant, its slot, and each body its shares, in one fixed order.
fn link(state: &State, work: &mut BondWork) {
    work.shares.iter_mut().for_each(Vec::clear);
    for (b, (list, w)) in state.bonds.cross.iter().zip(&mut work.cross).enumerate() {
        w.slots.clear();
        let remnants = list.remnants.iter().map(|r| (r.i, r.block, r.j));
        for (slot, (i, block, j)) in list.iter().map(|e| (e.i, e.block, e.j)).chain(remnants).enumerate() {
            w.slots.push(BondSlot::default());
            let share = Share { place: i, block: b as u32, slot: slot as u32, first: true };
            work.shares[b].push(share);
            work.shares[block as usize].push(Share { place: j, first: false, ..share });
        }
    }
}

impl BondSlot {
    pub fn new(force: Vec3, torque_a: Vec3, torque_b: Vec3) -> BondSlot {
        let lanes = |v: Vec3| Lanes([v.x, v.y, v.z, 0.0]);
        BondSlot { force: lanes(force), torque_a: lanes(torque_a), torque_b: lanes(torque_b) }
    }
}

#[inline(always)]
fn add<R: Four>(to: &mut Lanes, v: R) {
    (R::load(to) + v).store(to);
}

#[inline(always)]
fn subtract<R: Four>(to: &mut Lanes, v: R) {
    (R::load(to) - v).store(to);
}

impl BondSlot {
    /// Adds the first body's share to its sums, or the second's.
    #[inline(always)]
    fn share(&self, sums: &mut Sums, first: bool) {
        let (force, torque) = sums.both();
        if first {
            add(force, Portable::load(&self.force));
            add(torque, Portable::load(&self.torque_a));
        } else {
            subtract(force, Portable::load(&self.force));
            add(torque, Portable::load(&self.torque_b));
        }
    }
}

fn motion(block: &Block, k: usize) -> Motion<f64> {
    let vector = |v: &Lanes| V3::new(v[0], v[1], v[2]);
    Motion { x: vector(&block.centre[k]), v: vector(&block.velocity[k]), w: vector(&block.spin[k]) }
}

/// A group of four bonds: new memory, forces as rows, which lanes hold, power.
#[inline(always)]
fn group<R: Four>(
    a: &Motion<R>,
    b: &Motion<R>,
    constants: &[Lanes; COUNT],
    g: &mut Group,
    dt: R,
) -> ([R; 4], [R; 4], [R; 4], u32, R) {
    // No closures here: what is not inlined into the kernel's entry becomes a call per operation.
    let mut k = [R::zero(); COUNT];
    for (k, constant) in k.iter_mut().zip(constants) {
        *k = R::load(constant);
    }
    let mut memory = Memory { shear: load(&g.shear), turn: load(&g.turn) };
    let frame = carry(k[kernel::OFFSET], a, b, &mut memory, dt);
    store(memory.shear, &mut g.shear);
    store(memory.turn, &mut g.turn);
    let r = respond(&k, a, b, &frame, &memory);
    // A share that is not a number counts as holding: the bodies then fail the check of their speed.
    let holds = !R::splat(1.0).le(r.share);
    (
        rows(r.force.only(holds)),
        rows(r.torque_a.only(holds)),
        rows(r.torque_b.only(holds)),
        R::bits(holds),
        r.power.only(holds),
    )
}

#[inline(always)]
fn load<R: Four>(v: &[Lanes; 3]) -> V3<R> {
    V3::new(R::load(&v[0]), R::load(&v[1]), R::load(&v[2]))
}

#[inline(always)]
fn store<R: Four>(v: V3<R>, to: &mut [Lanes; 3]) {
    v.x.store(&mut to[0]);
    v.y.store(&mut to[1]);
    v.z.store(&mut to[2]);
}

/// A record per lane.
#[inline(always)]
fn rows<R: Four>(v: V3<R>) -> [R; 4] {
    R::transpose([v.x, v.y, v.z, R::zero()])
}

/// The records of four bodies.
#[inline(always)]
fn pick<R: Four>(records: &[Lanes], at: &[u32; 4]) -> [R; 4] {
    [
        R::load(&records[at[0] as usize]),
        R::load(&records[at[1] as usize]),
        R::load(&records[at[2] as usize]),
        R::load(&records[at[3] as usize]),
    ]
}

/// Four bodies of one block.
#[inline(always)]
fn four<R: Four>(centre: &[Lanes], velocity: &[Lanes], spin: &[Lanes], at: &[u32; 4]) -> Motion<R> {
    Motion { x: vectors(pick(centre, at)), v: vectors(pick(velocity, at)), w: vectors(pick(spin, at)) }
}

/// Three numbers of each record.
#[inline(always)]
fn vectors<R: Four>(records: [R; 4]) -> V3<R> {
    let [x, y, z, _] = R::transpose(records);
    V3::new(x, y, z)
}

struct Interior<'a> {
    groups: &'a mut [Group],
    constants: &'a [[Lanes; COUNT]],
    count: usize,
    centre: &'a [Lanes],
    velocity: &'a [Lanes],
    spin: &'a [Lanes],
    sums: &'a mut [Sums],
    found: &'a mut Vec<u32>,
    dt: f64,
}

impl Kernel for Interior<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<P: Pack>(self) -> f64 {
        self.by_four::<P::Quad>()
    }
}

impl Interior<'_> {
    #[inline(always)]
    fn by_four<R: Four>(self) -> f64 {
        let n = self.centre.len();
        let (centre, velocity, spin) = (&self.centre[..n], &self.velocity[..n], &self.spin[..n]);
        let sums = &mut self.sums[..n];
        let dt = R::splat(self.dt);
        let mut power = R::zero();
        for (number, (g, constants)) in self.groups.iter_mut().zip(self.constants).enumerate() {
            let (i, j) = (g.i, g.j);
            let (a, b) = (four(centre, velocity, spin, &i), four(centre, velocity, spin, &j));
            let (f, ta, tb, holds, p) = group(&a, &b, constants, g, dt);
            power = power + p;
            let live = (self.count - 4 * number).min(4);
            for l in 0..live {
                let (a, b) = (i[l] as usize, j[l] as usize);
                let (force, torque) = sums[a].both();
                add(force, f[l]);
                add(torque, ta[l]);
                let (force, torque) = sums[b].both();
                subtract(force, f[l]);
                add(torque, tb[l]);
            }
            if holds != 15 {
                self.found.extend((0..live).filter(|l| holds >> l & 1 == 0).map(|l| (4 * number + l) as u32));
            }
        }
        power.sum()
    }
}

struct Cross<'a> {
    groups: &'a mut [Group],
    constants: &'a [[Lanes; COUNT]],
    count: usize,
    own: &'a Block,
    blocks: &'a [Block],
    slots: &'a mut [BondSlot],
    found: &'a mut Vec<u32>,
    dt: f64,
}

impl Kernel for Cross<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<P: Pack>(self) -> f64 {
        self.by_four::<P::Quad>()
    }
}

impl Cross<'_> {
    #[inline(always)]
    fn by_four<R: Four>(self) -> f64 {
        let dt = R::splat(self.dt);
        let mut power = R::zero();
        for (number, (g, constants)) in self.groups.iter_mut().zip(self.constants).enumerate() {
            let a = four(&self.own.centre, &self.own.velocity, &self.own.spin, &g.i);
            let (p, q) = (&self.blocks[g.block[0] as usize], &self.blocks[g.block[1] as usize]);
            let (r, s) = (&self.blocks[g.block[2] as usize], &self.blocks[g.block[3] as usize]);
            let [i, j, k, l] = g.j;
            let (i, j, k, l) = (i as usize, j as usize, k as usize, l as usize);
            let b = Motion {
                x: vectors([
                    R::load(&p.centre[i]),
                    R::load(&q.centre[j]),
                    R::load(&r.centre[k]),
                    R::load(&s.centre[l]),
                ]),
                v: vectors([
                    R::load(&p.velocity[i]),
                    R::load(&q.velocity[j]),
                    R::load(&r.velocity[k]),
                    R::load(&s.velocity[l]),
                ]),
                w: vectors([
                    R::load(&p.spin[i]),
                    R::load(&q.spin[j]),
                    R::load(&r.spin[k]),
                    R::load(&s.spin[l]),
                ]),
            };
            let (f, ta, tb, holds, p) = group(&a, &b, constants, g, dt);
            power = power + p;
            let live = (self.count - 4 * number).min(4);
            for l in 0..live {
                self.slots[4 * number + l] = BondSlot {
                    force: Lanes(f[l].array()),
                    torque_a: Lanes(ta[l].array()),
                    torque_b: Lanes(tb[l].array()),
                };
            }
            if holds != 15 {
                self.found.extend((0..live).filter(|l| holds >> l & 1 == 0).map(|l| (4 * number + l) as u32));
            }
        }
        power.sum()
    }
}

/// What is known of a bond in the step in which it breaks.
fn describe(model: &Model, at: u32, e: &Entry, own: &Block, other: &Block) -> Broken {
    let dt = model.dt();
    let k = &model.bonds[e.number as usize].values;
    let (a, b) = (motion(own, e.i as usize), motion(other, e.j as usize));
    // The memory is that of now: carried on over no time, it gives the frame of now.
    let mut memory = e.memory;
    let frame = carry(k[kernel::OFFSET], &a, &b, &mut memory, 0.0);
    let r = respond(k, &a, &b, &frame, &memory);
    let stretch = frame.length - k[kernel::LENGTH];
    let stiffness = k[kernel::STIFFNESS];
    Broken {
        at,
        mode: if r.tensile >= r.shearing { BreakMode::Tension } else { BreakMode::Shear },
        energy: kernel::half_step_energy(k, &a, &b, &e.memory, dt, -0.5 * dt),
        pressure: (-stiffness * stretch).max(0.0),
        pressed: 0.5 * stiffness * stretch * stretch,
        approach: -(a.v - b.v).dot(frame.normal),
        place: ((a.x + b.x) * 0.5).to_vec(),
    }
}

impl ListWork {
    fn reset(&mut self) {
        self.found.clear();
        self.broken.clear();
        (self.power, self.dashpot, self.friction, self.failure) = (0.0, 0.0, 0.0, None);
    }
}

/// Bonds and remnants between blocks: forces go to slots.
pub(crate) fn cross(model: &Model, state: &mut State, work: &mut Work) {
    let dt = if state.bonds.fresh { 0.0 } else { model.dt() };
    let (blocks, simd) = (&state.blocks, work.bonds.simd);
    let one = |(b, (list, w)): (usize, (&mut BondList, &mut ListWork))| {
        w.reset();
        if list.count > 0 {
            let kernel = Cross {
                groups: &mut list.groups,
                constants: &w.constants,
                count: list.count as usize,
                own: &blocks[b],
                blocks,
                slots: &mut w.slots,
                found: &mut w.found,
                dt,
            };
            w.power = lanes::run(simd, kernel);
        }
        for at in &w.found {
            let e = list.get(*at as usize);
            w.broken.push(describe(model, *at, &e, &blocks[b], &blocks[e.block as usize]));
        }
        for (k, r) in list.remnants.iter_mut().enumerate() {
            let (slot, (dashpot, friction, failure)) =
                remnant::contact(model, &blocks[b], &blocks[r.block as usize], r, model.dt());
            w.slots[list.count as usize + k] = slot;
            w.dashpot += dashpot;
            w.friction += friction;
            w.failure = w.failure.or(failure);
        }
    };
    let (lists, works) = (&mut state.bonds.cross, &mut work.bonds.cross);
    if work.parallel {
        lists.par_iter_mut().zip(works).enumerate().for_each(one);
    } else {
        lists.iter_mut().zip(works).enumerate().for_each(one);
    }
}

/// Bonds and remnants within block `b`, and its shares of those with others.
pub(crate) fn within(
    model: &Model,
    b: usize,
    block: &mut Block,
    w: &mut BlockWork,
    shared: &BondWork,
    fresh: bool,
) {
    for share in &shared.shares[b] {
        let slot = &shared.cross[share.block as usize].slots[share.slot as usize];
        slot.share(&mut w.sums[share.place as usize], share.first);
    }
    let mut list = std::mem::take(&mut block.bonds);
    w.bonds.reset();
    if list.count > 0 {
        let kernel = Interior {
            groups: &mut list.groups,
            constants: &w.bonds.constants,
            count: list.count as usize,
            centre: &block.centre,
            velocity: &block.velocity,
            spin: &block.spin,
            sums: &mut w.sums,
            found: &mut w.bonds.found,
            dt: if fresh { 0.0 } else { model.dt() },
        };
        w.bonds.power = lanes::run(shared.simd, kernel);
    }
    for at in &w.bonds.found {
        let e = list.get(*at as usize);
        w.bonds.broken.push(describe(model, *at, &e, block, block));
    }
    for r in &mut list.remnants {
        let (slot, (dashpot, friction, failure)) = remnant::contact(model, block, block, r, model.dt());
        slot.share(&mut w.sums[r.i as usize], true);
        slot.share(&mut w.sums[r.j as usize], false);
        w.bonds.dashpot += dashpot;
        w.bonds.friction += friction;
        w.bonds.failure = w.bonds.failure.or(failure);
    }
    block.bonds = list;
}

/// After the bodies have moved: books what the dashpots took, takes broken bonds out and hands separated pairs over.
/// Returns the first failure of a remnant.
pub(crate) fn settle(model: &Model, state: &mut State, work: &mut Work) -> Option<Failure> {
    let (mut power, mut failure) = (0.0, None);
    let mut changed = false;
    for b in 0..state.blocks.len() {
        for across in [false, true] {
            let w = if across { &mut work.bonds.cross[b] } else { &mut work.blocks[b].bonds };
            power += w.power;
            state.ledger.dissipated_dashpot += w.dashpot;
            state.ledger.dissipated_friction += w.friction;
            failure = failure.or(w.failure);
            if w.broken.is_empty() {
                continue;
            }
            let broken = std::mem::take(&mut w.broken);
            let list = if across { &mut state.bonds.cross[b] } else { &mut state.blocks[b].bonds };
            let mut list = std::mem::take(list);
            let entries: Vec<Entry> = broken.iter().map(|k| list.get(k.at as usize)).collect();
            list.remove(broken.iter().map(|k| k.at));
            for (one, e) in broken.iter().zip(&entries) {
                let other = if across { e.block as usize } else { b };
                list.remnants.extend(part(model, state, one, e, b, other));
            }
            list.remnants.sort_by_key(|r| (r.i, r.block, r.j));
            list.constants(model, &mut w.constants);
            *(if across { &mut state.bonds.cross[b] } else { &mut state.blocks[b].bonds }) = list;
            w.broken = broken;
            changed |= across;
        }
    }
    // The force of this step used the velocities of half a step ago, its work is that on the mean of those and the
    // next: c v² + ½ c v·Δv, and the second part sums up to a quarter of the change of power.
    let last = if state.bonds.fresh { power } else { state.bonds.power };
    state.ledger.dissipated_bonds += (power + 0.25 * (power - last)) * model.dt();
    state.bonds.power = power;
    state.bonds.fresh = false;
    changed |= remnant::hand_over(state);
    if changed {
        link(state, &mut work.bonds);
    }
    failure
}

/// Books a break, and makes what is left of the pair.
fn part(
    model: &Model,
    state: &mut State,
    broken: &Broken,
    e: &Entry,
    b: usize,
    other: usize,
) -> Option<Remnant> {
    let bond = &model.bonds[e.number as usize];
    let (mut energy, mut remnant) = (broken.energy, None);
    let (p, q) = (&state.blocks[b], &state.blocks[other]);
    let (i, j) = (e.i as usize, e.j as usize);
    let mobile = p.velocity[i][3] + q.velocity[j][3] > 0.0;
    if !bond.contact && mobile {
        let (one, two) = (p.spin[i][3] as u32, q.spin[j][3] as u32);
        let (ra, rb) = (p.centre[i][3], q.centre[j][3]);
        let dt = model.dt();
        let (x, v) = (xyz(&p.centre[i]) - xyz(&q.centre[j]), xyz(&p.velocity[i]) - xyz(&q.velocity[j]));
        // The bodies have moved on: lengths one step and half a step ago, the latter at the new velocity.
        let half = ra + rb - (x - v * (0.5 * dt)).norm();
        let then = ra + rb - (x - v * dt).norm();
        let radius = ra * rb / (ra + rb);
        let stored = |overlap: f64| model.laws.stored(one, two, overlap, radius, &History::NONE).0;
        let taken = remnant::overlap_for(stored, radius, broken.pressure, broken.pressed);
        let reference = if taken > 0.0 { then - taken } else { then.max(0.0) };
        energy -= stored((half - reference).max(0.0));
        let history =
            if taken > 0.0 { History { rate: broken.approach, ..History::NONE } } else { History::NONE };
        remnant = Some(Remnant { number: e.number, i: e.i, block: e.block, j: e.j, reference, history });
    }
    state.bonds.broken[usize::from(broken.mode == BreakMode::Shear)] += 1;
    state.ledger.released_by_breaks += energy;
    state.bonds.breaks.push(Break {
        time: state.time,
        bond: e.number,
        bodies: bond.ends,
        place: broken.place,
        mode: broken.mode,
        energy,
    });
    remnant
}

#[cfg(test)]
#[path = "pass_tests.rs"]
mod tests;
