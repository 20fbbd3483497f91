//! Growth of groups by radius expansion.

use super::stage::{Packed, RunState, Settled, Stage};
use crate::context::Run;
use crate::packing::{GrownOverlap, GrowthRecord};
use crate::summary::StageRecord;
use trackbed_dem::insert::radius_expansion::{GrowError, grow};
use trackbed_input::model::Job;
use trackbed_input::model::grains::{GrainsPart, deepest_overlap, refused};
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;

/// Growth stage.
pub struct Growth;

impl Stage for Growth {
    fn name(&self) -> Option<&'static str> {
        Some("growth")
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.as_ref().is_some_and(|g| !g.groups.growths.is_empty())
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some(grains) = state.grains.as_mut().filter(|g| g.done < Packed::Grown) else { return Ok(()) };
        grow_groups(run, &mut grains.part, &mut grains.bed)?;
        if grains.part.packing.deposition.is_none() {
            grains.bed.bodies.clone_from(&grains.part.groups.bodies);
        }
        Ok(())
    }
}

fn grow_groups(run: &Run<'_>, grains: &mut GrainsPart, bed: &mut Settled) -> Result<(), Failure> {
    for plan in grains.groups.growths.clone() {
        let progress = Progress::start("growing", 1.0, run.verbosity);
        let bodies = &grains.groups.bodies[plan.bodies.clone()];
        let material = grains.material(&bodies[0]);
        let grown = grow(&plan.container, &grains.groups.shapes, bodies, material, &plan.how);
        let grown = grown.map_err(|e| match e {
            GrowError::Model(e) => Failure::from(refused(run.document, &e)),
            other => Failure::Numerical(format!("group {}: {other}", plan.group)),
        })?;
        let text = format!("{} grains of {}: porosity {:.4}", bodies.len(), plan.group, grown.porosity);
        let seconds = progress.finish(&text);
        bed.stages.push(StageRecord {
            name: format!("growing {}", plan.group),
            seconds,
            grain_steps: grown.steps,
            solid_steps: 0,
            windows: 0,
        });
        bed.growth.push(GrowthRecord {
            group: plan.group,
            porosity: grown.porosity,
            largest_overlap: grown.overlap,
            unbalanced_ratio: grown.unbalanced,
        });
        grains.groups.bodies.splice(plan.bodies, grown.bodies);
    }
    bed.grown = deepest_overlap(grains).map(|(deepest, between, springs)| GrownOverlap {
        between,
        share: deepest.share,
        springs,
    });
    Ok(())
}
