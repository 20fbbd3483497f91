//! A solid that runs alone through time: dynamic or quasi-static.

use super::stage::RunState;
use super::{statics, time_loop};
use crate::failure::Failure;
use crate::model::solid::{Analysis, SolidPart};
use crate::run::checkpoint::Loaded;
use crate::run::context::Run;
use crate::run::plastic::{PlasticDynamics, QuasiStaticSystem};
use crate::run::summary::{NewtonRecord, ReactionRecord, Summary};
use crate::run::system::{SolidSystem, System};
use crate::run::validity::{quasi_static_strain, small_strain};

/// Runs a solid without grains.
///
/// # Errors
/// A numerical failure, an interrupt, what the disk refuses.
pub fn solid_alone(run: &Run<'_>, solid: &SolidPart, state: &mut RunState<'_>) -> Result<(), Failure> {
    let (mut resumed, summary) = (state.loaded.take(), &mut state.summary);
    let interrupt = run.checkpoints.interrupt();
    match &solid.analysis {
        Analysis::Dynamic(method) if solid.is_linear() => {
            let dt = run.job.solid_step.expect("a dynamic solid has a step");
            let mut system = match &mut resumed {
                Some(loaded) => SolidSystem::resume(solid, *method, dt, loaded)?,
                None => SolidSystem::new(solid, *method, dt).map_err(|e| solid.failure(&e))?,
            };
            march(run, solid, &mut system, resumed, summary)
        }
        Analysis::QuasiStatic(plan) => {
            let step = run.job.solid_step.expect("a quasi-static solid has a step");
            let mut system = match &mut resumed {
                Some(loaded) => QuasiStaticSystem::resume(solid, plan, step, interrupt, loaded)?,
                None => QuasiStaticSystem::new(solid, plan, step, interrupt)?,
            };
            let outcome = march(run, solid, &mut system, resumed, summary);
            summary.solid.newton = Some(NewtonRecord::of(&system.statistics()));
            outcome
        }
        // Stages of their own.
        Analysis::Static | Analysis::StrengthReduction(_) => Ok(()),
        Analysis::Dynamic(method) => {
            let dt = run.job.solid_step.expect("a dynamic solid has a step");
            let mut system = match &mut resumed {
                Some(loaded) => PlasticDynamics::resume(solid, *method, dt, interrupt, loaded)?,
                None => PlasticDynamics::new(solid, *method, dt, interrupt)?,
            };
            let outcome = march(run, solid, &mut system, resumed, summary);
            summary.solid.newton = Some(NewtonRecord::of(&system.statistics()));
            outcome
        }
    }
}

/// Advances a system to the end of the run and writes its last state.
fn march<S: System>(
    run: &Run<'_>,
    solid: &SolidPart,
    system: &mut S,
    resumed: Option<Loaded>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    summary.model.solid_step = run.job.solid_step;
    run.prepare()?;
    let outcome = time_loop::advance(run, system, None, resumed, None, summary);
    // A step without equilibrium leaves the last state that had one.
    match &outcome {
        Ok(()) => {}
        Err(Failure::Numerical(_)) if system.keeps_its_state() => {}
        Err(_) => return outcome,
    }
    let view = system.solid().expect("a system with a solid");
    let check = match solid.analysis {
        Analysis::QuasiStatic(_) if !solid.is_linear() => quasi_static_strain,
        _ => small_strain,
    };
    summary.validity.extend(check(view.model, &view.state.u));
    let reactions = system.reactions().unwrap_or_default();
    summary.solid.reactions = solid
        .named_sums(&reactions)
        .map(|(name, force)| ReactionRecord { name: name.to_string(), force })
        .collect();
    if run.job.output.tables {
        let state = system.solid().expect("a system with a solid").state;
        statics::write_tables(&solid.model, state, &reactions, run.dir)?;
    }
    outcome
}
