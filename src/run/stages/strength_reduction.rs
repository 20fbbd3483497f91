//! Factor of safety by strength reduction.

use super::stage::{RunState, Stage, Steps};
use crate::context::Run;
use crate::summary::{SafetyRecord, StageRecord, Summary, TrialRecord};
use crate::system::SolidView;
use crate::{frames, initial};
use std::time::Instant;
use trackbed_fem::nonlinear::strength_reduction::{self, Trial};
use trackbed_input::model::Job;
use trackbed_input::model::solid::{Analysis, SolidPart, StrengthReductionPlan};
use trackbed_io::columns::safety;
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;
use trackbed_io::write::csv::{Field, write_table};

const TRIALS: [Field<Trial>; 5] = [
    (safety::FACTOR, |t| t.factor),
    (safety::STANDS, |t| f64::from(u8::from(t.converged))),
    (safety::SHARE_OF_LOAD, |t| t.share),
    (safety::ITERATIONS, |t| t.iterations as f64),
    (safety::LARGEST_DISPLACEMENT, |t| t.largest_displacement),
];

/// Factor of safety search.
pub struct StrengthReduction;

fn plan_of(job: &Job) -> Option<(&SolidPart, &StrengthReductionPlan)> {
    let solid = job.solid.as_ref().filter(|_| job.grains.is_none())?;
    match &solid.analysis {
        Analysis::StrengthReduction(plan) => Some((solid, plan)),
        _ => None,
    }
}

impl Stage for StrengthReduction {
    fn name(&self) -> Option<&'static str> {
        Some("strength reduction")
    }

    fn applies(&self, job: &Job) -> bool {
        plan_of(job).is_some()
    }

    fn report(&self, job: &Job, _: Steps<'_>) -> Vec<String> {
        let line = |(_, plan): (&SolidPart, &StrengthReductionPlan)| {
            format!("strength reduction: from factor {}, bracket width {}", plan.start, plan.tolerance)
        };
        plan_of(job).map(line).into_iter().collect()
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some((solid, plan)) = plan_of(run.job) else { return Ok(()) };
        bracket(run, solid, plan, &mut state.summary)
    }
}

/// Writes `safety.csv` and the state at the largest stable factor.
///
/// # Errors
/// No stable, or no unstable factor.
fn bracket(
    stage: &Run<'_>,
    part: &SolidPart,
    plan: &StrengthReductionPlan,
    summary: &mut Summary,
) -> Result<(), Failure> {
    let begun = Instant::now();
    let model = &part.model;
    let weight = model.gravity_load();
    let mut load = weight.clone();
    part.add_loads(0.0, &mut load);
    let (state, _) = initial::state(part, &part.model, &weight)?;
    let progress = Progress::start("strength reduction", 1.0, stage.verbosity);
    let found =
        strength_reduction::factor_of_safety(model, &state, &load, plan).map_err(|e| part.failure(&e))?;
    progress.finish(&format!("factor of safety {:.4} to {:.4}", found.converged, found.failed));

    // Its displacements show the mechanism.
    let (weaker, standing) = strength_reduction::at_factor(model, &state, &load, plan, found.converged)
        .map_err(|e| part.failure(&e))?;
    stage.prepare()?;
    write_table(&stage.dir.join("safety.csv"), &TRIALS, &found.trials)?;
    let view = SolidView { model: &weaker, state: &standing };
    frames::write_state(stage.dir, &stage.job.output, view)?;
    summary.solid.safety = Some(SafetyRecord {
        stable_at: found.converged,
        unstable_at: found.failed,
        trials: found
            .trials
            .iter()
            .map(|t| TrialRecord {
                factor: t.factor,
                stands: t.converged,
                share_of_load: t.share,
                iterations: t.iterations,
                largest_displacement: t.largest_displacement,
            })
            .collect(),
    });
    summary.stages.push(StageRecord {
        name: "strength reduction".into(),
        seconds: begun.elapsed().as_secs_f64(),
        grain_steps: 0,
        solid_steps: found.trials.len() as u64,
        windows: 0,
    });
    Ok(())
}
