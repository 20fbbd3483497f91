//! A state as the flat arrays that a device keeps, and back.
//!
//! Bodies lie block by block, contacts list by list: across blocks, within them, with planes, each block by block. Each body has the
//! contacts that it takes part in as entries, in the order in which the engine adds them up.

use super::layout::LISTS;
use crate::bodies::members::Members;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::law::History;
use crate::pairs::groups::Groups;

/// Motion of all bodies: position and radius, velocity and inverse mass, spin and material.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub x: Vec<[f64; 4]>,
    pub v: Vec<[f64; 4]>,
    pub w: Vec<[f64; 4]>,
}

impl Motion {
    /// That of a state.
    pub fn of(state: &State) -> Motion {
        let mut out = Motion::default();
        for block in &state.blocks {
            out.x.extend(block.centre.iter().map(|r| r.0));
            out.v.extend(block.velocity.iter().map(|r| r.0));
            out.w.extend(block.spin.iter().map(|r| r.0));
        }
        out
    }

    /// Puts it into a state with the same bodies in the same order.
    pub fn put(&self, state: &mut State) {
        let mut at = 0;
        for block in &mut state.blocks {
            let n = block.bodies.len();
            let lists =
                [(&mut block.centre, &self.x), (&mut block.velocity, &self.v), (&mut block.spin, &self.w)];
            for (to, from) in lists {
                to.iter_mut().zip(&from[at..at + n]).for_each(|(to, from)| to.0 = *from);
            }
            at += n;
        }
    }
}

/// Constants of all bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Constants {
    /// Zero for bodies that move four at a time, else 1 and twice the bits of fixed motions.
    pub single: Vec<u32>,
    /// Mass and moment of inertia.
    pub inertia: Vec<[f64; 2]>,
}

impl Constants {
    pub fn of(model: &Model, state: &State, work: &Work) -> Constants {
        let mut out = Constants::default();
        for (block, members) in state.blocks.iter().zip(&work.members) {
            let n = block.bodies.len();
            for (k, &body) in block.bodies.iter().enumerate() {
                let fixed = members.fixed.get(k).copied().unwrap_or(0);
                let body = model.body(body as usize);
                out.single.push(if by_four(members, k, n) { 0 } else { 1 | u32::from(fixed) << 1 });
                out.inertia.push([body.mass, body.inertia.x]);
            }
        }
        out
    }
}

/// Whether body k of n moves with the others of its group of four (see `integrate/leapfrog.rs`).
fn by_four(members: &Members, k: usize, n: usize) -> bool {
    let group = k - k % 4;
    group + 4 <= n && (members.plain() || members.all_free(group))
}

/// Memory of all contacts: spring and the number of the normal law; rolling and twisting springs.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    pub spring: Vec<[f64; 4]>,
    pub turn: Vec<[f64; 4]>,
}

impl Memory {
    /// That of a state.
    pub fn of(state: &State) -> Memory {
        let mut out = Memory::default();
        let mut add = |h: History| {
            out.spring.push([h.spring.x, h.spring.y, h.spring.z, h.rate]);
            out.turn.push(h.turn);
        };
        state.cross.iter().for_each(|c| c.spheres.iter().for_each(|(_, h)| add(h)));
        state.lists.iter().for_each(|l| l.pairs.iter().for_each(|(_, h)| add(h)));
        state.lists.iter().for_each(|l| l.planes.iter().for_each(|(_, h)| add(h)));
        out
    }

    /// Puts it into a state with the same lists.
    pub fn put(&self, state: &mut State) {
        let mut at = 0;
        state.cross.iter_mut().for_each(|c| self.fill(&mut c.spheres, &mut at));
        state.lists.iter_mut().for_each(|l| self.fill(&mut l.pairs, &mut at));
        state.lists.iter_mut().for_each(|l| self.fill(&mut l.planes, &mut at));
    }

