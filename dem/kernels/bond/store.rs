//! Bond lists in groups of four, per block, and between blocks by the first body's block; unbroken bonds
//! only.

use super::debonded::DebondedPair;
use super::kernel::{BondHistory, COUNT};
use super::{Break, Constants};
use crate::base::capacity::capacity_bytes;
use crate::lanes::V3;
use crate::lanes::vec4::Vec4;
use serde::{Deserialize, Serialize, Serializer};

/// Index of an unused lane.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Group {
    /// Bond indices.
    pub number: [u32; 4],
    /// Slot of the first body; block and slot of the second.
    pub i: [u32; 4],
    pub block: [u32; 4],
    pub j: [u32; 4],
    pub shear: [Vec4; 3],
    pub turn: [Vec4; 3],
}

#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub number: u32,
    pub i: u32,
    pub block: u32,
    pub j: u32,
    pub memory: BondHistory<f64>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct BondList {
    #[serde(serialize_with = "without_spare_lanes")]
    pub groups: Vec<Group>,
    pub count: u32,
    pub debonded: Vec<DebondedPair>,
}

/// Unused lanes contain arbitrary values; they are saved as zero.
fn without_spare_lanes<S: Serializer>(groups: &[Group], serializer: S) -> Result<S::Ok, S::Error> {
    let mut groups = groups.to_vec();
    for g in &mut groups {
        for l in (0..4).filter(|&l| g.number[l] == NONE) {
            g.shear.iter_mut().chain(&mut g.turn).for_each(|v| v[l] = 0.0);
        }
    }
    groups.serialize(serializer)
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct BondState {
    /// Between blocks, by the first body's block.
    pub cross: Vec<BondList>,
    /// No step yet: previous motion is ignored.
    pub fresh: bool,
    /// Dashpot power in the last step [W].
    pub power: f64,
    /// Breaks by tension, shear.
    pub broken: [u64; 2],
    /// Not yet collected.
    pub breaks: Vec<Break>,
}

impl BondHistory<f64> {
    pub const NONE: BondHistory<f64> =
        BondHistory { shear: V3 { x: 0.0, y: 0.0, z: 0.0 }, turn: V3 { x: 0.0, y: 0.0, z: 0.0 } };
}

impl BondList {
    pub fn get(&self, at: usize) -> Entry {
        let (g, l) = (&self.groups[at / 4], at % 4);
        let vector = |v: &[Vec4; 3]| V3::new(v[0][l], v[1][l], v[2][l]);
        let memory = BondHistory { shear: vector(&g.shear), turn: vector(&g.turn) };
        Entry { number: g.number[l], i: g.i[l], block: g.block[l], j: g.j[l], memory }
    }

    pub fn set(&mut self, at: usize, e: &Entry) {
        let (g, l) = (&mut self.groups[at / 4], at % 4);
        (g.number[l], g.i[l], g.block[l], g.j[l]) = (e.number, e.i, e.block, e.j);
        for (to, v) in [(&mut g.shear, e.memory.shear), (&mut g.turn, e.memory.turn)] {
            (to[0][l], to[1][l], to[2][l]) = (v.x, v.y, v.z);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..self.count as usize).map(|at| self.get(at))
    }

    pub fn fill(&mut self, bonds: impl Iterator<Item = Entry>) {
        self.groups.clear();
        self.count = 0;
        for e in bonds {
            let at = self.count as usize;
            if at.is_multiple_of(4) {
                // Unused lanes repeat a real pair with zero constants.
                let zero = [Vec4::default(); 3];
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

    /// Removes the bonds at ascending positions and their constants.
    pub fn remove(
        &mut self,
        constants: &mut Vec<[Vec4; COUNT]>,
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
            let e = Entry { number: NONE, memory: BondHistory::NONE, ..self.get(to / 4 * 4) };
            self.set(to, &e);
            set_constants(constants, to, [0.0; COUNT]);
            to += 1;
        }
    }

    pub fn constants(&self, bonds: &[Constants], out: &mut Vec<[Vec4; COUNT]>) {
        out.clear();
        out.extend(self.groups.iter().map(|g| {
            let mut k = [Vec4::default(); COUNT];
            for (l, &number) in g.number.iter().enumerate().filter(|(_, n)| **n != NONE) {
                for (to, value) in k.iter_mut().zip(&bonds[number as usize].values) {
                    to[l] = *value;
                }
            }
            k
        }));
    }
}

fn set_constants(constants: &mut [[Vec4; COUNT]], at: usize, own: [f64; COUNT]) {
    for (to, x) in constants[at / 4].iter_mut().zip(own) {
        to[at % 4] = x;
    }
}

#[derive(Clone, Debug, Default)]
pub struct BondedPairs {
    start: Vec<u32>,
    partner: Vec<u32>,
}

impl BondedPairs {
    /// `bodies`: body count.
    pub fn set(&mut self, bodies: usize, mut pairs: Vec<[u32; 2]>) {
        self.start.clear();
        self.partner.clear();
        if pairs.is_empty() {
            return;
        }
        pairs.iter_mut().for_each(|p| p.sort_unstable());
        pairs.sort_unstable();
        self.start.resize(bodies + 1, 0);
        for [a, _] in &pairs {
            self.start[*a as usize + 1] += 1;
        }
        for k in 1..self.start.len() {
            self.start[k] += self.start[k - 1];
        }
        self.partner.extend(pairs.iter().map(|p| p[1]));
    }

    pub fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        let rows = self.start.windows(2).enumerate();
        rows.flat_map(|(a, w)| self.partner[w[0] as usize..w[1] as usize].iter().map(move |b| [a as u32, *b]))
    }

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

impl BondList {
    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.groups) + capacity_bytes(&self.debonded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn removal_shifts_later_bonds() {
        let memory = |k: f64| BondHistory { shear: V3::new(k, 2.0 * k, -k), turn: V3::new(-k, k, 0.5 * k) };
        let entry = |k: u32| Entry { number: k, i: k + 1, block: 7, j: k + 2, memory: memory(f64::from(k)) };
        for gone in
            [&[0][..], &[12], &[3, 4, 5], &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], &[1, 7, 8, 11], &[]]
        {
            let mut list = BondList::default();
            list.fill((0..13).map(entry));
            let mut constants = vec![[Vec4::default(); COUNT]; list.groups.len()];
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
