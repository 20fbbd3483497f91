//! The stages of a run, in order: `run` carries them out, `check` and `explain` report them, all from the one list
//! [`STAGES`].

mod compaction;
mod coupling_remarks;
mod equilibrium;
mod finished_bed;
mod growth;
mod layers;
mod main_loop;
mod set_down;
mod settling;
mod solid_loop;
pub mod solid_remarks;
mod stage;
mod statics;
mod strength_reduction;
mod time_loop;

pub use stage::{GrainTime, RUN, RunState, Stage};

use crate::model::Job;

/// All stages, in order.
static STAGES: [&dyn Stage; 9] = [
    &growth::Growth,
    &settling::Settling,
    &compaction::Compaction,
    &finished_bed::FinishedBed,
    &set_down::SetDown,
    &equilibrium::Equilibrium,
    &statics::Statics,
    &strength_reduction::StrengthReduction,
    &main_loop::MainLoop,
];

/// The stages of a scene, in order.
pub fn of(job: &Job) -> impl DoubleEndedIterator<Item = &'static dyn Stage> {
    STAGES.into_iter().filter(|stage| stage.applies(job))
}
