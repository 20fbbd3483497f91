//! What periodic axes cannot be combined with.

use super::input::ModelInput;
use crate::base::error::ModelError;
use crate::bodies::table::Bodies;
use crate::shape::Shape;

/// Refuses what cannot be combined with periodic axes, and boxes so short that a body may meet itself or another twice.
pub(crate) fn check(input: &ModelInput, bodies: &Bodies, skin: f64) -> Result<(), ModelError> {
    let error = |problem: String| Err(ModelError::Periodic { problem });
    if input.periodic.iter().all(Option::is_none) {
        return Ok(());
    }
    for (what, there) in [
        ("triangle surfaces", !input.triangles.is_empty()),
        ("walls other than planes", !input.walls.is_empty()),
        ("an external surface", input.surface_material.is_some()),
        ("bonds", !input.bonds.is_empty()),
    ] {
        if there {
            return error(format!("{what} cannot be combined with them"));
        }
    }
    if let Some(k) = input
        .bodies
        .iter()
        .position(|b| matches!(input.shapes[b.shape], Shape::Box { .. } | Shape::Polyhedron(_)))
    {
        return error(format!(
            "body {k} is a box or a polyhedron; only spheres and clumps can cross a border"
        ));
    }
    let largest = bodies.iter().map(|b| b.radius).fold(0.0, f64::max);
    let least = 3.0 * (2.0 * largest + skin);
    for (axis, side) in ["x", "y", "z"].iter().zip(&input.periodic) {
        let Some([low, high]) = *side else { continue };
        let length = high - low;
        if !(low.is_finite() && high.is_finite() && length > 0.0) {
            return error(format!(
                "{axis} runs from {low} to {high}; both must be finite, the second the larger"
            ));
        }
        if length < least * (1.0 - 1e-9) {
            return error(format!(
                "{axis} is {length} m long; at least {least:.3e} m (three diameters of the largest body and three times the \
                 search skin) are needed"
            ));
        }
    }
    for (k, plane) in input.planes.iter().enumerate() {
        let n = plane.normal.normalize();
        if let Some(d) = (0..3).find(|&d| input.periodic[d].is_some() && n[d].abs() > 1e-12) {
            return error(format!(
                "the normal of plane {k} has a part along {}, which is periodic",
                ["x", "y", "z"][d]
            ));
        }
    }
    Ok(())
}
