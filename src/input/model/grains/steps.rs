//! DEM time stepping: keys of `[time]` resolved.
//!
//! Theory manual: equation (3.10) of `docs/theory/motion.md`.

use super::laws;
use super::materials::MaterialsPart;
use crate::scene::{Scene, SceneError, Table, TimeControl};
use trackbed_dem::{ModelInput, SearchSkin, TimeStep};

/// DEM time stepping.
#[derive(Clone, Copy, Debug)]
pub struct StepPlan {
    /// Fixed, or fraction of the critical time step.
    pub step: TimeStep,
    /// Approach speed for stiffening contacts [m/s].
    pub impact_speed: Option<f64>,
    /// Neighbour list skin.
    pub skin: SearchSkin,
    /// Mass scaling factor of the main stage.
    pub mass_factor: f64,
}

/// Scales masses up and gravity down: same weights and contacts, more inertia.
pub(super) fn add_inertia(input: &mut ModelInput, factor: f64) {
    if factor == 1.0 {
        return;
    }
    input.gravity /= factor;
    input.materials.iter_mut().for_each(|m| m.density *= factor);
    input.bodies.iter_mut().for_each(|b| b.mass = b.mass.map(|mass| mass * factor));
    for body in input.walls.iter_mut().filter_map(|w| w.body.as_mut()) {
        body.mass *= factor;
        body.inertia = body.inertia.map(|inertia| inertia.map(|i| i * factor));
    }
}

pub(super) fn search_skin(time: &Table<TimeControl>) -> Result<SearchSkin, SceneError> {
    let good = |s| (0.01..=2.0).contains(&s);
    let share = time.check("search_skin", time.search_skin, good, "0.01 to 2")?;
    Ok(share.map_or_else(SearchSkin::default, SearchSkin::Share))
}

/// Rejected if motion itself is the result.
pub(super) fn mass_factor(scene: &Table<Scene>) -> Result<f64, SceneError> {
    let time = scene.below("time", &scene.time);
    let good = |f| (1.0..=1e4).contains(&f);
    let Some(factor) = time.check("mass_factor", time.mass_factor, good, "1 to 10000")? else {
        return Ok(1.0);
    };
    let rail = scene.track.as_ref().and_then(|t| t.rail.as_ref());
    let dynamic = [
        (scene.water.is_some(), "[water]"),
        (scene.wind.is_some(), "[wind]"),
        (scene.runout.is_some(), "[runout]"),
        (scene.grains.iter().any(|g| g.inlet.is_some()), "an inlet"),
        (!scene.outlet.is_empty(), "[[outlet]]"),
        (rail.is_some_and(|r| r.mass.is_some()), "a rail with mass"),
        (scene.walls.iter().any(|w| w.scarring.is_some()), "`scarring`"),
        (scene.walls.iter().filter_map(|w| w.body.as_ref()).any(|b| b.mount.is_some()), "a `mount`"),
    ];
    match dynamic.into_iter().find(|(there, _)| *there) {
        Some((_, other)) => {
            let remedy = "Mass scaling is valid for quasi-static loading only";
            Err(time.conflict("mass_factor", other).remedy(remedy))
        }
        None => Ok(factor),
    }
}

/// Rejected without a stiffening contact.
pub(super) fn impact_speed(
    scene: &Table<Scene>,
    materials: &MaterialsPart,
) -> Result<Option<f64>, SceneError> {
    let time = scene.below("time", &scene.time);
    let speed = time.check("impact_speed", time.impact_speed, |v| v >= 0.0, "0 or more")?;
    let idle = speed.is_some() && !laws::stiffens(&materials.all, &materials.pairs);
    time.reject_without([("impact_speed", idle)], "a material with `young`")?;
    Ok(speed.map(|v| v.si))
}

pub(super) fn time_step(time: &Table<TimeControl>) -> Result<TimeStep, SceneError> {
    match (time.grain_step, time.grain_step_fraction) {
        (Some(_), Some(_)) => Err(time.conflict("grain_step_fraction", "`grain_step`")),
        (Some(step), None) if step.si <= 0.0 => {
            Err(time.error("grain_step", step.si.to_string(), "a time above 0"))
        }
        (Some(step), None) if time.accept_step_above_limit => Ok(TimeStep::FixedAboveLimit(step.si)),
        (Some(step), None) => Ok(TimeStep::Fixed(step.si)),
        (None, fraction) => {
            if time.accept_step_above_limit {
                return Err(time.no_effect("accept_step_above_limit", "`grain_step`"));
            }
            let share = fraction.unwrap_or(TimeStep::SHARE);
            let good = |f| (1e-6..=1.0).contains(&f);
            time.check("grain_step_fraction", share, good, "0.000001 to 1")?;
            Ok(TimeStep::Measured { share, longest: f64::INFINITY, collisions: true })
        }
    }
}
