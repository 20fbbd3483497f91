//! Sphere.

use super::body_shape::{BodyShape, positive};
use crate::base::Vec3;

/// Sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Radius [m].
    pub radius: f64,
}

impl BodyShape for Sphere {
    fn fault(&self) -> Option<String> {
        let found = || format!("radius is {}; it must be positive and finite", self.radius);
        (!positive(self.radius)).then(found)
    }

    fn volume(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * self.radius.powi(3)
    }

    fn gyration2(&self) -> Vec3 {
        Vec3::repeat(0.4 * self.radius * self.radius)
    }

    fn bounding_radius(&self) -> f64 {
        self.radius
    }

    fn reference_radius(&self) -> f64 {
        self.radius
    }

    fn sphere_count(&self) -> usize {
        1
    }

    fn for_spheres(&self, act: &mut dyn FnMut(Vec3, f64)) {
        act(Vec3::zeros(), self.radius);
    }

    fn sieve_size(&self) -> Option<f64> {
        Some(2.0 * self.radius)
    }
}
