//! Bond lists: distribution over blocks, update after a step.

use super::model::Model;
use super::state::State;
use super::work::Work;
use crate::base::failure::Failure;
use crate::bond::debonded::{self, DebondedPair};
use crate::bond::kernel::BondHistory;
use crate::bond::pass::{self, Broken, Parts};
use crate::bond::store::Entry;
use crate::bond::{BondList, BondedPairs, Break, BreakMode};
use crate::lanes::vec4::xyz;
use crate::law::History;

/// `dt`: last step [s].
pub(crate) fn parts(model: &Model, dt: f64, fresh: bool) -> Parts<'_> {
    Parts { bonds: &model.bonds, laws: &model.laws, dt, fresh }
}

pub(crate) fn arrange(model: &Model, state: &State, work: &mut Work) {
    let lists = state.lists.iter().map(|l| &l.bonds).zip(work.blocks.iter_mut().map(|w| &mut w.bonds));
    work.bonds.arrange(&model.bonds, lists, &state.bonds);
}

pub(crate) fn list_bonded_pairs(model: &Model, state: &State, held: &mut BondedPairs) {
    let mut pairs = Vec::new();
    if !model.bonds.is_empty() {
        state.each_bond(|number, _| {
            let bond = &model.bonds[number as usize];
            if !bond.contact {
                pairs.push(bond.ends);
            }
        });
        state.each_debonded(|_, r| pairs.push(model.bonds[r.number as usize].ends));
    }
    held.set(model.body_count(), pairs);
}

enum BondEntry {
    Bond(u32, BondHistory<f64>),
    Debonded(DebondedPair),
}

pub(crate) fn start(model: &Model, state: &mut State) {
    state.bonds.fresh = true;
    let all = (0..model.bonds.len() as u32).map(|k| BondEntry::Bond(k, BondHistory::NONE)).collect();
    distribute(model, state, all);
}

pub(crate) fn extract_bonds(state: &mut State) -> PendingBonds {
    let mut all = Vec::new();
    let inner: Vec<BondList> = state.lists.iter_mut().map(|l| std::mem::take(&mut l.bonds)).collect();
    for list in inner.into_iter().chain(std::mem::take(&mut state.bonds.cross)) {
        all.extend(list.iter().map(|e| BondEntry::Bond(e.number, e.memory)));
        all.extend(list.debonded.iter().map(|r| BondEntry::Debonded(*r)));
    }
    PendingBonds(all)
}

pub(crate) struct PendingBonds(Vec<BondEntry>);

pub(crate) fn insert_bonds(model: &Model, state: &mut State, pending: PendingBonds) {
    distribute(model, state, pending.0);
}

fn distribute(model: &Model, state: &mut State, all: Vec<BondEntry>) {
    let blocks = state.blocks.len();
    state.bonds.cross.clear();
    state.bonds.cross.resize_with(blocks, BondList::default);
    let mut entries: [Vec<Vec<Entry>>; 2] = [vec![Vec::new(); blocks], vec![Vec::new(); blocks]];
    for entry in all {
        let number = match &entry {
            BondEntry::Bond(number, _) => *number,
            BondEntry::Debonded(r) => r.number,
        };
        // First body by model index, independent of block order.
        let [[b, i], [block, j]] = model.bonds[number as usize].ends.map(|body| state.places[body as usize]);
        let across = usize::from(b != block);
        match entry {
            BondEntry::Bond(number, memory) => {
                entries[across][b as usize].push(Entry { number, i, block, j, memory });
            }
            BondEntry::Debonded(r) => {
                let list = if across == 1 {
                    &mut state.bonds.cross[b as usize]
                } else {
                    &mut state.lists[b as usize].bonds
                };
                list.debonded.push(DebondedPair { i, block, j, ..r });
            }
        }
    }
    let [inner, cross] = entries;
    for (b, (mut inner, mut cross)) in inner.into_iter().zip(cross).enumerate() {
        inner.sort_unstable_by_key(|e| (e.i.min(e.j), e.i.max(e.j)));
        cross.sort_unstable_by_key(|e| (e.i, e.block, e.j));
        let lists = [(&mut state.lists[b].bonds, inner), (&mut state.bonds.cross[b], cross)];
        for (list, bonds) in lists {
            list.fill(bonds.into_iter());
            list.debonded.sort_unstable_by_key(|r| (r.i, r.block, r.j));
        }
    }
}

