//! Steps of the grains in time: keys of `[time]` resolved.

use super::check::check;
use super::laws;
use super::materials::MaterialsPart;
use crate::scene::{Document, Scene, SceneError, TimeControl};
use trackbed_dem::TimeStep;

/// How the step of the grains is found.
#[derive(Clone, Copy, Debug)]
pub struct StepPlan {
    /// The step, or its share of what the contacts of each moment allow.
    pub step: TimeStep,
    /// Approach speed that contacts whose stiffness grows are to be stable at [m/s].
    pub impact_speed: Option<f64>,
}

/// Refuses an impact speed that no contact asks for.
pub(super) fn impact_speed(
    document: &Document,
    scene: &Scene,
    materials: &MaterialsPart,
) -> Result<Option<f64>, SceneError> {
    let impact_speed = scene.time.impact_speed.map(|v| v.si);
    check(document, "time.impact_speed", impact_speed, |v| v >= 0.0, "0 or more")?;
    if impact_speed.is_some() && !laws::stiffens(&materials.all, &materials.pairs) {
        let expected = "no such key without a material with `young`";
        return Err(document.error("time.impact_speed", "a value", expected));
    }
    Ok(impact_speed)
}

/// The step, or how it is found.
pub(super) fn time_step(document: &Document, time: &TimeControl) -> Result<TimeStep, SceneError> {
    match (time.grain_step, time.grain_step_fraction) {
        (Some(_), Some(f)) => {
            Err(document.error("time.grain_step_fraction", f.to_string(), "no such key beside `grain_step`"))
        }
        (Some(step), None) if step.si <= 0.0 => {
            Err(document.error("time.grain_step", step.si.to_string(), "a time above 0"))
        }
        (Some(step), None) if time.accept_step_above_limit => Ok(TimeStep::FixedAboveLimit(step.si)),
        (Some(step), None) => Ok(TimeStep::Fixed(step.si)),
        (None, fraction) => {
            if time.accept_step_above_limit {
                let key = "time.accept_step_above_limit";
                return Err(document.error(key, "true", "a `grain_step` that it accepts"));
            }
            let share = fraction.unwrap_or(TimeStep::SHARE);
            check(
                document,
                "time.grain_step_fraction",
                Some(share),
                |f| (1e-6..=1.0).contains(&f),
                "0.000001 to 1",
            )?;
            Ok(TimeStep::Measured { share, longest: f64::INFINITY, collisions: true })
        }
    }
}
