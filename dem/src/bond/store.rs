//! Where bonds are kept: in lists of groups of four, one list per block for bonds within it, one for those that lead to
//! other blocks (with the block of their first body). A list holds unbroken bonds only.

use super::Break;
use super::kernel::{COUNT, Memory};
use super::remnant::Remnant;
use crate::lanes::V3;
use crate::model::Model;
use crate::state::{Lanes, State};
use serde::{Deserialize, Serialize};

/// Number of a lane without a bond.
const NONE: u32 = u32::MAX;

/// Four bonds.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Group {
    /// Numbers in the model.
    pub number: [u32; 4],
    /// Place of the first body in its block; block and place of the second.
    pub i: [u32; 4],
    pub block: [u32; 4],
    pub j: [u32; 4],
    pub shear: [Lanes; 3],
    pub turn: [Lanes; 3],
}

/// One bond of a list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub number: u32,
    pub i: u32,
    pub block: u32,
    pub j: u32,
    pub memory: Memory<f64>,
}

/// Bonds of a block, and pairs that were bonded.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct BondList {
    pub groups: Vec<Group>,
    pub count: u32,
    pub remnants: Vec<Remnant>,
}

/// What else changes with bonds.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct BondState {
    /// Bonds between blocks, by the block of their first body.
    pub cross: Vec<BondList>,
    /// Whether no step has been made: the motion before the start does not count.
    pub fresh: bool,
    /// Power of all dashpots in the last step [W].
    pub power: f64,
    /// Bonds broken so far by tension and by shear.
    pub broken: [u64; 2],
    /// Breaks that nobody has taken yet.
    pub breaks: Vec<Break>,
}

impl Memory<f64> {
    pub const NONE: Memory<f64> =
        Memory { shear: V3 { x: 0.0, y: 0.0, z: 0.0 }, turn: V3 { x: 0.0, y: 0.0, z: 0.0 } };
}

impl BondList {
    /// The bond at a position.
    pub fn get(&self, at: usize) -> Entry {
        let (g, l) = (&self.groups[at / 4], at % 4);
        let vector = |v: &[Lanes; 3]| V3::new(v[0][l], v[1][l], v[2][l]);
        let memory = Memory { shear: vector(&g.shear), turn: vector(&g.turn) };
        Entry { number: g.number[l], i: g.i[l], block: g.block[l], j: g.j[l], memory }
    }

    fn set(&mut self, at: usize, e: &Entry) {
        let (g, l) = (&mut self.groups[at / 4], at % 4);
        (g.number[l], g.i[l], g.block[l], g.j[l]) = (e.number, e.i, e.block, e.j);
        for (to, v) in [(&mut g.shear, e.memory.shear), (&mut g.turn, e.memory.turn)] {
            (to[0][l], to[1][l], to[2][l]) = (v.x, v.y, v.z);
        }
    }

    /// All bonds in order.
    pub fn iter(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..self.count as usize).map(|at| self.get(at))
    }

    /// Replaces the bonds.
    pub fn fill(&mut self, bonds: impl Iterator<Item = Entry>) {
        self.groups.clear();
        self.count = 0;
        for e in bonds {
            let at = self.count as usize;
            if at.is_multiple_of(4) {
                // A lane without a bond repeats a real pair, so that its arithmetic is harmless; its constants are zero.
                let zero = [Lanes::default(); 3];
                self.groups.push(Group {
                    number: [NONE; 4],
                    i: [e.i; 4],
                    block: [e.block; 4],
                    j: [e.j; 4],
                    shear: zero,
                    turn: zero,
                });
            }
            self.set(at, &e);
            self.count += 1;
        }
    }

    /// Takes out the bonds at the given positions, ascending, and their constants; those behind move up.
    pub fn remove(
        &mut self,
        constants: &mut Vec<[Lanes; COUNT]>,
        positions: impl Iterator<Item = u32> + Clone,
    ) {
        let mut gone = positions.peekable();
        let Some(&first) = gone.peek() else { return };
        let mut to = first as usize;
        for k in first..self.count {
            if gone.next_if_eq(&k).is_some() {
                continue;
            }
            let e = self.get(k as usize);
            self.set(to, &e);
            let own = constants[k as usize / 4].map(|c| c[k as usize % 4]);
            set_constants(constants, to, own);
            to += 1;
        }
        self.count = to as u32;
        self.groups.truncate(to.div_ceil(4));
        constants.truncate(to.div_ceil(4));
        while !to.is_multiple_of(4) {
            let e = Entry { number: NONE, memory: Memory::NONE, ..self.get(to / 4 * 4) };
            self.set(to, &e);
            set_constants(constants, to, [0.0; COUNT]);
            to += 1;
        }
    }

    /// The constants of the bonds, group by group.
    pub fn constants(&self, model: &Model, out: &mut Vec<[Lanes; COUNT]>) {
        out.clear();
        out.extend(self.groups.iter().map(|g| {
            let mut k = [Lanes::default(); COUNT];
            for (l, &number) in g.number.iter().enumerate().filter(|(_, n)| **n != NONE) {
                for (to, value) in k.iter_mut().zip(&model.bonds[number as usize].values) {
                    to[l] = *value;
                }
            }
            k
        }));
    }
}

