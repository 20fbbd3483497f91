//! Frusta for piles and cones.

use super::part::GroupsPart;
use crate::scene::grains::Frustum;
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use std::f64::consts::{PI, TAU};
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyInput, Vec3};

const SIDES: usize = 24;
/// Default rounding radius over smaller body radius.
const ROUNDING: f64 = 0.1;

pub(super) fn frustum(
    frustum: &Table<Frustum>,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), SceneError> {
    let [from, to] = [("from", &frustum.from), ("to", &frustum.to)].map(|(key, place)| {
        place.iter().try_for_each(|x| frustum.check(key, *x, |_| true, "a length").map(drop))?;
        Ok(Vec3::from(vector(place)))
    });
    let (from, to) = (from?, to?);
    let length = (to - from).norm();
    frustum.check("to", length, |l| l > 0.0, "another point than `from`")?;
    for r in &frustum.radii {
        frustum.check("radii", *r, |r| r > 0.0, "above 0")?;
    }
    let sides =
        frustum.check("sides", frustum.sides, |n| (6.0..=32.0).contains(&n), "6 to 32")?.unwrap_or(SIDES);
    let radii = frustum.radii.map(|r| r.si);
    let radius = frustum.check("radius", frustum.radius, |r| r > 0.0, "above 0")?;
    let radius = radius.map_or(ROUNDING * radii[0].min(radii[1]), |r| r.si);
    let core = ends(length, radii, radius, sides).ok_or_else(|| {
        let expected =
            "a radius that leaves a core: below half the length, and below the apothems of the ends";
        frustum.error("radius", radius.to_string(), expected)
    })?;
    let corners = corners([from, to], core, sides);
    let (shape, position, orientation) = Dilated::new(&corners, radius)
        .map_err(|e| frustum.here(e.to_string(), "a frustum that is a dilated polyhedron"))?;
    let shape = part.add_shape(Shape::Polyhedron(Box::new(shape)));
    part.bodies.push(BodyInput { shape, scale: 1.0, position, orientation, ..model.clone() });
    Ok(())
}

/// Axial position and corner radius of core ends [m]. `radii` are means of inscribed and circumscribed
/// radius at the ends.
fn ends(length: f64, radii: [f64; 2], radius: f64, sides: usize) -> Option<[(f64, f64); 2]> {
    let cosine = libm::cos(PI / sides as f64);
    // Inscribed radius for a mean radius of 1.
    let share = 2.0 / (1.0 + 1.0 / cosine);
    let slope = share * (radii[1] - radii[0]) / length;
    let end = |z: f64| {
        let inscribed = share * radii[0] + slope * z - radius * (1.0 + slope * slope).sqrt();
        (z, inscribed / cosine)
    };
    let ends = [end(radius), end(length - radius)];
    (2.0 * radius < length && ends.iter().all(|(_, r)| *r > 0.0)).then_some(ends)
}

fn corners([from, to]: [Vec3; 2], ends: [(f64, f64); 2], sides: usize) -> Vec<Vec3> {
    let axis = (to - from).normalize();
    // First corner towards x, or y for a body along x.
    let aim = if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let x = (aim - axis * axis.dot(&aim)).normalize();
    let y = axis.cross(&x);
    let corner = |(z, r): (f64, f64), k: usize| {
        let angle = TAU * k as f64 / sides as f64;
        from + axis * z + (x * libm::cos(angle) + y * libm::sin(angle)) * r
    };
    ends.iter().flat_map(|end| (0..sides).map(|k| corner(*end, k))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outer_faces_match_prescribed_frustum() {
        for (radii, sides) in [([2.0, 2.0], 24), ([3.0, 1.0], 6), ([1.0, 2.5], 32)] {
            let (from, to, radius) = (Vec3::new(1.0, 2.0, -4.0), Vec3::new(1.0, 2.0, 2.0), 0.1);
            let corners = corners([from, to], ends(6.0, radii, radius, sides).unwrap(), sides);
            let (shape, centre, turn) = Dilated::new(&corners, radius).unwrap();
            assert_eq!(shape.core.faces.len(), sides + 2);
            for face in &shape.core.faces {
                let normal = turn * face.normal;
                let offset = face.offset + radius + normal.dot(&centre);
                if normal.z.abs() > 0.99 {
                    let end = if normal.z > 0.0 { to } else { from };
                    assert!((offset - normal.dot(&end)).abs() < 1e-9, "{normal:?} {offset}");
                    continue;
                }
                let flat = libm::hypot(normal.x, normal.y);
                for (end, r) in [from, to].iter().zip(radii) {
                    // Intersection of the face with the end plane.
                    let inscribed = (offset - normal.dot(end)) / flat;
                    let mean = 0.5 * inscribed * (1.0 + 1.0 / libm::cos(PI / sides as f64));
                    assert!((mean - r).abs() < 1e-9, "{sides} sides: {mean}");
                }
            }
        }
    }

    #[test]
    fn a_radius_must_leave_a_core() {
        assert!(ends(1.0, [1.0, 1.0], 0.5, 24).is_none());
        assert!(ends(3.0, [1.0, 0.1], 0.15, 24).is_none());
        assert!(ends(3.0, [1.0, 0.1], 0.05, 24).is_some());
    }
}
