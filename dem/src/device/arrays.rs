//! Flat device arrays of contacts and bonds.
//!
//! Order of lists, by blocks: cross-block, in-block, planes, debonded (cross, in-block), periodic, triangles.
//! Entries of a body follow the engine's order of summation.

use super::bodies::Spheres;
use super::cpu_forces::Source;
use super::layout::{EntryKind, LISTS, List, entry, parts_of};
use super::walls::{Pairs, PatchHistory};
use crate::Vec3;
use crate::bond::BondList;
use crate::bond::debonded::DebondedPair;
use crate::bond::kernel;
use crate::bond::store::Entry;
use crate::engine::cpu_part;
use crate::engine::model::Model;
use crate::engine::state::{BlockLists, State};
use crate::engine::work::Work;
use crate::lanes::V3;
use crate::law::History;
use crate::pairs::cross::ImageName;
use crate::pairs::groups::Groups;
use crate::pairs::patches::PatchPair;

fn bond_lists(state: &State) -> [Vec<&BondList>; 2] {
    [state.bonds.cross.iter().collect(), state.lists.iter().map(|l| &l.bonds).collect()]
}

fn bond_lists_mut(state: &mut State) -> impl Iterator<Item = &mut BondList> {
    state.bonds.cross.iter_mut().chain(state.lists.iter_mut().map(|l| &mut l.bonds))
}

fn add_to(spring: &mut Vec<[f64; 4]>, turn: &mut Vec<[f64; 4]>, h: History) {
    spring.push([h.spring.x, h.spring.y, h.spring.z, h.rate]);
    turn.push(h.turn);
}

/// History of all contacts (springs, normal-law value) and bonds (shear, rotation).
#[derive(Clone, Debug, Default)]
pub(super) struct DeviceHistory {
    pub spring: Vec<[f64; 4]>,
    pub turn: Vec<[f64; 4]>,
    pub bonds: Vec<[f64; 4]>,
    pub kept: PatchHistory,
    /// Whether the device computes triangle contacts.
    triangles: bool,
}

impl DeviceHistory {
    pub fn zeros(model: &Model, contacts: usize, pairs: usize, bonds: usize) -> DeviceHistory {
        let zero = [0.0; 4];
        DeviceHistory {
            triangles: !cpu_part::walls(model),
            spring: vec![zero; contacts],
            turn: vec![zero; contacts],
            bonds: vec![zero; 2 * bonds],
            kept: PatchHistory::zeros(pairs),
        }
    }

    pub fn of(model: &Model, state: &State) -> DeviceHistory {
        let mut out = DeviceHistory::zeros(model, 0, 0, 0);
        let DeviceHistory { spring, turn, bonds, .. } = &mut out;
        let mut add = |h: History| add_to(spring, turn, h);
        state.cross.iter().for_each(|c| c.spheres.iter().for_each(|(_, h)| add(h)));
        state.lists.iter().for_each(|l| l.pairs.iter().for_each(|(_, h)| add(h)));
        state.lists.iter().for_each(|l| l.planes.iter().for_each(|(_, h)| add(h)));
        for list in bond_lists(state).iter().flatten() {
            for kernel::BondHistory { shear, turn } in list.iter().map(|e| e.memory) {
                bonds.extend([shear, turn].map(|v| [v.x, v.y, v.z, 0.0]));
            }
        }
        out.add_rest(state);
        out
    }

    /// Contacts other than sphere–sphere and sphere–plane; no bonds.
    pub fn of_rest(model: &Model, state: &State) -> DeviceHistory {
        let mut out = DeviceHistory::zeros(model, 0, 0, 0);
        out.add_rest(state);
        out
    }

    fn add_rest(&mut self, state: &State) {
        let DeviceHistory { spring, turn, kept, .. } = self;
        let mut add = |h: History| add_to(spring, turn, h);
        bond_lists(state).iter().flatten().for_each(|l| l.debonded.iter().for_each(|pair| add(pair.history)));
        state.cross.iter().for_each(|c| c.images.iter().for_each(|image| add(image.history)));
        if self.triangles {
            state.lists.iter().for_each(|l| kept.add(&l.walls, &mut add));
        }
    }

    pub fn put(&self, state: &mut State) {
        let from = self.put_contacts(state);
        self.put_rest(state, from);
    }

    /// Bonds, sphere and plane contacts; returns the number of these contacts.
    pub fn put_contacts(&self, state: &mut State) -> usize {
        let (mut at, mut bond) = (0, 0);
        state.cross.iter_mut().for_each(|c| self.fill(&mut c.spheres, &mut at));
        state.lists.iter_mut().for_each(|l| self.fill(&mut l.pairs, &mut at));
        state.lists.iter_mut().for_each(|l| self.fill(&mut l.planes, &mut at));
        for list in bond_lists_mut(state) {
            for k in 0..list.count as usize {
                let vector = |[x, y, z, _]: [f64; 4]| V3::new(x, y, z);
                let memory = kernel::BondHistory {
                    shear: vector(self.bonds[bond]),
                    turn: vector(self.bonds[bond + 1]),
                };
                list.set(k, &Entry { memory, ..list.get(k) });
                bond += 2;
            }
        }
        at
    }

