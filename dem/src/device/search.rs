//! The search for neighbours on the device: its kernels in turn (`text/search.c`), and what of it the processor gets.
//!
//! The near list is a function of where bodies are: all pairs within a reach, by the order of their spheres, with the memory of those that
//! were listed before. So it has the engine's bits however it is found; here straight from cells, without candidates.

use super::back_end::Device;
use super::layout::{Count, LISTS, List, Number, STRETCH, Slot};
use super::machine::Machine;
use super::sizes::largest;
use crate::base::Vec3;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::law::History;

impl<M: Machine> Device<M> {
    /// Makes the near list anew where the bodies are.
    pub(super) fn search(&mut self, model: &Model, state: &State) -> Result<(), String> {
        // What was found before is where memory comes from.
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
        self.reserve_counts(Slot::Ends, 2 * contacts)?;
        self.reserve_counts(Slot::Rows, partners)?;
        self.reserve_counts(Slot::Entries, 2 * (partners + (contacts - of_spheres)))?;
        self.remember(contacts)?;
        self.call_kernel("list_partners", spheres)?;
        self.call_kernel("enter_partners", bodies + 1)?;
        self.call_kernel("ranges", blocks + 1)?;
        for (old, new) in [(Slot::OldMemory, Slot::NewMemory), (Slot::OldTurn, Slot::NewTurn)] {
            self.call.buffers.swap(old as usize, new as usize);
        }
        self.remember(contacts)?;
        self.reserve(Slot::Spent, 2 * contacts)?;
        self.reserve(Slot::Walls, 8 * (contacts - of_spheres))?;
        self.call.count(Count::FirstPlane, of_spheres);
        for none in [Count::FirstDebonded, Count::FirstPatch, Count::FirstImage] {
            self.call.count(none, contacts);
        }
        (self.contacts, self.found, self.ahead) = (contacts, true, true);
        Ok(())
    }

    /// Room for what contacts remember after the next step.
    fn remember(&mut self, contacts: usize) -> Result<(), String> {
        self.reserve(Slot::NewMemory, 4 * contacts)?;
        self.reserve(Slot::NewTurn, if self.features.roll { 4 * contacts } else { 0 })
    }

    /// Puts the spheres into buckets.
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

    /// Has each number of a list become the sum of all before it.
    fn running_total(&mut self, slot: Slot, count: usize) -> Result<(), String> {
        // The list, sums of its stretches, sums of stretches of these; all but the list in one buffer.
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

    /// Puts the lists that the device has found into a state, without what their contacts remember.
    pub(super) fn name_contacts(&mut self, state: &mut State) -> Result<(), String> {
        let mut ranges = vec![[0; LISTS]; state.blocks.len() + 1];
        let mut ends = vec![[0; 2]; self.contacts];
        let (of_ranges, of_ends) = (self.buffer(Slot::Ranges), self.buffer(Slot::Ends));
        self.machine.get_counts(of_ranges, ranges.as_flattened_mut())?;
        self.machine.get_counts(of_ends, ends.as_flattened_mut())?;
        let bases = &self.spheres.base;
        for (b, (cross, lists)) in state.cross.iter_mut().zip(&mut state.lists).enumerate() {
            let of = |list: List| {
                let at = |b: usize| ranges[b][list as usize] as usize;
                ends[at(b)..at(b + 1)].iter().copied()
            };
            // Where spheres are bodies, these have their numbers within a block.
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
