//! Stages of a run in order (`STAGES`).

mod bedding;
mod cadence;
mod carried;
mod compaction;
mod coupling_remarks;
mod equilibrium;
mod finished_bed;
mod growth;
mod layers;
mod main_loop;
mod pressing;
pub mod reduction;
mod reworked;
mod set_down;
mod settling;
mod solid_loop;
pub mod solid_remarks;
mod stage;
mod statics;
mod strength_reduction;
mod time_loop;
mod tines;

pub use carried::Carried;
pub use compaction::{COMPACTED, longest};
pub use stage::{GrainTime, RUN, RunState, SETTLING, Stage, reached};

use trackbed_input::model::Job;
use trackbed_input::model::grains::{self, GrainsPart, Preview};
use trackbed_input::scene::{Document, SceneError};

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

/// Builds the grain models before the first step.
///
/// # Errors
/// Main-loop input errors, or too many steps.
pub fn preview(document: &Document, job: &Job, grains: &GrainsPart) -> Result<Preview, SceneError> {
    let preview = grains::preview(document, grains, job.ground().as_ref())?;
    for stage in of(job) {
        let (key, time) = match stage.grain_time(job) {
            None => continue,
            Some(GrainTime::Exactly(time)) => ("time.end", time),
            Some(GrainTime::AtMost(time)) if stage.name() == Some(SETTLING) => ("deposition.max_time", time),
            Some(GrainTime::AtMost(time)) => ("compaction", time),
        };
        grains::check_steps(document, key, time, preview.whole.dt())?;
    }
    Ok(preview)
}

/// Returns the stages of a scene, in order.
pub fn of(job: &Job) -> impl DoubleEndedIterator<Item = &'static dyn Stage> {
    STAGES.into_iter().filter(|stage| stage.applies(job))
}