impl State {
    pub(crate) fn each_bond(&self, mut f: impl FnMut(u32, (u32, Entry))) {
        for (b, lists) in self.lists.iter().enumerate() {
            let cross = self.bonds.cross.get(b);
            for e in lists.bonds.iter().chain(cross.into_iter().flat_map(BondList::iter)) {
                f(e.number, (b as u32, e));
            }
        }
    }

    pub(crate) fn each_debonded(&self, mut f: impl FnMut(u32, &DebondedPair)) {
        for (b, lists) in self.lists.iter().enumerate() {
            let cross = self.bonds.cross.get(b).map_or(&[][..], |list| &list.debonded);
            lists.bonds.debonded.iter().chain(cross).for_each(|r| f(b as u32, r));
        }
    }

    /// Number of unbroken bonds.
    pub fn bond_count(&self) -> usize {
        let lists = self.lists.iter().map(|l| &l.bonds).chain(&self.bonds.cross);
        lists.map(|list| list.count as usize).sum()
    }

    /// Bonds broken by tension and by shear.
    pub fn broken_bonds(&self) -> (u64, u64) {
        (self.bonds.broken[0], self.bonds.broken[1])
    }

    /// Breaks not yet collected, in order of time.
    pub fn breaks(&self) -> &[Break] {
        &self.bonds.breaks
    }

    /// Returns and clears the breaks, in order of time.
    pub fn take_breaks(&mut self) -> Vec<Break> {
        std::mem::take(&mut self.bonds.breaks)
    }
}

/// Returns the first failure of a debonded pair.
pub(crate) fn settle(model: &Model, state: &mut State, work: &mut Work) -> Option<Failure> {
    let (mut power, mut failure) = (0.0, None);
    let mut changed = false;
    for b in 0..state.blocks.len() {
        for across in [false, true] {
            let w = if across { &mut work.bonds.cross[b] } else { &mut work.blocks[b].bonds };
            power += w.power;
            state.balance.dissipated_dashpot += w.dashpot;
            state.balance.dissipated_friction += w.friction;
            failure = failure.or(w.failure);
            if w.broken.is_empty() {
                continue;
            }
            let broken = std::mem::take(&mut w.broken);
            let list = if across { &mut state.bonds.cross[b] } else { &mut state.lists[b].bonds };
            let mut list = std::mem::take(list);
            let entries: Vec<Entry> = broken.iter().map(|k| list.get(k.at as usize)).collect();
            list.remove(&mut w.constants, broken.iter().map(|k| k.at));
            for (one, e) in broken.iter().zip(&entries) {
                let other = if across { e.block as usize } else { b };
                list.debonded.extend(part(model, state, one, e, b, other));
            }
            list.debonded.sort_by_key(|r| (r.i, r.block, r.j));
            *(if across { &mut state.bonds.cross[b] } else { &mut state.lists[b].bonds }) = list;
            w.broken = broken;
            changed |= across;
        }
    }
    // Forces use velocities half a step old, work their mean with the next: c v² + ½ c v·Δv. The second term
    // sums to a quarter of the change of power.
    let last = if state.bonds.fresh { power } else { state.bonds.power };
    state.balance.dissipated_bonds += (power + 0.25 * (power - last)) * state.step_size.kick();
    state.bonds.power = power;
    state.bonds.fresh = false;
    changed |= discard_separated(state);
    if changed {
        pass::link(&state.bonds.cross, &mut work.bonds);
    }
    failure
}

