//! Contact detection without a step.

use super::bonds;
use super::model::Model;
use super::state::{BlockLists, State};
use super::step::step;
use super::work::Work;
use crate::base::error::StepError;
use crate::spatial::surface::Surface;

/// Finds the contacts of an initial state. Motion and balance terms are unchanged.
///
/// # Errors
/// As [`step`].
pub fn find_contacts<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) -> Result<(), StepError> {
    let mut probe = state.clone();
    step(model, &mut probe, work, surface, &[])?;
    keep(model, state, work, probe);
    Ok(())
}

/// As [`find_contacts`], also with overlaps and speeds above the limits of a step, to report them.
///
/// # Errors
/// As [`step`], without overlaps and speeds.
pub fn find_deep_contacts<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) -> Result<(), StepError> {
    let mut probe = state.clone();
    match step(model, &mut probe, work, surface, &[]) {
        Err(StepError::Overlap { .. } | StepError::Speed { .. }) => {}
        other => other?,
    }
    keep(model, state, work, probe);
    Ok(())
}

fn keep(model: &Model, state: &mut State, work: &mut Work, probe: State) {
    for (lists, seen) in state.lists.iter_mut().zip(probe.lists) {
        *lists = BlockLists { bonds: std::mem::take(&mut lists.bonds), ..seen };
    }
    state.cross = probe.cross;
    state.sheet = probe.sheet;
    for (wall, seen) in state.walls.iter_mut().zip(probe.walls) {
        (wall.force, wall.moment) = (seen.force, seen.moment);
        (wall.feet, wall.meets) = (seen.feet, seen.meets);
    }
    (state.near, state.max_travel, state.wall_travel) = (probe.near, probe.max_travel, probe.wall_travel);
    (state.steps_since_search, state.stale) = (probe.steps_since_search, probe.stale);
    // The probe may have broken bonds and moved clump spheres; its forces stay.
    for (members, block) in work.members.iter_mut().zip(&state.blocks) {
        members.arrange(&model.bodies, &model.shapes, block);
    }
    bonds::arrange(model, state, work);
}
