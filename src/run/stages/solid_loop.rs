//! Time loop of a dynamic or quasi-static solid.

use super::stage::RunState;
use super::{statics, time_loop};
use crate::checkpoint::Loaded;
use crate::context::Run;
use crate::summary::{NewtonRecord, ReactionRecord, Summary};
use crate::system::{SolidKind, SolidSystem, System};
use crate::validity::{load_near_mode, quasi_static_strain, small_strain};
use trackbed_input::model::solid::{Analysis, SolidPart};
use trackbed_io::failure::Failure;

/// Runs a solid-only model.
///
/// # Errors
/// Numerical failures, interrupts, I/O errors.
pub fn solid_alone(run: &Run<'_>, solid: &SolidPart, state: &mut RunState<'_>) -> Result<(), Failure> {
    let (mut resumed, summary) = (state.loaded.take(), &mut state.summary);
    let interrupt = run.checkpoints.interrupt();
    // Other analyses have separate stages.
    let Some(kind) = SolidKind::of(solid) else { return Ok(()) };
    let step = run.job.solid_step.expect("a solid with steps in time has their length");
    let mut system = match &mut resumed {
        Some(loaded) => SolidSystem::resume(solid, kind, step, interrupt, loaded)?,
        None => SolidSystem::new(solid, kind, step, interrupt)?,
    };
    let outcome = march(run, solid, &mut system, resumed, summary);
    summary.solid.newton = system.statistics().map(|s| NewtonRecord::of(&s));
    outcome
}

fn march(
    run: &Run<'_>,
    solid: &SolidPart,
    system: &mut SolidSystem<'_>,
    resumed: Option<Loaded>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    summary.model.solid_step = run.job.solid_step;
    run.prepare()?;
    let outcome = time_loop::advance(run, system, None, resumed, None, summary);
    // The last converged state.
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
    summary.validity.extend(load_near_mode(run.job));
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