    pub fn put_rest(&self, state: &mut State, mut at: usize) {
        for DebondedPair { history, .. } in bond_lists_mut(state).flat_map(|list| &mut list.debonded) {
            *history = self.history(at, true);
            at += 1;
        }
        for image in state.cross.iter_mut().flat_map(|c| &mut c.images) {
            image.history = self.history(at, true);
            at += 1;
        }
        let mut pair = 0;
        for lists in state.lists.iter_mut().take_while(|_| self.triangles) {
            let count = lists.walls.pairs.len();
            self.kept.put(&mut lists.walls, pair, |k| self.history(at + pair + k, true));
            pair += count;
        }
    }

    fn history(&self, at: usize, turning: bool) -> History {
        let [x, y, z, rate] = self.spring[at];
        let turn = if turning { self.turn[at] } else { [0.0; 4] };
        History { spring: crate::Vec3::new(x, y, z), rate, turn }
    }

    fn fill<const N: usize>(&self, list: &mut Groups<N>, at: &mut usize) {
        for k in 0..list.len() {
            list.set_history(k, &self.history(*at, list.turning));
            *at += 1;
        }
    }
}

#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// Bodies; the second is the plane in a plane contact.
    pub ends: Vec<[u32; 2]>,
    /// Offsets of the entries of each body, with end.
    pub start: Vec<u32>,
    /// Packed entry (see [`entry`]) and the other body.
    pub entries: Vec<[u32; 2]>,
    /// Block after whose contacts the entry is summed; block count: after all, larger: after sphere and plane
    /// contacts.
    pub after: Vec<u32>,
    /// Offsets of the lists of each block, with end.
    pub ranges: Vec<[u32; LISTS]>,
    pub bond_ends: Vec<[u32; 2]>,
    pub bond_constants: Vec<[f64; kernel::COUNT]>,
    /// Overlap without force [m].
    pub reference: Vec<f64>,
    /// Vector from each sphere to its periodic image [m].
    pub ways: Vec<[f64; 4]>,
    pub pairs: Pairs,
    /// Sources of CPU forces; bodies that the CPU needs: block, index, global index.
    pub handed: Vec<Source>,
    pub watched: Vec<[u32; 3]>,
    blocks: usize,
    first: u32,
}

/// Body, entry, block; in order of summation.
struct Entered {
    all: Vec<[u32; 3]>,
    after: u32,
}

impl Entered {
    fn put(&mut self, body: u32, what: EntryKind, of: u32, second: bool) {
        self.all.push([body, entry(what, of, second), self.after]);
    }
}

impl Lists {
    /// `first`: contacts listed by the device before.
    pub fn of(model: &Model, state: &State, work: &Work, spheres: &Spheres, first: usize) -> Lists {
        let (blocks, first) = (state.blocks.len(), first as u32);
        let mut out = Lists { ranges: vec![[0; LISTS]; blocks + 1], blocks, first, ..Lists::default() };
        let mut bodies = 0;
        for (b, block) in state.blocks.iter().enumerate() {
            out.ranges[b][0] = bodies;
            bodies += block.bodies.len() as u32;
        }
        out.ranges[blocks][0] = bodies;
        out.contacts(state, work, spheres);
        let places =
            [List::CrossDebonded, List::OwnDebonded].into_iter().zip([List::CrossBonds, List::OwnBonds]);
        for ((debonded, bonds), lists) in places.zip(bond_lists(state)) {
            out.bonds(model, debonded, bonds, &lists);
        }
        out.images(model, state, spheres);
        for (b, lists) in state.lists.iter().enumerate() {
            out.ranges[b][List::Patches as usize] = out.next() + out.pairs.ends.len() as u32;
            if !cpu_part::walls(model) {
                out.pairs.add(b, lists, spheres);
            }
        }
        out.ranges[blocks][List::Patches as usize] = out.next() + out.pairs.ends.len() as u32;
        out.enter(model, state, work, spheres);
        out
    }

    pub fn next(&self) -> u32 {
        self.first + self.ends.len() as u32
    }

    fn ends_of(&self, contact: u32) -> [u32; 2] {
        self.ends[(contact - self.first) as usize]
    }

    pub fn from(&self, list: List, block: usize) -> u32 {
        self.ranges[block][list as usize]
    }

