//! The models of the grains as far as they are known before anything has moved: what is wrong with a scene shows here, and not
//! after its bed has settled.

use super::bonds::{check_gaps, check_joinable, check_joined};
use super::overlap::check_overlaps;
use super::part::GrainsPart;
use super::refused::refused;
use crate::scene::{Document, SceneError};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::{Model, ModelInput};

/// Most steps of the grains in a stage: at ten million steps a second, more than any run takes, it lasts a day.
const MOST_STEPS: f64 = 1e12;

/// The grains at the start.
pub struct Preview {
    /// Without sleepers.
    pub alone: Model,
    /// With rigid sleepers at the height 0: their place does not matter to the limit of the step.
    pub whole: Model,
}

/// Makes the models, and checks what depends on their step and on all bodies together, and on the solid's surface `ground`.
///
/// # Errors
/// Bad input.
pub fn preview(
    document: &Document,
    grains: &GrainsPart,
    ground: Option<&SolidSurface>,
) -> Result<Preview, SceneError> {
    check_gaps(document, &grains.bonds, &grains.groups.bodies, &grains.groups.shapes)?;
    // First without the sleeper, as a run does to find its place.
    let input = grains.input(grains.groups.bodies.clone());
    if grains.is_packed() {
        check_joinable(document, &grains.bonds, &input)?;
    } else {
        check_joined(document, &grains.bonds, &input.bonds)?;
    }
    let alone = Model::new(input).map_err(|e| refused(document, &e))?;
    check_overlaps(document, grains, &alone, ground)?;
    let whole = Model::new(with_sleepers(grains)).map_err(|e| refused(document, &e))?;
    let dt = whole.dt();
    grains.track.check_pads(document, dt)?;
    grains.track.check_ram(document, dt)?;
    Ok(Preview { alone, whole })
}

/// The grains at the start with rigid sleepers at the height 0.
pub fn with_sleepers(grains: &GrainsPart) -> ModelInput {
    let plan = grains.track.rigid_sleeper();
    let sleepers = plan
        .into_iter()
        .flat_map(|plan| plan.row.centres.iter().map(|&centre| grains.sleeper_body(plan, centre, 0.0)));
    grains.input(grains.groups.bodies.iter().cloned().chain(sleepers).collect())
}

/// Refuses a time that takes more steps of `dt` [s] than anyone can wait for.
///
/// # Errors
/// Bad input.
pub fn check_steps(document: &Document, key: &str, time: f64, dt: f64) -> Result<(), SceneError> {
    if time / dt <= MOST_STEPS {
        return Ok(());
    }
    let found = format!("{time} s in steps of {dt:.1e} s");
    Err(document.error(key, found, format!("at most {MOST_STEPS:.0e} steps")))
}
