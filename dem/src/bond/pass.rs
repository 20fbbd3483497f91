//! The passes over the bonds of a step: between blocks into slots, within a block straight onto its bodies; then, one
//! by one in a fixed order, what the breaks leave behind.

use super::kernel::{self, COUNT, Motion, carry, respond};
use super::loops::{Across, Bonds, Within};
use super::remnant::{self, Remnant};
use super::store::{BondList, Entry};
use super::{Break, BreakMode};
use crate::Vec3;
use crate::lanes::{self, Four, Portable, Simd, V3};
use crate::law::History;
use crate::model::Model;
use crate::state::{Block, Lanes, State, xyz};
use crate::work::{BlockWork, Failure, Sums, Work};
use rayon::prelude::*;

/// Force on the first body, and torques on both.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BondSlot {
    pub force: Lanes,
    pub torque_a: Lanes,
    pub torque_b: Lanes,
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
            let kernel = Bonds {
                groups: &mut list.groups,
                constants: &w.constants,
                count: list.count as usize,
                bodies: Across { own: &blocks[b], blocks, slots: &mut w.slots },
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
        let kernel = Bonds {
            groups: &mut list.groups,
            constants: &w.bonds.constants,
            count: list.count as usize,
            bodies: Within { block, sums: &mut w.sums },
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
            list.remove(&mut w.constants, broken.iter().map(|k| k.at));
            for (one, e) in broken.iter().zip(&entries) {
                let other = if across { e.block as usize } else { b };
                list.remnants.extend(part(model, state, one, e, b, other));
            }
            list.remnants.sort_by_key(|r| (r.i, r.block, r.j));
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
