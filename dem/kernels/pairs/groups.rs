//! Contact lists with history, in SIMD groups of four.
//!
//! Unused lanes repeat the first contact's name, without history.

use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::lanes::vec4::Vec4;
use crate::law::{History, NO_CONTACT};
use serde::{Deserialize, Serialize};

/// Four contacts: N indices each, and history.
#[derive(Clone, Copy, Debug)]
pub struct Group<const N: usize> {
    names: [[u32; 4]; N],
    pub springs: Springs,
}

#[derive(Clone, Copy, Debug)]
pub struct Springs {
    pub spring: [Vec4; 3],
    pub rate: Vec4,
}

impl<const N: usize> Group<N> {
    #[inline(always)]
    pub fn parts(&mut self) -> (&[[u32; 4]; N], &mut Springs) {
        (&self.names, &mut self.springs)
    }

    #[inline(always)]
    pub fn names(&self) -> &[[u32; 4]; N] {
        &self.names
    }

    /// Inactive self-contacts of body 0.
    pub const EMPTY: Group<N> = Group {
        names: [[0; 4]; N],
        springs: Springs { spring: [Vec4([0.0; 4]); 3], rate: Vec4([NO_CONTACT; 4]) },
    };
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(into = "Flat", try_from = "Flat")]
pub struct Groups<const N: usize> {
    len: usize,
    /// Largest names, by component.
    most: [u32; N],
    pub groups: Vec<Group<N>>,
    /// Rolling and twisting springs; empty unless `turning`.
    pub turns: Vec<[Vec4; 4]>,
    pub turning: bool,
}

impl<const N: usize> Default for Groups<N> {
    fn default() -> Groups<N> {
        Groups::new(false)
    }
}

impl<const N: usize> Groups<N> {
    pub fn new(turning: bool) -> Groups<N> {
        Groups { len: 0, most: [0; N], groups: Vec::new(), turns: Vec::new(), turning }
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Component-wise bound of names.
    pub fn most(&self) -> [u32; N] {
        self.most
    }

    pub fn clear(&mut self) {
        self.len = 0;
        self.most = [0; N];
        self.groups.clear();
        self.turns.clear();
    }

    #[inline(always)]
    pub fn push(&mut self, name: [u32; N], history: &History) {
        let (g, lane) = (self.len / 4, self.len % 4);
        if self.len.is_multiple_of(8) {
            self.groups.extend([Group { names: name.map(|n| [n; 4]), ..Group::EMPTY }; 2]);
            if self.turning {
                self.turns.extend([[Vec4::default(); 4]; 2]);
            }
        }
        for ((names, most), n) in self.groups[g].names.iter_mut().zip(&mut self.most).zip(name) {
            names[lane] = n;
            *most = n.max(*most);
        }
        self.len += 1;
        self.set_history(self.len - 1, history);
    }

    #[inline(always)]
    pub fn name(&self, k: usize) -> [u32; N] {
        self.groups[k / 4].names.map(|n| n[k % 4])
    }

    #[inline(always)]
    pub fn history(&self, k: usize) -> History {
        let (g, lane) = (&self.groups[k / 4].springs, k % 4);
        let spring = Vec3::new(g.spring[0][lane], g.spring[1][lane], g.spring[2][lane]);
        let turn = if self.turning { self.turns[k / 4].map(|t| t[lane]) } else { [0.0; 4] };
        History { spring, rate: g.rate[lane], turn }
    }

    #[inline(always)]
    pub fn set_history(&mut self, k: usize, history: &History) {
        let (g, lane) = (&mut self.groups[k / 4].springs, k % 4);
        for d in 0..3 {
            g.spring[d][lane] = history.spring[d];
        }
        g.rate[lane] = history.rate;
        if self.turning {
            for (t, x) in self.turns[k / 4].iter_mut().zip(history.turn) {
                t[lane] = x;
            }
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = ([u32; N], History)> + '_ {
        (0..self.len).map(|k| (self.name(k), self.history(k)))
    }

    /// Copies without reallocation.
    pub fn copy_from(&mut self, other: &Groups<N>) {
        self.clear();
        (self.len, self.most) = (other.len, other.most);
        self.groups.reserve_exact(other.groups.len());
        self.groups.extend_from_slice(&other.groups);
        self.turns.reserve_exact(other.turns.len());
        self.turns.extend_from_slice(&other.turns);
        self.turning = other.turning;
    }

    pub fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.len).collect();
        order.sort_unstable_by_key(|&k| self.name(k));
        let mut sorted = Groups::new(self.turning);
        sorted.groups.reserve_exact(self.groups.len());
        order.iter().for_each(|&k| sorted.push(self.name(k), &self.history(k)));
        *self = sorted;
    }
}

#[derive(Serialize, Deserialize)]
struct Flat {
    turning: bool,
    names: Vec<u32>,
    memory: Vec<f64>,
}

impl<const N: usize> From<Groups<N>> for Flat {
    fn from(list: Groups<N>) -> Flat {
        let names = list.iter().flat_map(|(name, _)| name).collect();
        let numbers = |h: History| {
            let turn = h.turn.into_iter().take(if list.turning { 4 } else { 0 });
            [h.spring.x, h.spring.y, h.spring.z, h.rate].into_iter().chain(turn)
        };
        let memory = list.iter().flat_map(|(_, h)| numbers(h)).collect();
        Flat { turning: list.turning, names, memory }
    }
}

impl<const N: usize> TryFrom<Flat> for Groups<N> {
    type Error = &'static str;

    fn try_from(flat: Flat) -> Result<Groups<N>, &'static str> {
        let width = if flat.turning { 8 } else { 4 };
        if !flat.names.len().is_multiple_of(N) || flat.memory.len() != flat.names.len() / N * width {
            return Err("a list of contacts with names and history of different lengths");
        }
        let mut list = Groups::new(flat.turning);
        for (name, m) in flat.names.chunks_exact(N).zip(flat.memory.chunks_exact(width)) {
            let mut turn = [0.0; 4];
            turn[..width - 4].copy_from_slice(&m[4..]);
            let history = History { spring: Vec3::new(m[0], m[1], m[2]), rate: m[3], turn };
            list.push(std::array::from_fn(|k| name[k]), &history);
        }
        Ok(list)
    }
}

impl<const N: usize> Groups<N> {
    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.groups) + capacity_bytes(&self.turns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_sorts_and_restores_checkpoint() {
        for turning in [false, true] {
            let mut list = Groups::<2>::new(turning);
            let history = |k: u32| {
                let x = f64::from(k);
                let turn = if turning { [x, 2.0 * x, -x, 0.5] } else { [0.0; 4] };
                History { spring: Vec3::new(x, -x, 0.1), rate: 3.0 * x, turn }
            };
            (0..7).for_each(|k| list.push([k * 5 % 7, k], &history(k)));
            list.sort();
            let names: Vec<u32> = list.iter().map(|(n, _)| n[0]).collect();
            assert_eq!(names, [0, 1, 2, 3, 4, 5, 6]);
            let back = Groups::<2>::try_from(Flat::from(list.clone())).unwrap();
            for list in [&list, &back] {
                assert_eq!(list.len(), 7);
                list.iter().for_each(|(n, h)| assert_eq!(h, history(n[1])));
            }
            let mut flat = Flat::from(list);
            flat.memory.pop();
            assert!(Groups::<2>::try_from(flat).is_err());
        }
    }
}
