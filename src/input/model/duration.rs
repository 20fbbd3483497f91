//! Run duration, and the time step of a solid without grains.

use super::grains::GrainsPart;
use crate::scene::{Scene, SceneError, Table};
use trackbed_track::CyclicLoad;

/// Such a run would take years.
const MOST: u64 = 1_000_000_000_000;
pub(super) const TIME_INTEGRATION: &str = "[solid.dynamics] or [solid.quasi_static]";

/// Counted time step [s]: of a solid-only model, else the DEM time step.
///
/// # Errors
/// The DEM time step is not constant.
pub fn counted_step(scene: &Table<Scene>, needed_by: &str) -> Result<f64, SceneError> {
    let time = scene.below("time", &scene.time);
    let (key, step) = match scene.grains.is_empty() {
        true => ("solid_step", time.solid_step),
        false => ("grain_step", time.grain_step),
    };
    match step {
        Some(step) if step.si > 0.0 => Ok(step.si),
        Some(step) => Err(time.error(key, step.si.to_string(), "a time above 0")),
        None => Err(time.missing(key, format!("a step that stays the same, since {needed_by} counts steps"))),
    }
}

fn after(scene: &Table<Scene>, steps: u64) -> Result<f64, SceneError> {
    let step = counted_step(scene, "time.steps")?;
    if !(1..=MOST).contains(&steps) {
        let found = steps.to_string();
        return Err(scene.below("time", &scene.time).error("steps", found, format!("1 to {MOST}")));
    }
    // Rounding must not add a step.
    Ok(steps as f64 * step * (1.0 - 1e-13))
}

/// Duration of the main stage [s]; 0 for a static solid.
///
/// # Errors
/// No time, two times, or too short for the load cycles.
pub fn end_time(scene: &Table<Scene>, grains: Option<&GrainsPart>) -> Result<f64, SceneError> {
    let counted = grains.and_then(|g| g.track.load.as_ref()).map(CyclicLoad::end);
    // After the cycles, or alone.
    let push = grains.and_then(|g| g.track.after.push).map(|p| p.duration());
    let counted = match (counted, push) {
        (Some(cycles), Some(push)) => Some(cycles + push),
        (counted, push) => counted.or(push),
    };
    let steps = |s: &crate::scene::solid::Solid| s.dynamics.is_some() || s.quasi_static.is_some();
    let dynamic = grains.is_some() || scene.solid.as_ref().is_some_and(steps);
    let time = scene.below("time", &scene.time);
    let given = match (time.steps, time.end) {
        (Some(_), Some(_)) => return Err(time.conflict("steps", "`end`")),
        (Some(steps), None) => Some(after(scene, steps)?),
        (None, end) => end.map(|end| end.si),
    };
    let key = if time.steps.is_some() { "steps" } else { "end" };
    match (given, counted, dynamic) {
        (Some(end), _, _) if end <= 0.0 => Err(time.error(key, end.to_string(), "a time above 0")),
        (Some(end), Some(counted), _) if end < counted => Err(time.error(
            key,
            format!("{end} s"),
            format!(
                "at least {counted} s, when the {} ends",
                if push.is_some() { "push" } else { "last load cycle" }
            ),
        )),
        (Some(_), None, false) => Err(time.no_effect(key, TIME_INTEGRATION)),
        (Some(end), _, true) => Ok(end),
        (None, Some(counted), _) => Ok(counted),
        (None, None, true) => Err(time.missing("end", "the time to simulate")),
        (_, _, false) => Ok(0.0),
    }
}

/// At 1000 steps per second, twelve days.
const MOST_STEPS: f64 = 1e9;

/// Time step of a solid-only dynamic model [s].
///
/// # Errors
/// Missing, or without effect.
pub fn solid_step(scene: &Table<Scene>, end: f64) -> Result<Option<f64>, SceneError> {
    let alone_and_dynamic = scene.grains.is_empty() && end > 0.0;
    let time = scene.below("time", &scene.time);
    match (time.solid_step, alone_and_dynamic) {
        (Some(step), true) if step.si > 0.0 && step.si <= end && end / step.si <= MOST_STEPS => {
            Ok(Some(step.si))
        }
        (Some(step), true) if step.si > 0.0 && step.si <= end => {
            let found = format!("{end} s in steps of {:.1e} s", step.si);
            Err(time.error("solid_step", found, format!("at most {MOST_STEPS:.0e} steps")))
        }
        (Some(step), true) => {
            Err(time.error("solid_step", format!("{} s", step.si), format!("above 0, at most {end} s")))
        }
        (Some(_), false) if !scene.grains.is_empty() => {
            let remedy = "The FEM time step is `coupling.substeps` DEM time steps";
            Err(time.conflict("solid_step", "[[grains]]").remedy(remedy))
        }
        (Some(_), false) => Err(time.no_effect("solid_step", TIME_INTEGRATION)),
        (None, true) => Err(time.missing("solid_step", "the FEM time step")),
        (None, false) => Ok(None),
    }
}
