//! CPU part of a step on a device: uploads contact forces, downloads the motion of the bodies involved.

use super::bodies::quaternion;
use super::layout::{Count, Slot};
use super::machine::{Call, Machine};
use crate::contact::patch_forces::PatchForce;
use crate::engine::cpu_part::{self, SavedHistory};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::lanes::vec4::Vec4;
use crate::spatial::surface::Surface;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Body pair: index of its first record in the slots of block `from`.
    Pair { from: usize, record: usize },
    /// Wall contacts of a body.
    Walls { block: usize, place: u32 },
    /// Its contacts with the external surface.
    Surface { block: usize, place: u32 },
}

#[derive(Default)]
pub(super) struct CpuForces {
    sources: Vec<Source>,
    /// Bodies whose motion the CPU needs: block, index, global index.
    watched: Vec<[u32; 3]>,
    start: Vec<u32>,
    /// Force and torque, alternating.
    forces: Vec<[f64; 4]>,
    picked: Vec<[f64; 4]>,
    /// Contact history before the step, if the step may be repeated.
    kept: Option<SavedHistory>,
}

#[derive(Default)]
struct BodyOrder {
    block: u32,
    next: usize,
}

impl BodyOrder {
    /// Appends the forces of a body (block, index); bodies must come in order.
    fn add(&mut self, all: &[PatchForce], [block, place]: [u32; 2], to: &mut Vec<[f64; 4]>) {
        if block != self.block {
            *self = BodyOrder { block, next: 0 };
        }
        let own = all[self.next..].iter().take_while(|f| f.body == place);
        for force in own {
            let (f, t) = (force.force(), force.torque());
            to.extend([[f.x, f.y, f.z, 0.0], [t.x, t.y, t.z, 0.0]]);
            self.next += 1;
        }
    }
}

impl CpuForces {
    fn collect(&mut self, work: &Work) {
        let CpuForces { sources, start, forces, .. } = self;
        start.clear();
        forces.clear();
        let (mut on_walls, mut on_surface) = (BodyOrder::default(), BodyOrder::default());
        for source in &*sources {
            start.push(forces.len() as u32 / 2);
            match *source {
                Source::Pair { from, record } => {
                    forces.extend(work.cross[from].slots[record..][..2].iter().map(|r| r.0));
                }
                Source::Walls { block, place } => {
                    on_walls.add(&work.blocks[block].patches.aside.forces, [block as u32, place], forces);
                }
                Source::Surface { block, place } => {
                    on_surface.add(work.blocks[block].patches.forces(), [block as u32, place], forces);
                }
            }
        }
        start.push(forces.len() as u32 / 2);
    }
}

impl CpuForces {
    /// Empty. `again`: whether steps may have to be repeated on the CPU.
    pub fn new(again: bool) -> CpuForces {
        CpuForces { kept: again.then(SavedHistory::default), ..CpuForces::default() }
    }

    pub fn take_over<M: Machine>(
        &mut self,
        (machine, call): (&mut M, &mut Call),
        width: usize,
        sources: Vec<Source>,
        watched: Vec<[u32; 3]>,
    ) -> Result<(), String> {
        let numbers: Vec<u32> = watched.iter().map(|[.., number]| *number).collect();
        machine.put_counts(call.buffer(Slot::Watched), &numbers)?;
        call.count(Count::Watched, numbers.len());
        machine.reserve(call.buffer(Slot::Picked), 4 * width * numbers.len())?;
        (self.sources, self.watched) = (sources, watched);
        self.picked.resize(width * numbers.len(), [0.0; 4]);
        Ok(())
    }

    pub fn hand_over<M: Machine, S: Surface>(
        &mut self,
        (machine, call): (&mut M, &Call),
        model: &Model,
        (state, work): (&mut State, &mut Work),
        surface: &S,
    ) -> Result<(), String> {
        if let Some(kept) = &mut self.kept {
            kept.keep(state);
        }
        cpu_part::forces(model, state, work, surface);
        self.collect(work);
        machine.put_counts(call.buffer(Slot::HandedStart), &self.start)?;
        machine.put(call.buffer(Slot::Handed), self.forces.as_flattened())
    }

    /// Restores the contact history of before this step; returns whether it was saved.
    pub fn restore(&self, state: &mut State) -> bool {
        self.kept.iter().for_each(|kept| kept.restore(state));
        self.kept.is_some()
    }

    pub fn pick<M: Machine>(
        &mut self,
        (machine, call): (&mut M, &Call),
        (state, work): (&mut State, &mut Work),
    ) -> Result<(), String> {
        let CpuForces { watched, picked, .. } = self;
        if watched.is_empty() {
            return Ok(());
        }
        machine.launch("pick", watched.len(), call)?;
        machine.get(call.buffer(Slot::Picked), 0, picked.as_flattened_mut())?;
        let width = picked.len() / watched.len();
        for ([block, place, _], row) in watched.iter().zip(picked.chunks_exact(width)) {
            let (block, k) = (*block as usize, *place as usize);
            let (members, block) = (&mut work.members[block], &mut state.blocks[block]);
            block.centre[k] = Vec4(row[0]);
            block.velocity[k] = Vec4(row[1]);
            block.spin[k] = Vec4(row[2]);
            if members.rigid {
                block.rotation[k].orientation = quaternion(&row[3]);
                members.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
            }
        }
        Ok(())
    }
}
