//! Finished bed: checkpoint and summary.

use super::stage::{Packed, RunState, SETTLED, Stage, is_packed, planes};
use crate::checkpoint::Moment;
use crate::context::Run;
use crate::packing::{GrownOverlap, StageEnergy};
use trackbed_input::model::Job;
use trackbed_io::failure::Failure;

/// Saves the bed with wall positions.
pub struct FinishedBed;

impl Stage for FinishedBed {
    fn name(&self) -> Option<&'static str> {
        None
    }

    fn applies(&self, job: &Job) -> bool {
        is_packed(job)
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let grains = state.grains.as_mut().expect("a bed of grains");
        if grains.done < Packed::Finished {
            grains.bed.planes = planes(&grains.part);
            let step = grains.bed.stages.iter().map(|s| s.grain_steps).sum();
            let moment = Moment { stage: SETTLED.into(), step, time: grains.bed.time };
            run.checkpoints.save(moment, |body| body.put(&grains.bed))?;
            grains.done = Packed::Finished;
        }
        let (bed, summary) = (&grains.bed, &mut state.summary);
        summary.warnings.extend(bed.warnings.iter().cloned());
        summary.stages.extend(bed.stages.iter().cloned());
        summary.bed.growth.clone_from(&bed.growth);
        summary.bed.compaction.clone_from(&bed.compaction);
        summary.bed.earlier = bed.earlier;
        summary.bed.tamping.clone_from(&bed.tamping);
        summary.bed.beds.clone_from(&bed.beds);
        summary.bed.stage_energy.clone_from(&bed.energy);
        summary.validity.extend(StageEnergy::checks(&bed.energy));
        summary.validity.extend(bed.grown.as_ref().map(GrownOverlap::check));
        grains.bodies.clone_from(&bed.bodies);
        bed.planes.iter().enumerate().for_each(|(k, point)| grains.part.place_plane(k, *point));
        Ok(())
    }
}