    /// Offsets of each sphere: cross-block, in-block, planes.
    pub fn offsets(&self, work: &Work, spheres: &Spheres) -> Vec<u32> {
        let count = spheres.count;
        let mut out = vec![0; 4 * count + 1];
        for (k, list) in [List::Cross, List::Own, List::Planes].into_iter().enumerate() {
            for (b, members) in work.members.iter().enumerate() {
                let by_body = spheres.clumps && !members.rigid && list != List::Cross;
                for of in self.from(list, b)..self.from(list, b + 1) {
                    let i = self.ends_of(of)[0];
                    let sphere = if by_body { spheres.first[i as usize] } else { i };
                    out[k * count + sphere as usize + 1] += 1;
                }
            }
        }
        (0..3 * count).for_each(|k| out[k + 1] += out[k]);
        out
    }

    fn body(&self, block: usize, place: u32) -> u32 {
        self.ranges[block][0] + place
    }

    fn contacts(&mut self, state: &State, work: &Work, spheres: &Spheres) {
        let mark = |out: &mut Lists, list: List, b: usize| out.ranges[b][list as usize] = out.next();
        for (b, cross) in state.cross.iter().enumerate() {
            mark(self, List::Cross, b);
            let ends =
                cross.spheres.iter().map(|([i, to, j], _)| [spheres.at(b, i), spheres.at(to as usize, j)]);
            self.ends.extend(ends);
        }
        mark(self, List::Cross, self.blocks);
        for (b, lists) in state.lists.iter().enumerate() {
            mark(self, List::Own, b);
            let name = |i: u32| if work.members[b].rigid { spheres.at(b, i) } else { self.ranges[b][0] + i };
            self.ends.extend(lists.pairs.iter().map(|([i, j], _)| [name(i), name(j)]));
        }
        mark(self, List::Own, self.blocks);
        for (b, lists) in state.lists.iter().enumerate() {
            mark(self, List::Planes, b);
            let name = |i: u32| if work.members[b].rigid { spheres.at(b, i) } else { self.ranges[b][0] + i };
            self.ends.extend(lists.planes.iter().map(|([i, plane], _)| [name(i), plane]));
        }
        mark(self, List::Planes, self.blocks);
    }

    fn images(&mut self, model: &Model, state: &State, spheres: &Spheres) {
        for (b, cross) in state.cross.iter().enumerate() {
            self.ranges[b][List::Images as usize] = self.next();
            for ImageName { i, block, j, shift } in cross.images.iter().map(|image| image.name) {
                self.ends.push([spheres.at(b, i), spheres.at(block as usize, j)]);
                let way = model.periodic.map_or(Vec3::zeros(), |p| p.image_offset(&shift));
                self.ways.push([way.x, way.y, way.z, 0.0]);
            }
        }
        self.ranges[self.blocks][List::Images as usize] = self.next();
    }

    fn bonds(&mut self, model: &Model, debonded: List, bonds: List, lists: &[&BondList]) {
        let across = bonds == List::CrossBonds;
        for b in 0..=self.blocks {
            self.ranges[b][debonded as usize] = self.next();
            self.ranges[b][bonds as usize] = self.bond_ends.len() as u32;
            let Some(list) = lists.get(b) else { continue };
            let there = |block: u32| if across { block as usize } else { b };
            for pair in &list.debonded {
                self.ends.push([self.body(b, pair.i), self.body(there(pair.block), pair.j)]);
                self.reference.push(pair.reference);
            }
            for e in list.iter() {
                self.bond_ends.push([self.body(b, e.i), self.body(there(e.block), e.j)]);
                self.bond_constants.push(model.bonds[e.number as usize].values);
            }
        }
    }

    fn enter(&mut self, model: &Model, state: &State, work: &Work, spheres: &Spheres) {
        let room = 2 * (self.ends.len() + self.bond_ends.len());
        let mut entered = Entered { all: Vec::with_capacity(room), after: 0 };
        self.enter_across(state, work, spheres, &mut entered);
        entered.after = self.blocks as u32;
        for (what, list) in [(EntryKind::Bond, List::OwnBonds), (EntryKind::Debonded, List::OwnDebonded)] {
            for of in self.from(list, 0)..self.from(list, self.blocks) {
                let [i, j] =
                    if what == EntryKind::Bond { self.bond_ends[of as usize] } else { self.ends_of(of) };
                entered.put(i, what, of, false);
                entered.put(j, what, of, true);
            }
        }
        self.enter_within(work, spheres, &mut entered);
        entered.after = u32::MAX;
        for (group, &first) in self.pairs.groups.iter().enumerate() {
            let sphere = self.pairs.ends[first as usize][0];
            entered.put(spheres.owner(sphere), EntryKind::Walls, group as u32, false);
        }
        self.pairs.groups.push(self.pairs.ends.len() as u32);
        self.enter_patches(model, state, work, &mut entered);
        self.watched.sort_unstable();
        self.watched.dedup();
        self.sort(&entered.all);
    }

