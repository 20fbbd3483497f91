//! Bodies bounded by triangles.
//!
//! A [`Polyhedron`] bounds a volume: each edge has two triangles, and all normals point out of the material.
//!
//! Limits: self-intersection is not checked; volumes then count with the winding number.

mod hull;
mod moments;
mod sample;
mod surface;
mod topology;

use nalgebra::{Matrix3, Vector3};

pub use hull::{HullError, convex_hull, triangles as hull_triangles};
pub use moments::BodyMoments;
pub use surface::{Surface, SurfaceError};
pub use topology::Topology;

/// Body bounded by triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    surface: Surface,
    shells: usize,
    holes: usize,
}

impl Polyhedron {
    /// Orients a surface outwards, or inwards for shells inside an odd number of others.
    ///
    /// # Errors
    /// [`SurfaceError`] if the surface bounds no volume.
    pub fn new(surface: &Surface) -> Result<Polyhedron, SurfaceError> {
        if let Some(v) = surface.vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
            return Err(SurfaceError::NotFinite(v));
        }
        topology::check_indices(surface)?;
        let mut plain = surface.clone();
        plain.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        if plain.triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        let mut surface = plain.without_loose_vertices();
        let (shells, holes) = topology::orient(&mut surface)?;
        let size = surface.diagonal();
        let body = Polyhedron { surface, shells, holes };
        if body.moments().volume.is_nan() || body.moments().volume <= 1e-12 * size.powi(3) {
            return Err(SurfaceError::Flat);
        }
        Ok(body)
    }

    /// Outward-oriented surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Number of outer shells.
    pub fn pieces(&self) -> usize {
        self.shells - self.holes
    }

    /// Number of inner shells (holes).
    pub fn holes(&self) -> usize {
        self.holes
    }

    /// Volume, centroid and inertia, exact to rounding.
    pub fn moments(&self) -> BodyMoments {
        moments::moments(&self.surface)
    }

    /// Sphericity ψ = π^⅓ (6V)^⅔ / S (H. Wadell, J. Geology 40, 1932); 0.806 for a cube.
    pub fn sphericity(&self) -> f64 {
        sphericity(self.moments().volume, self.surface.area())
    }

    /// Moves the centroid to the origin and the principal axes to x, y, z, moments ascending (x is the long
    /// axis).
    pub fn in_principal_frame(&self) -> Polyhedron {
        let m = self.moments();
        let (_, axes) = super::clump::principal(m.inertia);
        self.mapped(&axes.transpose(), &m.centroid)
    }

    /// Maps every point x to A (x − o). `A` must not mirror.
    pub fn mapped(&self, a: &Matrix3<f64>, o: &Vector3<f64>) -> Polyhedron {
        let vertices = self.surface.vertices.iter().map(|v| (a * (Vector3::from(*v) - o)).into()).collect();
        Polyhedron { surface: Surface { vertices, triangles: self.surface.triangles.clone() }, ..*self }
    }

    /// Scales by `s` > 0 about the origin.
    pub fn scaled(&self, s: f64) -> Polyhedron {
        self.mapped(&(Matrix3::identity() * s), &Vector3::zeros())
    }

    /// Bounding box in the principal frame [m].
    pub fn extents(&self) -> [f64; 3] {
        let [lo, hi] = self.in_principal_frame().surface.bounds();
        std::array::from_fn(|k| hi[k] - lo[k])
    }

    /// Square sieve size [m]: intermediate principal extent, as [`super::clump::Clump::sieve_size`].
    pub fn sieve_size(&self) -> f64 {
        let mut extents = self.extents();
        extents.sort_by(f64::total_cmp);
        extents[1]
    }

    /// `count` reproducible surface points of equal area.
    pub fn surface_points(&self, count: usize) -> Vec<[f64; 3]> {
        sample::surface_points(&self.surface, count)
    }
}

/// Wadell's sphericity from volume [m³] and surface area [m²].
pub fn sphericity(volume: f64, area: f64) -> f64 {
    libm::cbrt(std::f64::consts::PI) * libm::pow(6.0 * volume, 2.0 / 3.0) / area
}

#[cfg(test)]
#[path = "polyhedron/polyhedron_tests.rs"]
mod tests;