    fn fill<const N: usize>(&self, list: &mut Groups<N>, at: &mut usize) {
        for k in 0..list.len() {
            let ([x, y, z, rate], turn) = (self.spring[*at], self.turn[*at]);
            let turn = if list.turning { turn } else { [0.0; 4] };
            list.set_history(k, &History { spring: crate::Vec3::new(x, y, z), rate, turn });
            *at += 1;
        }
    }
}

/// Who touches whom.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// Bodies of each contact; the second of those with planes is the plane.
    pub ends: Vec<[u32; 2]>,
    /// Where the entries of each body begin, and one past the last.
    pub start: Vec<u32>,
    pub entries: Vec<u32>,
    /// Where the lists of each block begin, and one past the last of each.
    pub ranges: Vec<[u32; LISTS]>,
    pub first_plane: u32,
}

impl Lists {
    pub fn of(state: &State, work: &Work) -> Lists {
        let mut first = vec![0_u32];
        state.blocks.iter().for_each(|b| first.push(first[first.len() - 1] + b.bodies.len() as u32));
        let mut out = Lists { ranges: vec![[0; LISTS]; state.blocks.len() + 1], ..Lists::default() };
        for (b, cross) in state.cross.iter().enumerate() {
            out.ranges[b][1] = out.ends.len() as u32;
            out.ends
                .extend(cross.spheres.iter().map(|([i, to, j], _)| [first[b] + i, first[to as usize] + j]));
        }
        for (b, lists) in state.lists.iter().enumerate() {
            out.ranges[b][2] = out.ends.len() as u32;
            out.ends.extend(lists.pairs.iter().map(|(name, _)| name.map(|k| first[b] + k)));
        }
        out.first_plane = out.ends.len() as u32;
        for (b, lists) in state.lists.iter().enumerate() {
            out.ranges[b][3] = out.ends.len() as u32;
            out.ends.extend(lists.planes.iter().map(|([i, plane], _)| [first[b] + i, plane]));
        }
        for (range, first) in out.ranges.iter_mut().zip(&first) {
            range[0] = *first;
        }
        let last = state.blocks.len();
        let own = out.ranges.first().map_or(0, |r| r[2]);
        out.ranges[last] = [first[last], own, out.first_plane, out.ends.len() as u32];
        out.enter(state, work, &first);
        out
    }

    /// Enters the contacts with their bodies: across blocks in the order of shares, then within, then planes.
    fn enter(&mut self, state: &State, work: &Work, first: &[u32]) {
        let mut all: Vec<(u32, u32)> = Vec::with_capacity(2 * self.ends.len());
        for (b, w) in work.blocks.iter().enumerate() {
            for share in &w.shares.list {
                let from = share.block as usize;
                let slot = (share.record() / work.cross[from].width) as u32;
                let contact = self.ranges[from][1] + slot;
                all.push((first[b] + share.place, contact << 2 | u32::from(!share.first())));
            }
        }
        let bodies = first[state.blocks.len()] as usize;
        let own = self.ranges.first().map_or(0, |r| r[2]);
        for contact in own..self.first_plane {
            let [i, j] = self.ends[contact as usize];
            all.push((i, contact << 2));
            all.push((j, contact << 2 | 1));
        }
        let planes = self.first_plane..self.ends.len() as u32;
        all.extend(planes.map(|contact| (self.ends[contact as usize][0], contact << 2 | 2)));
        // Sorted by body; the order of each body's entries stays.
        self.start = vec![0; bodies + 1];
        all.iter().for_each(|(body, _)| self.start[*body as usize + 1] += 1);
        (0..bodies).for_each(|k| self.start[k + 1] += self.start[k]);
        let mut next = self.start.clone();
        self.entries = vec![0; all.len()];
        for (body, entry) in all {
            let to = &mut next[body as usize];
            self.entries[*to as usize] = entry;
            *to += 1;
        }
    }
}
