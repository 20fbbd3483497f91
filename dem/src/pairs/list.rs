//! Lists of pairs that may touch in several points at once, with the memory of each point: what pairs of kinds without
//! loops over lanes are kept in (`contact/kind`).

use crate::base::held::held;
use crate::law::History;
use serde::{Deserialize, Serialize};

/// Feature of a contact point that is not in use.
pub(crate) const NO_FEATURE: u32 = u32::MAX;

/// Memory of one contact point: the features that touch there, what the law keeps, and the share of its force that acted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PointMemory {
    pub feature: u32,
    pub history: History,
    pub weight: f64,
}

impl PointMemory {
    /// No contact.
    pub const NONE: PointMemory = PointMemory { feature: NO_FEATURE, history: History::NONE, weight: 0.0 };

    /// The same contact seen from the other partner: the halves of the feature change places.
    pub fn turned(&self) -> PointMemory {
        if self.feature == NO_FEATURE {
            return *self;
        }
        PointMemory { feature: self.feature.rotate_left(16), history: self.history.turned(), ..*self }
    }
}

/// First partner in the block that holds the list, block of the second, second partner there.
pub(crate) type PairName = [u32; 3];

/// Pairs of one kind, in ascending order of their names but while they are sorted anew.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Flat", into = "Flat")]
pub(crate) struct PairList {
    /// Contact points that a pair can have.
    points: usize,
    names: Vec<PairName>,
    /// Points of each pair in turn.
    memory: Vec<PointMemory>,
    /// No second partner lies in a later block than this.
    last_block: u32,
}

/// What a checkpoint holds.
#[derive(Serialize, Deserialize)]
struct Flat {
    points: usize,
    names: Vec<PairName>,
    memory: Vec<PointMemory>,
}

impl From<PairList> for Flat {
    fn from(list: PairList) -> Flat {
        Flat { points: list.points, names: list.names, memory: list.memory }
    }
}

impl TryFrom<Flat> for PairList {
    type Error = &'static str;

    fn try_from(flat: Flat) -> Result<PairList, &'static str> {
        if flat.names.len().checked_mul(flat.points) != Some(flat.memory.len()) {
            return Err("a list of pairs with names and memory of unlike length");
        }
        let last_block = flat.names.iter().map(|n| n[1]).max().unwrap_or(0);
        Ok(PairList { points: flat.points, names: flat.names, memory: flat.memory, last_block })
    }
}

impl PairList {
    /// No pairs; each can have so many contact points.
    pub fn new(points: usize) -> PairList {
        PairList { points, ..PairList::default() }
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// No second partner lies in a later block than this.
    pub fn last_block(&self) -> u32 {
        self.last_block
    }

    pub fn name(&self, k: usize) -> PairName {
        self.names[k]
    }

    /// Contact points of a pair.
    pub fn points(&self, k: usize) -> &[PointMemory] {
        &self.memory[k * self.points..][..self.points]
    }

    /// Contact points of a pair, to be changed.
    pub fn points_mut(&mut self, k: usize) -> &mut [PointMemory] {
        &mut self.memory[k * self.points..][..self.points]
    }

    /// Adds a pair with the memory of its points.
    pub fn push(&mut self, name: PairName, points: impl IntoIterator<Item = PointMemory>) {
        self.names.push(name);
        self.memory.extend(points);
        self.last_block = self.last_block.max(name[1]);
        debug_assert_eq!(self.memory.len(), self.names.len() * self.points);
    }

    /// Replaces the pairs by those of ascending names, keeping the memory of those that were there.
    pub fn replace(&mut self, names: impl Iterator<Item = PairName>) {
        let old = std::mem::replace(self, PairList::new(self.points));
        let mut k = 0;
        for name in names {
            while k < old.len() && old.name(k) < name {
                k += 1;
            }
            if k < old.len() && old.name(k) == name {
                self.push(name, old.points(k).iter().copied());
            } else {
                self.push(name, std::iter::repeat_n(PointMemory::NONE, old.points));
            }
        }
    }

    /// Sorts by name.
    pub fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_unstable_by_key(|&k| self.name(k));
        let mut sorted = PairList::new(self.points);
        order.iter().for_each(|&k| sorted.push(self.name(k), self.points(k).iter().copied()));
        *self = sorted;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        held(&self.names) + held(&self.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    fn point(feature: u32) -> PointMemory {
        let history = History { spring: Vec3::x() * f64::from(feature), rate: 0.5, ..History::NONE };
        PointMemory { feature, history, weight: 0.5 }
    }

    #[test]
    fn pairs_that_stay_keep_their_points_and_go_through_a_checkpoint() {
        let mut list = PairList::new(2);
        for k in [7, 3, 5] {
            list.push([k, 4, 1], [point(k), PointMemory::NONE]);
        }
        list.sort();
        list.replace([[3, 4, 1], [4, 9, 0], [7, 4, 1]].into_iter());
        let kept: Vec<_> = (0..3).map(|k| list.points(k)[0]).collect();
        assert_eq!(kept, [point(3), PointMemory::NONE, point(7)]);
        assert_eq!(list.last_block(), 9);
        let mut flat = Flat::from(list.clone());
        assert_eq!(PairList::try_from(Flat::from(list.clone())).unwrap(), list);
        flat.memory.pop();
        assert!(PairList::try_from(flat).is_err());
    }

    #[test]
    fn a_point_turned_twice_is_itself() {
        let p = point(0x1234_5678);
        assert_eq!(p.turned().feature, 0x5678_1234);
        assert_eq!(p.turned().turned(), p);
        assert_eq!(PointMemory::NONE.turned(), PointMemory::NONE);
    }
}