    fn enter_across(&mut self, state: &State, work: &Work, spheres: &Spheres, entered: &mut Entered) {
        // As the engine with any clump.
        let across = if spheres.clumps { EntryKind::Members } else { EntryKind::Spheres };
        let here = |b: &usize| !work.members[*b].solid();
        for (b, w) in work.blocks.iter().enumerate().filter(|(b, _)| here(b)) {
            for share in &w.shares.list {
                let from = share.block as usize;
                entered.after = share.block;
                let (forces, record) = (&work.cross[from], share.record());
                let (what, of) = if record >= forces.images_at {
                    let of = (record - forces.images_at) / forces.width;
                    (EntryKind::Images, self.from(List::Images, from) + of as u32)
                } else if record >= forces.kinds_at {
                    debug_assert!(share.first());
                    (
                        EntryKind::Handed,
                        self.hand_over(Source::Pair { from, record }, [b as u32, share.place]),
                    )
                } else {
                    (across, self.from(List::Cross, from) + (record / forces.width) as u32)
                };
                entered.put(self.body(b, share.place), what, of, !share.first());
            }
            entered.after = self.blocks as u32;
            for share in work.bonds.shares(b) {
                let from = share.block as usize;
                let count = state.bonds.cross[from].count;
                let (what, of) = match share.slot.checked_sub(count) {
                    Some(slot) => (EntryKind::Debonded, self.from(List::CrossDebonded, from) + slot),
                    None => (EntryKind::Bond, self.from(List::CrossBonds, from) + share.slot),
                };
                entered.put(self.body(b, share.place), what, of, !share.first);
            }
        }
    }

    fn enter_within(&self, work: &Work, spheres: &Spheres, entered: &mut Entered) {
        let within = [
            (List::Own, EntryKind::Spheres, EntryKind::Members),
            (List::Planes, EntryKind::Plane, EntryKind::MemberPlane),
        ];
        for (list, single, member) in within {
            for (b, members) in work.members.iter().enumerate() {
                let what = if members.rigid { member } else { single };
                let body = |end: u32| if members.rigid { spheres.owner(end) } else { end };
                for of in self.from(list, b)..self.from(list, b + 1) {
                    let [i, j] = self.ends_of(of);
                    entered.put(body(i), what, of, false);
                    if list == List::Own {
                        entered.put(body(j), what, of, true);
                    }
                }
            }
        }
    }

    fn enter_patches(&mut self, model: &Model, state: &State, work: &Work, entered: &mut Entered) {
        type Of = (fn(&BlockLists) -> &[PatchPair], fn(usize, u32) -> Source);
        let on_walls: Of = (|l| &l.walls.pairs, |block, place| Source::Walls { block, place });
        let on_surface: Of = (|l| &l.surface.pairs, |block, place| Source::Surface { block, place });
        for (pairs, source) in cpu_part::walls(model).then_some(on_walls).into_iter().chain([on_surface]) {
            for (b, (lists, members)) in state.lists.iter().zip(&work.members).enumerate() {
                for pairs in pairs(lists).chunk_by(|p, q| members.body(p.i) == members.body(q.i)) {
                    let place = members.body(pairs[0].i);
                    let of = self.hand_over(source(b, place), [b as u32, place]);
                    entered.put(self.body(b, place), EntryKind::Handed, of, false);
                }
            }
        }
    }

    /// Adds a source for a body (block, index) and returns its index.
    fn hand_over(&mut self, source: Source, [block, place]: [u32; 2]) -> u32 {
        self.handed.push(source);
        self.watched.push([block, place, self.body(block as usize, place)]);
        self.handed.len() as u32 - 1
    }

    fn there(&self, entry: u32) -> u32 {
        let (of, what, second) = parts_of(entry);
        let side = usize::from(!second);
        if what == EntryKind::Walls as u32 || what == EntryKind::Handed as u32 {
            0
        } else if what == EntryKind::Bond as u32 {
            self.bond_ends[of][side]
        } else {
            self.ends_of(of as u32)[side]
        }
    }

    fn sort(&mut self, all: &[[u32; 3]]) {
        let bodies = self.from(List::Bodies, self.blocks) as usize;
        self.start = vec![0; bodies + 1];
        all.iter().for_each(|[body, ..]| self.start[*body as usize + 1] += 1);
        (0..bodies).for_each(|k| self.start[k + 1] += self.start[k]);
        let mut next = self.start.clone();
        self.entries = vec![[0; 2]; all.len()];
        self.after = vec![0; all.len()];
        for [body, entry, after] in all {
            let to = &mut next[*body as usize];
            self.entries[*to as usize] = [*entry, self.there(*entry)];
            self.after[*to as usize] = *after;
            *to += 1;
        }
    }
}
