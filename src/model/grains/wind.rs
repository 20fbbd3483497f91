//! `[wind]` resolved.

use super::check::check;
use crate::scene::units::vector;
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::{BodyForce, Vec3, Wind};

/// The body forces of the run proper.
pub(super) fn build(document: &Document, scene: &Scene) -> Result<Vec<BodyForce>, SceneError> {
    let Some(wind) = &scene.wind else { return Ok(Vec::new()) };
    let velocity = Vec3::from(vector(&wind.velocity));
    check(document, "wind.velocity", Some(velocity.norm()), |v| v <= 1000.0, "at most 1000 m/s")?;
    let density = wind.density.si;
    check(document, "wind.density", Some(density), |d| d > 0.0 && d <= 2e4, "above 0, at most 20000")?;
    check(document, "wind.drag", Some(wind.drag), |c| c > 0.0 && c <= 100.0, "above 0, at most 100")?;
    Ok(vec![BodyForce::Wind(Wind { velocity, density, drag: wind.drag })])
}
