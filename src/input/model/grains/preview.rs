//! Grain models before the first step, to report errors before deposition.

use super::bonds::{check_gaps, check_joinable, check_joined};
use super::growth::check_growth;
use super::overlap::{check_overlaps, first_input};
use super::part::GrainsPart;
use super::plates::check_plates;
use super::refused::refused;
use crate::scene::{Document, SceneError};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::{Model, ModelInput, State};

/// A day at ten million steps per second.
const MOST_STEPS: f64 = 1e12;

/// Initial grain models.
pub struct Preview {
    /// Without sleepers.
    pub alone: Model,
    /// With rigid sleepers at height 0, irrelevant to the step limit.
    pub whole: Model,
}

/// Builds and checks the models.
///
/// # Errors
/// Input errors.
pub fn preview(
    document: &Document,
    grains: &GrainsPart,
    ground: Option<&SolidSurface>,
) -> Result<Preview, SceneError> {
    check_gaps(document, &grains.bonds, &grains.groups.bodies, &grains.groups.shapes)?;
    // First without sleepers, as in a run.
    let input = grains.input(grains.groups.bodies.clone());
    if grains.is_packed() {
        check_joinable(document, &grains.bonds, &input)?;
    } else {
        check_joined(document, &grains.bonds, &input.bonds)?;
    }
    let alone = Model::new(input).map_err(|e| refused(document, &e))?;
    let first = first_input(grains);
    let first = (first.walls.len() < alone.wall_count()).then(|| Model::new(first)).transpose();
    let first = first.map_err(|e| refused(document, &e))?;
    let first = first.as_ref().unwrap_or(&alone);
    check_overlaps(document, grains, (first, State::new(first)), ground, 0)?;
    check_growth(document, grains)?;
    check_plates(document, grains)?;
    let whole = Model::new(with_sleepers(grains)).map_err(|e| refused(document, &e))?;
    let dt = whole.dt();
    grains.track.check_pads(document, dt)?;
    grains.track.check_ram(document, dt)?;
    Ok(Preview { alone, whole })
}

/// Returns the initial grains with rigid sleepers at height 0.
pub fn with_sleepers(grains: &GrainsPart) -> ModelInput {
    let plan = grains.track.rigid_sleeper();
    let sleepers = plan
        .into_iter()
        .flat_map(|plan| plan.row.centres.iter().map(|&centre| grains.sleeper_body(plan, centre, 0.0)));
    grains.input(grains.groups.bodies.iter().cloned().chain(sleepers).collect())
}

/// Rejects times of too many steps `dt` [s].
///
/// # Errors
/// Input errors.
pub fn check_steps(document: &Document, key: &str, time: f64, dt: f64) -> Result<(), SceneError> {
    if time / dt <= MOST_STEPS {
        return Ok(());
    }
    let found = format!("{time} s in steps of {dt:.1e} s");
    Err(document.error(key, found, format!("at most {MOST_STEPS:.0e} steps")))
}