/// Sets the constants at a position.
fn set_constants(constants: &mut [[Lanes; COUNT]], at: usize, own: [f64; COUNT]) {
    for (to, x) in constants[at / 4].iter_mut().zip(own) {
        to[at % 4] = x;
    }
}

/// A bond or a remnant on its way to a new order of the bodies.
enum Filed {
    Bond(u32, Memory<f64>),
    Remnant(Remnant),
}

/// Puts all bonds of a new state into its lists.
pub(crate) fn start(model: &Model, state: &mut State) {
    state.bonds.fresh = true;
    let all = (0..model.bonds.len() as u32).map(|k| Filed::Bond(k, Memory::NONE)).collect();
    file(model, state, all);
}

/// Takes bonds and remnants out of the old blocks' lists; `inner` yields those lists.
pub(crate) fn take(inner: impl Iterator<Item = BondList>, state: &mut State) -> Taken {
    let mut all = Vec::new();
    for list in inner.chain(std::mem::take(&mut state.bonds.cross)) {
        all.extend(list.iter().map(|e| Filed::Bond(e.number, e.memory)));
        all.extend(list.remnants.iter().map(|r| Filed::Remnant(*r)));
    }
    Taken(all)
}

/// Bonds between [`take`] and [`put`].
pub(crate) struct Taken(Vec<Filed>);

/// Puts bonds into the lists of the state's present blocks.
pub(crate) fn put(model: &Model, state: &mut State, taken: Taken) {
    file(model, state, taken.0);
}

fn file(model: &Model, state: &mut State, all: Vec<Filed>) {
    let blocks = state.blocks.len();
    state.bonds.cross.clear();
    state.bonds.cross.resize_with(blocks, BondList::default);
    let mut entries: [Vec<Vec<Entry>>; 2] = [vec![Vec::new(); blocks], vec![Vec::new(); blocks]];
    for filed in all {
        let number = match &filed {
            Filed::Bond(number, _) => *number,
            Filed::Remnant(r) => r.number,
        };
        // The first body of a bond is that of the model, whatever the order of the blocks: no sign ever turns.
        let [[b, i], [block, j]] = model.bonds[number as usize].ends.map(|body| state.places[body as usize]);
        let across = usize::from(b != block);
        match filed {
            Filed::Bond(number, memory) => {
                entries[across][b as usize].push(Entry { number, i, block, j, memory });
            }
            Filed::Remnant(r) => {
                let list = if across == 1 {
                    &mut state.bonds.cross[b as usize]
                } else {
                    &mut state.blocks[b as usize].bonds
                };
                list.remnants.push(Remnant { i, block, j, ..r });
            }
        }
    }
    let [inner, cross] = entries;
    for (b, (mut inner, mut cross)) in inner.into_iter().zip(cross).enumerate() {
        inner.sort_unstable_by_key(|e| (e.i.min(e.j), e.i.max(e.j)));
        cross.sort_unstable_by_key(|e| (e.i, e.block, e.j));
        let lists = [(&mut state.blocks[b].bonds, inner), (&mut state.bonds.cross[b], cross)];
        for (list, bonds) in lists {
            list.fill(bonds.into_iter());
            list.remnants.sort_unstable_by_key(|r| (r.i, r.block, r.j));
        }
    }
}

impl State {
    /// Calls `f` with the number of every unbroken bond and its entry, block by block.
    pub(crate) fn each_bond(&self, mut f: impl FnMut(u32, (u32, Entry))) {
        for (b, block) in self.blocks.iter().enumerate() {
            let cross = self.bonds.cross.get(b);
            for e in block.bonds.iter().chain(cross.into_iter().flat_map(BondList::iter)) {
                f(e.number, (b as u32, e));
            }
        }
    }