fn part(
    model: &Model,
    state: &mut State,
    broken: &Broken,
    e: &Entry,
    b: usize,
    other: usize,
) -> Option<DebondedPair> {
    let bond = &model.bonds[e.number as usize];
    let (mut energy, mut pair) = (broken.energy, None);
    let (p, q) = (&state.blocks[b], &state.blocks[other]);
    let (i, j) = (e.i as usize, e.j as usize);
    let mobile = p.velocity[i][3] + q.velocity[j][3] > 0.0;
    if !bond.contact && mobile {
        let (one, two) = (p.material(i), q.material(j));
        let (ra, rb) = (p.centre[i][3], q.centre[j][3]);
        let dt = state.step_size.dt;
        let (x, v) = (xyz(&p.centre[i]) - xyz(&q.centre[j]), xyz(&p.velocity[i]) - xyz(&q.velocity[j]));
        let half = ra + rb - (x - v * (0.5 * dt)).norm();
        let then = ra + rb - (x - v * dt).norm();
        let radius = ra * rb / (ra + rb);
        let stored = |overlap: f64| model.laws.stored(one, two, overlap, radius, &History::NONE).0;
        let overlap = debonded::overlap_for(stored, radius, broken.pressure, broken.pressed);
        let reference = if overlap > 0.0 { then - overlap } else { then.max(0.0) };
        energy -= stored((half - reference).max(0.0));
        let rate = model.laws.initial_state(one, two, broken.approach);
        let history = if overlap > 0.0 { History { rate, ..History::NONE } } else { History::NONE };
        pair = Some(DebondedPair { number: e.number, i: e.i, block: e.block, j: e.j, reference, history });
    }
    state.bonds.broken[usize::from(broken.mode == BreakMode::Shear)] += 1;
    state.balance.released_by_breaks += energy;
    state.bonds.breaks.push(Break {
        time: state.time,
        bond: e.number,
        bodies: bond.ends,
        place: broken.place,
        mode: broken.mode,
        energy,
    });
    pair
}

pub(crate) const CHECK_INTERVAL: u64 = debonded::EVERY;

pub(crate) fn any_debonded(state: &State) -> bool {
    let mut any = false;
    state.each_debonded(|_, _| any = true);
    any
}

/// Broken bonds, debonded pairs.
pub(crate) fn parted(state: &State) -> ((u64, u64), usize) {
    let mut pairs = 0;
    state.each_debonded(|_, _| pairs += 1);
    (state.broken_bonds(), pairs)
}

/// Separation checks need current positions and history.
pub(crate) fn checks_separation(state: &State) -> bool {
    state.steps.is_multiple_of(CHECK_INTERVAL) && any_debonded(state)
}

pub(crate) fn discard_separated(state: &mut State) -> bool {
    if !state.steps.is_multiple_of(debonded::EVERY) {
        return false;
    }
    let State { blocks, lists: own, bonds, .. } = &mut *state;
    let mut lists: Vec<_> = own.iter_mut().map(|l| std::mem::take(&mut l.bonds.debonded)).collect();
    let mut cross: Vec<_> = bonds.cross.iter_mut().map(|l| std::mem::take(&mut l.debonded)).collect();
    let before: usize = lists.iter().chain(&cross).map(Vec::len).sum();
    for (b, list) in lists.iter_mut().enumerate() {
        let keep = |r: &DebondedPair, other: usize| {
            let (_, overlap) =
                debonded::geometry(&blocks[b], r.i as usize, &blocks[other], r.j as usize, 0.0);
            !r.history.is_new() || overlap > 0.0
        };
        list.retain(|r| keep(r, b));
        if let Some(cross) = cross.get_mut(b) {
            cross.retain(|r| keep(r, r.block as usize));
        }
    }
    let after: usize = lists.iter().chain(&cross).map(Vec::len).sum();
    own.iter_mut().zip(lists).for_each(|(l, list)| l.bonds.debonded = list);
    bonds.cross.iter_mut().zip(cross).for_each(|(b, list)| b.debonded = list);
    // These pairs must become neighbours.
    state.stale |= after < before;
    after < before
}

#[cfg(test)]
#[path = "bonds_tests.rs"]
mod tests;
