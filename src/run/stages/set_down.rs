//! Placement of sleepers on the bed.

use super::stage::{RunState, Stage};
use crate::bed;
use crate::context::Run;
use trackbed_dem as dem;
use trackbed_input::model::Job;
use trackbed_input::model::grains::refused;
use trackbed_io::failure::Failure;

/// Places unseated sleepers on the highest grain; meshed sleepers only get base heights.
pub struct SetDown;

impl Stage for SetDown {
    fn name(&self) -> Option<&'static str> {
        Some("sleeper set down")
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.as_ref().is_some_and(|g| g.track.sleeper.is_some())
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some(grains) = &mut state.grains else { return Ok(()) };
        let Some(plan) = &grains.part.track.sleeper else { return Ok(()) };
        if !grains.bed.sleepers.is_empty() {
            grains.bases = grains.bed.sleepers.iter().map(|s| s.position.z - plan.row.half[2]).collect();
            grains.bodies.extend(grains.bed.sleepers.iter().cloned());
            return Ok(());
        }
        let input = grains.part.input(grains.bodies.clone());
        let model = dem::Model::new(input).map_err(|e| refused(run.document, &e))?;
        let resting = grains.start(&model)?;
        let base = |&centre: &[f64; 2]| {
            bed::top_below(&model, &resting, centre, &plan.row.half, grains.ground.as_ref())
        };
        grains.bases = plan.row.centres.iter().map(base).collect();
        if !plan.row.meshed {
            for (&centre, base) in plan.row.centres.iter().zip(&grains.bases) {
                grains.bodies.push(grains.part.sleeper_body(plan, centre, base + plan.row.half[2]));
            }
        }
        Ok(())
    }
}
