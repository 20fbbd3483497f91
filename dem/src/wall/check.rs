//! Validation of walls.

use super::input::{RigidBody, WallInput};
use crate::base::Vec3;
use crate::base::error::ModelError;

fn finite(v: &Vec3) -> bool {
    v.iter().all(|x| x.is_finite())
}

pub(crate) fn walls(input: &[WallInput], materials: usize) -> Result<(), ModelError> {
    for (index, wall) in input.iter().enumerate() {
        in_range("wall", index, "material", wall.material, materials)?;
        let problem = wall.shape.fault().or_else(|| motion(wall)).or_else(|| scarring(wall));
        if let Some(problem) = problem {
            return Err(ModelError::Wall { wall: format!("wall {index}"), problem });
        }
    }
    Ok(())
}

fn motion(wall: &WallInput) -> Option<&'static str> {
    let m = &wall.motion;
    if !(finite(&m.velocity) && finite(&m.angular_velocity) && m.centre.is_none_or(|c| finite(&c))) {
        return Some("its motion must be finite");
    }
    if let Some(o) = &m.oscillation
        && !(finite(&o.amplitude) && o.frequency >= 0.0 && o.frequency.is_finite() && o.phase.is_finite())
    {
        return Some("its oscillation must be finite, with a frequency of zero or more");
    }
    if let Some((_, normal)) = wall.shape.plane()
        && m.angular_velocity.cross(normal).norm() > 1e-12 * m.angular_velocity.norm() * normal.norm()
    {
        return Some(
            "an infinite plane can rotate about its normal only: use triangles for a floor that tilts",
        );
    }
    let moves = m.velocity != Vec3::zeros() || m.angular_velocity != Vec3::zeros() || m.oscillation.is_some();
    if let Some(s) = &wall.servo {
        if !(finite(&s.direction) && s.direction.norm() > 0.0) {
            return Some("the direction of its servo must have a length above zero");
        }
        if !(s.max_speed > 0.0 && s.max_speed.is_finite() && s.gain > 0.0 && s.gain <= 1.0) {
            return Some("its servo needs a speed above zero and a gain above 0, at most 1");
        }
        if s.force.is_empty()
            || !s.force.iter().flatten().all(|x| x.is_finite())
            || !s.force.is_sorted_by(|a, b| a[0] < b[0])
        {
            return Some("the force of its servo needs finite points with ascending times");
        }
        if moves || wall.body.is_some() {
            return Some("a servo-controlled wall has no other motion");
        }
    }
    if let Some(b) = &wall.body {
        if moves {
            return Some("a rigid body has no prescribed motion");
        }
        let good = b.mass > 0.0
            && b.mass.is_finite()
            && finite(&b.velocity)
            && finite(&b.spin)
            && b.centre.is_none_or(|c| finite(&c))
            && b.inertia.is_none_or(|i| i.iter().all(|x| x.is_finite()));
        if !good {
            return Some("its mass must be positive, and its centre, inertia and velocities finite");
        }
        if b.rounding.is_some_and(|r| !(r > 0.0 && r.is_finite())) {
            return Some("the rounding of its corners must be positive, and finite");
        }
        return mount(b).or_else(|| water(b));
    }
    None
}

fn scarring(wall: &WallInput) -> Option<&'static str> {
    let scarring = wall.scarring.as_ref()?;
    if wall.shape.triangulated().is_none() || wall.moves() {
        return Some("a wall with scarring must be of triangles and fixed");
    }
    scarring.fault()
}

fn water(body: &RigidBody) -> Option<&'static str> {
    let good = |x: f64| x >= 0.0 && x.is_finite();
    if let Some(w) = &body.water {
        let vectors = [w.drag, w.drag_moment, w.added_mass, w.added_inertia, w.damping_ratio];
        if !(vectors.iter().flatten().all(|x| good(*x)) && good(w.skin_drag)) {
            return Some("the coefficients of its water must be zero or positive, and finite");
        }
    }
    let drive = body.propulsion.as_ref()?;
    if body.water.is_none() {
        return Some("a body needs water for its propulsion");
    }
    let table = |t: &[[f64; 2]]| {
        !t.is_empty() && t.iter().flatten().all(|x| x.is_finite()) && t.is_sorted_by(|a, b| a[0] < b[0])
    };
    let unit = |v: &Vec3| finite(v) && (v.norm() - 1.0).abs() < 1e-9;
    if !(finite(&drive.point) && unit(&drive.direction) && table(&drive.thrust) && good(drive.diameter)) {
        return Some("its propulsion needs a finite point, a unit direction and ascending times");
    }
    let rudder = drive.rudder.as_ref()?;
    let positive = [rudder.area, rudder.aspect_ratio].iter().all(|x| *x > 0.0 && x.is_finite());
    let good = positive && finite(&rudder.point) && table(&rudder.angle);
    if !good || libm::hypot(drive.direction.x, drive.direction.y) < 1e-6 {
        return Some("its rudder needs a positive area, ascending times, and a thrust that is not vertical");
    }
    None
}

fn mount(body: &RigidBody) -> Option<&'static str> {
    let mount = body.mount.as_ref()?;
    let values = || mount.stiffness.iter().zip(&mount.damping).flat_map(|(k, c)| [*k, *c]);
    if !values().all(|x| x >= 0.0 && x.is_finite()) {
        return Some("stiffness and damping of its mount must be zero or positive, and finite");
    }
    let idle = (0..3).any(|d| body.fixed[d] && (mount.stiffness[d] != 0.0 || mount.damping[d] != 0.0));
    idle.then_some("its mount acts along a fixed direction")
}

/// Rejects an index out of range.
pub(crate) fn in_range(
    owner: &'static str,
    index: usize,
    kind: &'static str,
    found: usize,
    count: usize,
) -> Result<(), ModelError> {
    if found < count { Ok(()) } else { Err(ModelError::Index { owner, index, kind, found, count }) }
}