    /// Calls `f` with every pair that was bonded and has not separated yet, and the block of its first body.
    pub(crate) fn each_remnant(&self, mut f: impl FnMut(u32, &Remnant)) {
        for (b, block) in self.blocks.iter().enumerate() {
            let cross = self.bonds.cross.get(b).map_or(&[][..], |list| &list.remnants);
            block.bonds.remnants.iter().chain(cross).for_each(|r| f(b as u32, r));
        }
    }

    /// Number of unbroken bonds.
    pub fn bond_count(&self) -> usize {
        let lists = self.blocks.iter().map(|b| &b.bonds).chain(&self.bonds.cross);
        lists.map(|list| list.count as usize).sum()
    }

    /// Bonds broken so far, by tension and by shear.
    pub fn broken_bonds(&self) -> (u64, u64) {
        (self.bonds.broken[0], self.bonds.broken[1])
    }

    /// All breaks that nobody has taken, in the order of time.
    pub fn breaks(&self) -> &[Break] {
        &self.bonds.breaks
    }

    /// Breaks since the last call, in the order of time.
    pub fn take_breaks(&mut self) -> Vec<Break> {
        std::mem::take(&mut self.bonds.breaks)
    }
}

/// Pairs of bodies whose contact is not for the ordinary contacts to find: bonded, or not yet separated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Held {
    start: Vec<u32>,
    partner: Vec<u32>,
}

impl Held {
    /// Lists the pairs of a state.
    pub fn update(&mut self, model: &Model, state: &State) {
        self.start.clear();
        self.partner.clear();
        if model.bonds.is_empty() {
            return;
        }
        let mut pairs = Vec::new();
        state.each_bond(|number, _| {
            let bond = &model.bonds[number as usize];
            if !bond.contact {
                pairs.push(bond.ends);
            }
        });
        state.each_remnant(|_, r| pairs.push(model.bonds[r.number as usize].ends));
        pairs.iter_mut().for_each(|p| p.sort_unstable());
        pairs.sort_unstable();
        self.start.resize(model.body_count() + 1, 0);
        for [a, _] in &pairs {
            self.start[*a as usize + 1] += 1;
        }
        for k in 1..self.start.len() {
            self.start[k] += self.start[k - 1];
        }
        self.partner.extend(pairs.iter().map(|p| p[1]));
    }

    /// Whether two bodies are held.
    #[inline]
    pub fn has(&self, a: u32, b: u32) -> bool {
        if self.start.is_empty() {
            return false;
        }
        let (a, b) = (a.min(b), a.max(b));
        let row = self.start[a as usize] as usize..self.start[a as usize + 1] as usize;
        self.partner[row].contains(&b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left keeps its order, its memory and its constants, and lanes without a bond have none.
    #[test]
    fn bonds_move_up_when_others_are_taken_out() {
        let memory = |k: f64| Memory { shear: V3::new(k, 2.0 * k, -k), turn: V3::new(-k, k, 0.5 * k) };
        let entry = |k: u32| Entry { number: k, i: k + 1, block: 7, j: k + 2, memory: memory(f64::from(k)) };
        for gone in
            [&[0][..], &[12], &[3, 4, 5], &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], &[1, 7, 8, 11], &[]]
        {
            let mut list = BondList::default();
            list.fill((0..13).map(entry));
            let mut constants = vec![[Lanes::default(); COUNT]; list.groups.len()];
            (0..13).for_each(|k| set_constants(&mut constants, k, [k as f64 + 0.5; COUNT]));
            list.remove(&mut constants, gone.iter().copied());
            let left: Vec<u32> = (0..13).filter(|k| !gone.contains(k)).collect();
            assert_eq!(list.count as usize, left.len());
            assert_eq!(
                (list.groups.len(), constants.len()),
                (left.len().div_ceil(4), left.len().div_ceil(4))
            );
            for at in 0..4 * constants.len() {
                let (e, own) = (list.get(at), constants[at / 4].map(|c| c[at % 4]));
                let Some(&k) = left.get(at) else {
                    assert_eq!((e.number, e.i, own), (NONE, list.get(at / 4 * 4).i, [0.0; COUNT]));
                    continue;
                };
                assert_eq!((e.number, e.i, e.block, e.j), (k, k + 1, 7, k + 2));
                assert_eq!((e.memory.shear.y, e.memory.turn.z), (2.0 * f64::from(k), 0.5 * f64::from(k)));
                assert_eq!(own, [f64::from(k) + 0.5; COUNT]);
            }
        }
    }
}
