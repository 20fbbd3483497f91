//! Pairs with several contact points and their history, without SIMD.

use crate::base::capacity::capacity_bytes;
use crate::law::History;
use serde::{Deserialize, Serialize};

/// History of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactHistory {
    pub feature: u32,
    pub history: History,
    pub weight: f64,
    pub edge: bool,
}

impl ContactHistory {
    pub const FRESH: ContactHistory =
        ContactHistory { feature: 0, history: History::NONE, weight: 0.0, edge: false };

    /// Seen from the other partner: feature halves swap.
    pub fn turned(&self) -> ContactHistory {
        ContactHistory { feature: self.feature.rotate_left(16), history: self.history.turned(), ..*self }
    }
}

/// Local first partner, block of the second, second partner.
pub type PairName = [u32; 3];

/// Acceleration hint without effect on results; not saved in checkpoints.
pub type Hint = Option<[f64; 4]>;

/// First point, count, capacity.
#[derive(Clone, Copy, Debug)]
struct Span {
    first: u32,
    count: u32,
    room: u32,
}

/// Capacity increment.
const ROOM: usize = 4;

/// Pairs of one type, ascending except during re-sorting.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(try_from = "Flat", into = "Flat")]
pub struct PairList {
    names: Vec<PairName>,
    spans: Vec<Span>,
    hints: Vec<Hint>,
    memory: Vec<ContactHistory>,
    /// Bound on the second partner's block.
    last_block: u32,
}

#[derive(Serialize, Deserialize)]
struct Flat {
    names: Vec<PairName>,
    counts: Vec<u32>,
    memory: Vec<ContactHistory>,
}

impl From<PairList> for Flat {
    fn from(list: PairList) -> Flat {
        let memory = (0..list.len()).flat_map(|k| list.points(k)).copied().collect();
        Flat { counts: list.spans.iter().map(|s| s.count).collect(), memory, names: list.names }
    }
}

impl TryFrom<Flat> for PairList {
    type Error = &'static str;

    fn try_from(flat: Flat) -> Result<PairList, &'static str> {
        let whole = flat.counts.iter().try_fold(0_usize, |sum, n| sum.checked_add(*n as usize));
        if flat.names.len() != flat.counts.len() || whole != Some(flat.memory.len()) {
            return Err("a list of pairs with names and history of different lengths");
        }
        let (mut list, mut rest) = (PairList::default(), &flat.memory[..]);
        for (name, count) in flat.names.iter().zip(&flat.counts) {
            let (points, others) = rest.split_at(*count as usize);
            list.push(*name, points);
            rest = others;
        }
        Ok(list)
    }
}

impl PartialEq for PairList {
    fn eq(&self, other: &PairList) -> bool {
        self.names == other.names && (0..self.len()).all(|k| self.points(k) == other.points(k))
    }
}

impl PairList {
    /// Copies without reallocation.
    pub fn copy_from(&mut self, other: &PairList) {
        let PairList { names, spans, hints, memory, last_block } = other;
        self.names.clone_from(names);
        self.spans.clone_from(spans);
        self.hints.clone_from(hints);
        self.memory.clone_from(memory);
        self.last_block = *last_block;
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Bound on the second partner's block.
    pub fn last_block(&self) -> u32 {
        self.last_block
    }

    pub fn name(&self, k: usize) -> PairName {
        self.names[k]
    }

    pub fn points(&self, k: usize) -> &[ContactHistory] {
        let span = self.spans[k];
        &self.memory[span.first as usize..][..span.count as usize]
    }

    pub fn set(&mut self, k: usize, points: &[ContactHistory]) {
        let span = &mut self.spans[k];
        if points.len() > span.room as usize {
            *span = room(&mut self.memory, points.len());
        }
        span.count = points.len() as u32;
        self.memory[span.first as usize..][..points.len()].copy_from_slice(points);
    }

    pub fn hint_mut(&mut self, k: usize) -> &mut Hint {
        &mut self.hints[k]
    }

    pub fn push(&mut self, name: PairName, points: &[ContactHistory]) {
        self.names.push(name);
        self.spans.push(room(&mut self.memory, points.len()));
        self.hints.push(None);
        self.last_block = self.last_block.max(name[1]);
        self.set(self.len() - 1, points);
    }

    /// Replaces pairs by ascending `names`; history is kept.
    pub fn replace(&mut self, names: impl Iterator<Item = PairName>) {
        let old = std::mem::take(self);
        let mut k = 0;
        for name in names {
            while k < old.len() && old.name(k) < name {
                k += 1;
            }
            if k < old.len() && old.name(k) == name {
                self.push(name, old.points(k));
                self.hints[self.names.len() - 1] = old.hints[k];
            } else {
                self.push(name, &[]);
            }
        }
    }

    pub fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_unstable_by_key(|&k| self.name(k));
        let mut sorted = PairList::default();
        order.iter().for_each(|&k| sorted.push(self.name(k), self.points(k)));
        *self = sorted;
    }

    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.names)
            + capacity_bytes(&self.spans)
            + capacity_bytes(&self.hints)
            + capacity_bytes(&self.memory)
    }
}

fn room(memory: &mut Vec<ContactHistory>, count: usize) -> Span {
    let (first, room) = (memory.len(), count.next_multiple_of(ROOM));
    memory.resize(first + room, ContactHistory::FRESH);
    Span { first: first as u32, count: 0, room: room as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Vec3;

    fn point(feature: u32) -> ContactHistory {
        let history = History { spring: Vec3::x() * f64::from(feature), rate: 0.5, ..History::NONE };
        ContactHistory { feature, history, weight: 0.5, edge: true }
    }

    #[test]
    fn kept_pairs_survive_checkpoint() {
        let mut list = PairList::default();
        for k in [7, 3, 5] {
            list.push([k, 4, 1], &[point(k), point(k + 1)][..k as usize / 3]);
        }
        list.sort();
        *list.hint_mut(2) = Some([1.0; 4]);
        list.replace([[3, 4, 1], [4, 9, 0], [7, 4, 1]].into_iter());
        let kept: Vec<_> = (0..3).map(|k| list.points(k).to_vec()).collect();
        assert_eq!(kept, [vec![point(3)], vec![], vec![point(7), point(8)]]);
        assert_eq!((*list.hint_mut(0), *list.hint_mut(2)), (None, Some([1.0; 4])));
        assert_eq!(list.last_block(), 9);
        let mut flat = Flat::from(list.clone());
        assert_eq!(PairList::try_from(Flat::from(list.clone())).unwrap(), list);
        flat.memory.pop();
        assert!(PairList::try_from(flat).is_err());
        let mut flat = Flat::from(list);
        flat.counts = vec![u32::MAX, 1, 3];
        assert!(PairList::try_from(flat).is_err());
    }

    #[test]
    fn pair_stores_many_points() {
        let mut list = PairList::default();
        list.push([0, 0, 1], &[]);
        list.push([0, 0, 2], &[point(9)]);
        for count in [1, 5, 3, 200, 0, 17] {
            let points: Vec<_> = (0..count).map(point).collect();
            list.set(0, &points);
            assert_eq!(list.points(0), points);
            assert_eq!(list.points(1), [point(9)]);
        }
        let held = list.bytes();
        list.replace([[0, 0, 1], [0, 0, 2]].into_iter());
        assert!(list.points(0).len() == 17 && list.bytes() < held);
    }

    #[test]
    fn a_point_turned_twice_is_itself() {
        let p = point(0x1234_5678);
        assert_eq!(p.turned().feature, 0x5678_1234);
        assert_eq!(p.turned().turned(), p);
    }
}
