//! Dilated bodies as shapes.

use super::edge_contact::{Segment, Target};
use super::part::{Bounds, Part, View};
use super::{Core, Dilated};
use crate::base::Vec3;
use crate::shape::body_shape::{BodyShape, Outline, positive};
use crate::shape::cuboid;

impl BodyShape for Dilated {
    fn fault(&self) -> Option<String> {
        (!positive(self.radius) || !positive(self.volume))
            .then(|| "radius and volume of a dilated polyhedron or disk must be positive".to_string())
    }

    fn volume(&self) -> f64 {
        self.volume
    }

    fn gyration2(&self) -> Vec3 {
        Vec3::from(self.inertia) / self.volume
    }

    fn bounding_radius(&self) -> f64 {
        self.bounding_radius()
    }

    /// Sphere of equal volume.
    fn reference_radius(&self) -> f64 {
        libm::cbrt(0.75 * self.volume / std::f64::consts::PI)
    }

    fn levers2(&self) -> [f64; 3] {
        cuboid::levers2(&self.half_extents())
    }

    fn sieve_size(&self) -> Option<f64> {
        Some(self.sieve_size())
    }

    fn longest_edge(&self) -> f64 {
        self.core.longest_edge()
    }

    fn chord(&self, scale: f64, origin: &Vec3, along: &Vec3) -> Option<(f64, f64)> {
        let [low, high] = chord(&self.core, self.radius, &(origin / scale), along)?;
        Some((low * scale, high * scale))
    }

    fn outline(&self) -> Option<Outline> {
        Some(self.outline())
    }

    fn solid_name(&self) -> Option<&'static str> {
        Some(if self.core.rim.is_some() { "disks" } else { "polyhedra" })
    }
}

/// Intersection of a line with a dilated core.
fn chord(core: &Core, radius: f64, origin: &Vec3, along: &Vec3) -> Option<[f64; 2]> {
    let reach = origin.norm() + core.reach + radius;
    // The body is convex: one interval.
    let mut inner = if core.rim.is_some() { [0.0; 2] } else { [-reach, reach] };
    for face in &core.faces {
        let (at, slope) = (face.normal.dot(origin) - face.offset, face.normal.dot(along));
        if slope > 0.0 {
            inner[1] = inner[1].min(-at / slope);
        } else if slope < 0.0 {
            inner[0] = inner[0].max(-at / slope);
        } else if at > 0.0 {
            inner[1] = f64::NEG_INFINITY;
        }
    }
    let mut all = if inner[0] < inner[1] { inner } else { [f64::INFINITY, f64::NEG_INFINITY] };
    let [from, to] = [-reach, reach].map(|s| origin + along * s);
    let view = View::everywhere(*along, radius);
    let around = Bounds::near([&from, &to], &view);
    let segment = Segment { from, direction: *along, range: [0.0, 2.0 * reach], around };
    Part::none(core, view).all().stretches(&segment, radius, |[low, high], _| {
        all = [all[0].min(low - reach), all[1].max(high - reach)];
    });
    (all[0] < all[1]).then_some(all)
}
