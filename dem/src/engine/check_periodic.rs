//! Checks of periodic axes.

use super::input::ModelInput;
use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::bodies::table::{Bodies, BodyKind};
use crate::body_force::BodyForce;
use crate::spatial::patchwork::Patch;

/// Includes boxes too short for unique periodic images.
pub(crate) fn check(
    input: &ModelInput,
    bodies: &Bodies,
    patches: &[Patch],
    skin: f64,
) -> Result<(), ModelError> {
    let error = |problem: String| Err(ModelError::Periodic { problem });
    if input.periodic.iter().all(Option::is_none) {
        return Ok(());
    }
    let walls = !(input.triangles.is_empty() && input.walls.is_empty());
    let spheres = walls && bodies.iter().any(|b| b.kind != BodyKind::Solid);
    for (what, there) in [
        ("spheres with walls other than planes", spheres),
        ("an external surface", input.surface_material.is_some()),
        ("bonds", !input.bonds.is_empty()),
    ] {
        if there {
            return error(format!("{what} cannot be combined with them"));
        }
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
    let turning: Vec<bool> =
        input.all_walls().map(|w| w.motion.angular_velocity != Vec3::zeros() || w.body.is_some()).collect();
    for patch in patches {
        let (low, high) = patch.form.bounds();
        let extent = Vec3::from(high) - Vec3::from(low);
        let turns = turning.get(patch.wall as usize).is_some_and(|turns| *turns);
        let along = |d: usize| if turns { extent.norm() } else { extent[d] };
        let room = |d: usize| input.periodic[d].map(|[low, high]| (along(d), high - low));
        let short =
            (0..3).filter_map(room).find(|(extent, length)| extent + 2.0 * (largest + skin) > *length);
        if let Some((extent, length)) = short {
            return error(format!(
                "{} is {extent:.3e} m long, too long for a period of {length} m and bodies of {largest:.3e} m: contact with two images of one body; divide it, or remove it",
                patch.partner
            ));
        }
    }
    for wave in input.body_forces.iter().filter_map(BodyForce::wave) {
        for (d, [low, high]) in (0..2).filter_map(|d| Some((d, input.periodic[d]?))) {
            let crests = wave.number * wave.direction[d] * (high - low) / std::f64::consts::TAU;
            if (crests - crests.round()).abs() > 1e-6 {
                return error(format!(
                    "along {} the water has {crests:.6} waves between the borders; a whole number is needed",
                    ["x", "y"][d]
                ));
            }
        }
    }
    for (k, plane) in input.planes.iter().enumerate() {
        let n = plane.normal.normalize();
        if let Some(d) = (0..3).find(|&d| input.periodic[d].is_some() && n[d].abs() > 1e-12) {
            return error(format!(
                "the normal of plane {k} has a component along {}, which is periodic",
                ["x", "y", "z"][d]
            ));
        }
    }
    Ok(())
}
