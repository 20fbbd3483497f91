//! Neighbour search on the device (`text/search.c`).
//!
//! The neighbour list depends only on positions, so any search gives the engine's bits. The CPU lists
//! contacts other than sphere–sphere and sphere–plane.

use super::arrays::{DeviceHistory, Lists};
use super::back_end::Device;
use super::bodies::{Motion, put_places};
use super::layout::{Count, LISTS, List, Number, STRETCH, Slot};
use super::machine::Machine;
use super::sizes::largest;
use super::walls::overflowed;
use crate::base::Vec3;
use crate::engine::broad_phase::Listed;
use crate::engine::model::Model;
use crate::engine::neighbour_list;
use crate::engine::state::State;
use crate::law::History;
use crate::spatial::surface::Surface;

impl<M: Machine> Device<M> {
    /// Rebuilds the neighbour list; returns true if the CPU must make the next step.
    pub(super) fn list<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
    ) -> Result<bool, String> {
        if !self.features.rest() {
            neighbour_list::adapt(model, state);
            self.search(model, state)?;
            self.work.searched.searches += 1;
            neighbour_list::finish_rebuild(state, &mut self.work);
            return Ok(false);
        }
        if self.ahead {
            self.fetch_rest(model, state)?;
        }
        neighbour_list::update(model, state, &mut self.work, surface, Listed::Rest);
        if self.features.walls > 0 && state.lists.iter().any(overflowed) {
            // The engine records their energy; the state still has the previous sphere contacts.
            self.bring_back(model, state, Listed::Rest)?;
            (self.ahead, self.found, state.stale) = (false, true, true);
            return Ok(true);
        }
        self.hold(model, state)?;
        self.search(model, state)?;
        Ok(false)
    }

    /// Downloads positions, and history for CPU lists.
    fn fetch_rest(&mut self, model: &Model, state: &mut State) -> Result<(), String> {
        let n = state.blocks.iter().map(|b| b.bodies.len()).sum();
        let Motion { mut x, mut orientation, .. } = Motion::zeros(n, self.features.clumps);
        self.get(Slot::OldX, 0, x.as_flattened_mut())?;
        self.get(Slot::OldOrientation, 0, orientation.as_flattened_mut())?;
        put_places(&x, &orientation, state, &mut self.work);
        let from = self.among_spheres;
        let mut memory = DeviceHistory::zeros(model, self.contacts - from, self.pairs, 0);
        self.get(Slot::OldMemory, 4 * from, memory.spring.as_flattened_mut())?;
        if self.features.roll {
            self.get(Slot::OldTurn, 4 * from, memory.turn.as_flattened_mut())?;
        }
        self.get_kept(&mut memory)?;
        memory.put_rest(state, 0);
        Ok(())
    }

    fn hold(&mut self, model: &Model, state: &State) -> Result<(), String> {
        let searches = self.work.searched.searches;
        if !self.features.bonds || self.held_since == Some(searches) {
            return Ok(());
        }
        let bodies = state.blocks.iter().flat_map(|b| &b.bodies);
        let mut place = vec![0; model.body_count()];
        bodies.enumerate().for_each(|(k, &body)| place[body as usize] = k as u32);
        let pairs = self.work.held.pairs().map(|pair| pair.map(|body| place[body as usize]));
        let mut pairs: Vec<[u32; 2]> = pairs.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        pairs.sort_unstable();
        let start = |k: u32| pairs.partition_point(|[a, _]| *a < k) as u32;
        let start: Vec<u32> = (0..=state.present_count() as u32).map(start).collect();
        let with: Vec<u32> = pairs.iter().map(|[_, b]| *b).collect();
        self.put_counts(Slot::HeldStart, &start)?;
        self.put_counts(Slot::HeldWith, &with)?;
        self.held_since = Some(searches);
        Ok(())
    }

    fn search(&mut self, model: &Model, state: &State) -> Result<(), String> {
        // History is copied from the previous lists.
        for (new, old) in [(Slot::Ends, Slot::OldEnds), (Slot::Offsets, Slot::OldOffsets)] {
            self.call.buffers.swap(new as usize, old as usize);
        }
        let (spheres, bodies, blocks) = (self.spheres.count, state.present_count(), state.blocks.len());
        self.fill_cells(model, state, spheres)?;
        self.reserve_counts(Slot::Offsets, 4 * spheres + 1)?;
        self.call_kernel("count_partners", spheres + 1)?;
        self.running_total(Slot::Offsets, 4 * spheres + 1)?;
        self.reserve_counts(Slot::Totals, 3)?;
        self.call_kernel("totals", 1)?;
        let mut totals = [0; 3];
        let buffer = self.buffer(Slot::Totals);
        self.machine.get_counts(buffer, &mut totals)?;
        let [of_spheres, contacts, partners] = totals.map(|n| n as usize);
        let rest = self.features.rest().then(|| Lists::of(model, state, &self.work, &self.spheres, contacts));
        let (listed, entered) = rest.as_ref().map_or((0, 0), |l| (l.ends.len(), l.entries.len()));
        self.reserve_counts(Slot::Ends, 2 * (contacts + listed))?;
        self.reserve_counts(Slot::Rows, partners)?;
        self.reserve_counts(Slot::Entries, 2 * (partners + (contacts - of_spheres) + entered))?;
        self.call.count(Count::FirstPlane, of_spheres);
        match &rest {
            Some(lists) => self.put_lists(lists)?,
            None => self.note_none(contacts),
        }
        self.remember(self.contacts)?;
        self.call_kernel("list_partners", spheres)?;
        self.call_kernel("enter_partners", bodies + 1)?;
        self.call_kernel("ranges", blocks + 1)?;
        for (old, new) in [(Slot::OldMemory, Slot::NewMemory), (Slot::OldTurn, Slot::NewTurn)] {
            self.call.buffers.swap(old as usize, new as usize);
        }
        self.remember(self.contacts)?;
        self.reserve(Slot::Spent, 2 * self.contacts)?;
        self.reserve(Slot::Walls, 8 * (contacts - of_spheres))?;
        if let Some(lists) = rest {
            self.put_memory(model, state, contacts)?;
            self.assign_cpu_forces(lists)?;
        }
        (self.found, self.ahead) = (true, true);
        Ok(())
    }

    fn note_none(&mut self, contacts: usize) {
        for none in [Count::FirstDebonded, Count::FirstPatch, Count::FirstImage] {
            self.call.count(none, contacts);
        }
        (self.contacts, self.among_spheres) = (contacts, contacts);
    }

    fn put_lists(&mut self, lists: &Lists) -> Result<(), String> {
        self.note_rest(lists);
        let ends = self.buffer(Slot::Ends);
        self.machine.fill_counts(ends, 2 * self.among_spheres, lists.ends.as_flattened())?;
        let counts: [(Slot, &[u32]); 6] = [
            (Slot::Ranges, lists.ranges.as_flattened()),
            (Slot::RestStart, &lists.start),
            (Slot::Rest, lists.entries.as_flattened()),
            (Slot::RestFrom, &lists.after),
            (Slot::PatchPairs, lists.pairs.ends.as_flattened()),
            (Slot::Groups, &lists.pairs.groups),
        ];
        for (slot, list) in counts {
            self.put_counts(slot, list)?;
        }
        self.put(Slot::Reference, &lists.reference)?;
        self.put(Slot::Ways, lists.ways.as_flattened())?;
        self.reserve(Slot::Couples, 4 * lists.ways.len())
    }

    fn put_memory(&mut self, model: &Model, state: &State, from: usize) -> Result<(), String> {
        let memory = DeviceHistory::of_rest(model, state);
        let of_springs = self.buffer(Slot::OldMemory);
        self.machine.fill(of_springs, 4 * from, memory.spring.as_flattened())?;
        if self.features.roll {
            let of_turns = self.buffer(Slot::OldTurn);
            self.machine.fill(of_turns, 4 * from, memory.turn.as_flattened())?;
        }
        self.put(Slot::OldSpare, &memory.kept.spare)?;
        self.put(Slot::OldTouch, memory.kept.touch.as_flattened().as_flattened())?;
        self.room_for_pairs(self.pairs)
    }

    fn remember(&mut self, contacts: usize) -> Result<(), String> {
        self.reserve(Slot::NewMemory, 4 * contacts)?;
        self.reserve(Slot::NewTurn, if self.features.roll { 4 * contacts } else { 0 })
    }

    fn fill_cells(&mut self, model: &Model, state: &State, spheres: usize) -> Result<(), String> {
        let (near, most) = (state.near, model.radii.1);
        let grid = |k: usize| [1.0 / (2.0 * largest(most, k) + near), largest(most, k)];
        let grids: Vec<[f64; 2]> = (0..self.features.classes).map(grid).collect();
        self.put(Slot::Grids, grids.as_flattened())?;
        let four = |v: &Vec3, last: f64| [v.x, v.y, v.z, last];
        let planes = model.planes.iter().zip(&state.planes);
        let planes = planes.map(|(plane, now)| {
            let open = f64::from(now.open);
            [four(&plane.point, open), four(&now.offset, 0.0), four(&plane.normal, 0.0)]
        });
        let planes: Vec<_> = planes.collect();
        self.put(Slot::PlanesSearched, planes.as_flattened().as_flattened())?;
        let buckets = (2 * spheres).next_power_of_two().max(2 * STRETCH);
        self.call.number(Number::Reach, near);
        self.call.count(Count::Spheres, spheres);
        self.call.count(Count::Planes, planes.len());
        self.call.count(Count::Buckets, buckets);
        self.reserve_counts(Slot::Cells, buckets + 1)?;
        for slot in [Slot::Bucket, Slot::Place, Slot::Items] {
            self.reserve_counts(slot, spheres)?;
        }
        self.call_kernel("clear_cells", buckets + 1)?;
        self.call_kernel("count_cells", spheres)?;
        self.running_total(Slot::Cells, buckets + 1)?;
        self.call_kernel("fill_cells", spheres)
    }

    /// Exclusive prefix sums, in place.
    fn running_total(&mut self, slot: Slot, count: usize) -> Result<(), String> {
        let (mut lengths, mut from) = (vec![count], vec![0, 0]);
        while let Some(&last) = lengths.last().filter(|n| **n > STRETCH) {
            lengths.push(last.div_ceil(STRETCH));
            from.push(from[from.len() - 1] + last.div_ceil(STRETCH));
        }
        self.reserve_counts(Slot::Sums, from[from.len() - 1])?;
        let buffers = [self.buffer(slot), self.buffer(Slot::Sums)];
        let last = lengths.len() - 1;
        let up = (0..last).map(|k| ("sum_up", k));
        for (kernel, k) in up.chain((0..=last).rev().map(|k| ("sum_down", k))) {
            self.call.buffers[Slot::Summed as usize] = buffers[k.min(1)];
            self.call.count(Count::SumFrom, from[k]);
            self.call.count(Count::SumLength, lengths[k]);
            self.call.count(Count::SumTo, from[k + 1]);
            self.call_kernel(kernel, lengths[k].div_ceil(STRETCH))?;
        }
        Ok(())
    }

    fn call_kernel(&mut self, kernel: &'static str, threads: usize) -> Result<(), String> {
        self.machine.launch(kernel, threads, &self.call)
    }

    fn reserve_counts(&mut self, slot: Slot, counts: usize) -> Result<(), String> {
        self.machine.reserve_counts(self.call.buffers[slot as usize], counts)
    }

    pub(super) fn name_contacts(&mut self, state: &mut State) -> Result<(), String> {
        let mut ranges = vec![[0; LISTS]; state.blocks.len() + 1];
        let mut ends = vec![[0; 2]; self.among_spheres];
        let (of_ranges, of_ends) = (self.buffer(Slot::Ranges), self.buffer(Slot::Ends));
        self.machine.get_counts(of_ranges, ranges.as_flattened_mut())?;
        self.machine.get_counts(of_ends, ends.as_flattened_mut())?;
        let bases = &self.spheres.base;
        for (b, (cross, lists)) in state.cross.iter_mut().zip(&mut state.lists).enumerate() {
            let of = |list: List| {
                let at = |b: usize| ranges[b][list as usize] as usize;
                ends[at(b)..at(b + 1)].iter().copied()
            };
            let first = if self.work.members[b].rigid { bases[b] } else { ranges[b][List::Bodies as usize] };
            cross.spheres.clear();
            for [i, j] in of(List::Cross) {
                let to = bases.partition_point(|base| *base <= j) - 1;
                cross.spheres.push([i - bases[b], to as u32, j - bases[to]], &History::NONE);
            }
            lists.pairs.clear();
            of(List::Own).for_each(|[i, j]| lists.pairs.push([i - first, j - first], &History::NONE));
            lists.planes.clear();
            of(List::Planes).for_each(|[i, plane]| lists.planes.push([i - first, plane], &History::NONE));
        }
        Ok(())
    }
}
