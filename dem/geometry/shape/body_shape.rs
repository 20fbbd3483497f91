//! Queries of a shape.

use crate::base::Vec3;

/// Points [m], and polygons by point numbers.
pub type Outline = (Vec<Vec3>, Vec<Vec<u32>>);

/// Shape about its centre of mass, along principal axes, at scale 1. Queried at set-up, search and output only.
pub trait BodyShape {
    /// Returns what is wrong with its numbers.
    fn fault(&self) -> Option<String>;

    /// Volume [m³].
    fn volume(&self) -> f64;

    /// Principal moments of inertia over mass [m²].
    fn gyration2(&self) -> Vec3;

    /// Bounding radius about the centre of mass [m].
    fn bounding_radius(&self) -> f64;

    /// Radius that overlaps are compared with [m].
    fn reference_radius(&self) -> f64;

    /// Largest effective contact radius [m]: on a plane; `None`: of its partners.
    fn contact_radius(&self) -> Option<f64> {
        Some(self.bounding_radius())
    }

    /// Largest squared lever arms of contacts about the axes [m²].
    fn levers2(&self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Twice the number of contacts in one direction, at a scale, with grains of radius `smallest` [m];
    /// `several`: other solids exist. Not of dilated bodies.
    fn contacts(&self, _scale: f64, _smallest: f64, _several: bool) -> f64 {
        12.0
    }

    /// Number of spheres that it is made of.
    fn sphere_count(&self) -> usize {
        0
    }

    /// Calls `act` with centre and radius [m] of each sphere.
    fn for_spheres(&self, _act: &mut dyn FnMut(Vec3, f64)) {}

    /// Square sieve size [m].
    fn sieve_size(&self) -> Option<f64> {
        None
    }

    /// Longest edge of one contact [m].
    fn longest_edge(&self) -> f64 {
        0.0
    }

    /// Intersection of a body at a scale with a line through `origin` [m] along a unit vector.
    fn chord(&self, _scale: f64, _origin: &Vec3, _along: &Vec3) -> Option<(f64, f64)> {
        None
    }

    /// Signed distance of a point from the surface at a scale, negative inside [m]; `None`: grains are inserted outside
    /// the bounding sphere.
    fn distance(&self, _scale: f64, _point: &Vec3) -> Option<f64> {
        None
    }

    /// Why bodies of this shape are neither inserted nor removed during a run.
    fn permanent(&self) -> Option<&'static str> {
        None
    }

    /// Surface for output; `None` of spheres.
    fn outline(&self) -> Option<Outline> {
        None
    }

    /// Plural name of a shape without spheres.
    fn solid_name(&self) -> Option<&'static str> {
        None
    }
}

pub(super) fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}
