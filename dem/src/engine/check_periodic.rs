//! Checks of periodic axes.

use super::input::ModelInput;
use super::pieces::components;
use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::bodies::table::{Bodies, Body, BodyKind};
use crate::body_force::BodyForce;
use crate::shape::Shape;
use crate::spatial::patchwork::Patch;

/// Whether bodies that bonds join extend over a whole period.
fn long_piece(input: &ModelInput, bodies: &Bodies) -> bool {
    let of = components(bodies.len(), input.bonds.iter().map(|b| [b.a as u32, b.b as u32]));
    let mut bounds = vec![[Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)]; of.len()];
    for (body, (piece, of)) in input.bodies.iter().zip(of.iter().zip(bodies.iter())) {
        let [low, high] = &mut bounds[*piece as usize];
        let reach = Vec3::repeat(of.radius);
        (*low, *high) = (low.inf(&(body.position - reach)), high.sup(&(body.position + reach)));
    }
    bounds.iter().any(|[low, high]| {
        (0..3).any(|d| input.periodic[d].is_some_and(|[from, to]| high[d] - low[d] > to - from))
    })
}

/// Sentence about a wall that moves along a periodic axis beside spheres or clumps.
fn moving_wall(input: &ModelInput, bodies: &Bodies) -> Option<String> {
    if bodies.iter().all(|b| b.kind == BodyKind::Solid) {
        return None;
    }
    input.all_walls().enumerate().find_map(|(k, wall)| {
        let along = |d: usize| {
            let servo = wall.servo.as_ref().map_or(0.0, |servo| servo.direction[d]);
            wall.motion.velocity[d] != 0.0 || servo != 0.0 || wall.body.is_some()
        };
        let d = (0..3).find(|&d| input.periodic[d].is_some() && along(d))?;
        let axis = ["x", "y", "z"][d];
        Some(format!(
            "wall {k} moves along {axis}, which is periodic; with spheres or clumps walls stay where they are along periodic axes"
        ))
    })
}

/// Half the length of a body along an axis [m]: of boxes that keep their direction their own, else the radius.
fn reach(input: &ModelInput, k: usize, body: &Body, axis: usize) -> f64 {
    let shape = &input.shapes[body.shape];
    // Rotation about the axis itself keeps it for a box along the axes.
    let kept = (0..3).filter(|d| *d != axis).all(|d| body.fixed >> (3 + d) & 1 == 1);
    let turned = input.bodies[k].orientation.to_rotation_matrix();
    let straight = turned.matrix()[(axis, axis)].abs() > 1.0 - 1e-12;
    if matches!(shape, Shape::Box { .. }) && kept && straight && input.bodies[k].spin.norm() == 0.0 {
        return shape.bounding_half(body.scale)[axis];
    }
    body.radius
}

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
    let dilated = bodies.iter().any(|b| b.kind == BodyKind::Solid && input.shapes[b.shape].dilated());
    if dilated && input.surface_material.is_some() {
        return error("polyhedra or disks on an external surface cannot be combined with them".into());
    }
    if !input.bonds.is_empty() && long_piece(input, bodies) {
        return error("a piece longer than a period, joined by bonds".into());
    }
    if let Some(problem) = moving_wall(input, bodies) {
        return error(problem);
    }
    let largest = bodies.iter().map(|b| b.radius).fold(0.0, f64::max);
    for (d, (axis, side)) in ["x", "y", "z"].iter().zip(&input.periodic).enumerate() {
        let Some([low, high]) = *side else { continue };
        let reach = bodies.iter().enumerate().map(|(k, b)| reach(input, k, &b, d)).fold(0.0, f64::max);
        // The second nearest image of a partner is out of reach.
        let least = 2.0 * (2.0 * reach + skin);
        let length = high - low;
        if !(low.is_finite() && high.is_finite() && length > 0.0) {
            return error(format!(
                "{axis} runs from {low} to {high}; both must be finite, the second the larger"
            ));
        }
        if length < least * (1.0 - 1e-9) {
            return error(format!(
                "{axis} is {length} m long; at least {least:.3e} m (two diameters of the largest body and twice the search skin) are needed"
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
    waves_and_planes(input)
}

/// Waves that do not fit the box, planes across periodic axes.
fn waves_and_planes(input: &ModelInput) -> Result<(), ModelError> {
    let error = |problem: String| Err(ModelError::Periodic { problem });
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
