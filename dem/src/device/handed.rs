//! The processor's part of a step (`engine/beside.rs`), as the device gets it: forces that it adds up with its own, in their order.
//! What the processor needs to know for that, the motion of the bodies that take part, comes back after each step.

use super::bodies::quaternion;
use super::layout::{Count, Slot};
use super::machine::{Call, Machine};
use crate::contact::patch_forces::PatchForce;
use crate::engine::beside::{self, Kept};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::lanes::record::Record;
use crate::spatial::surface::Surface;

/// Where the forces of an entry come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// The pair whose slot begins with a record of a block: spheres come first in all kinds of pairs that they are in.
    Pair { from: usize, record: usize },
    /// The contacts of a body with walls.
    Walls { block: usize, place: u32 },
    /// The contacts of a body with the external surface.
    Surface { block: usize, place: u32 },
}

/// What is handed over.
#[derive(Default)]
pub(super) struct Handed {
    sources: Vec<Source>,
    /// Block, place and number of the bodies that the processor needs to know.
    watched: Vec<[u32; 3]>,
    start: Vec<u32>,
    /// Force and torque, in turn.
    forces: Vec<[f64; 4]>,
    picked: Vec<[f64; 4]>,
    /// What contacts remembered before the step, where it may be made again.
    kept: Option<Kept>,
}

/// How far the forces of a block have been gone through.
#[derive(Default)]
struct InTurn {
    block: u32,
    next: usize,
}

impl InTurn {
    /// Adds those of a body (block, place) to a list; bodies come in order.
    fn add(&mut self, all: &[PatchForce], [block, place]: [u32; 2], to: &mut Vec<[f64; 4]>) {
        if block != self.block {
            *self = InTurn { block, next: 0 };
        }
        let own = all[self.next..].iter().take_while(|f| f.body == place);
        for force in own {
            let (f, t) = (force.force(), force.torque());
            to.extend([[f.x, f.y, f.z, 0.0], [t.x, t.y, t.z, 0.0]]);
            self.next += 1;
        }
    }
}

impl Handed {
    /// Forces and torques of all entries, one after another.
    fn collect(&mut self, work: &Work) {
        let Handed { sources, start, forces, .. } = self;
        start.clear();
        forces.clear();
        // Contacts with walls lie in the order of the bodies, and so do those with the surface.
        let (mut on_walls, mut on_surface) = (InTurn::default(), InTurn::default());
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

impl Handed {
    /// Nothing yet. `again`: whether there may be steps that a device gives back though nothing is wrong with them.
    pub fn new(again: bool) -> Handed {
        Handed { kept: again.then(Kept::default), ..Handed::default() }
    }

    /// Notes the sources of forces, and whom the processor needs to know.
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

    /// Works the processor's forces out and hands them over.
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
        beside::forces(model, state, work, surface);
        self.collect(work);
        machine.put_counts(call.buffer(Slot::HandedStart), &self.start)?;
        machine.put(call.buffer(Slot::Handed), self.forces.as_flattened())
    }

    /// Has a state's contacts remember what they did before the forces of this step were worked out; whether that was kept.
    pub fn put_back(&self, state: &mut State) -> bool {
        self.kept.iter().for_each(|kept| kept.put_back(state));
        self.kept.is_some()
    }

    /// Brings back where the bodies are that the processor needs to know.
    pub fn pick<M: Machine>(
        &mut self,
        (machine, call): (&mut M, &Call),
        (state, work): (&mut State, &mut Work),
    ) -> Result<(), String> {
        let Handed { watched, picked, .. } = self;
        if watched.is_empty() {
            return Ok(());
        }
        machine.launch("pick", watched.len(), call)?;
        machine.get(call.buffer(Slot::Picked), 0, picked.as_flattened_mut())?;
        let width = picked.len() / watched.len();
        for ([block, place, _], row) in watched.iter().zip(picked.chunks_exact(width)) {
            let (block, k) = (*block as usize, *place as usize);
            let (members, block) = (&mut work.members[block], &mut state.blocks[block]);
            block.centre[k] = Record(row[0]);
            block.velocity[k] = Record(row[1]);
            block.spin[k] = Record(row[2]);
            if members.rigid {
                block.rotation[k].orientation = quaternion(&row[3]);
                members.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
            }
        }
        Ok(())
    }
}
