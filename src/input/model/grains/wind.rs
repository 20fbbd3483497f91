//! `[wind]` resolved.

use crate::scene::units::vector;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::{BodyForce, Vec3, Wind};

pub(super) fn build(scene: &Table<Scene>) -> Result<Option<BodyForce>, SceneError> {
    let Some(wind) = scene.optional("wind", &scene.wind) else { return Ok(None) };
    let velocity = Vec3::from(vector(&wind.velocity));
    wind.check("velocity", velocity.norm(), |v| v <= 1000.0, "at most 1000 m/s")?;
    let density = wind.check("density", wind.density, |d| d > 0.0 && d <= 2e4, "above 0, at most 20000")?.si;
    let drag = wind.check("drag", wind.drag, |c| c > 0.0 && c <= 100.0, "above 0, at most 100")?;
    Ok(Some(BodyForce::Wind(Wind { velocity, density, drag })))
}
