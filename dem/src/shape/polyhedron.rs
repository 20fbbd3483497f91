//! Bodies bounded by triangles.
//!
//! A [`Surface`] is what a file holds: triangles in any order, wound either way, closed or open. A [`Polyhedron`] is a
//! surface that bounds a volume: every edge between exactly two triangles, wound so that all normals point out of the
//! material (out of the body on its outside, into the hole on a hole's wall).
//!
//! Limits: self-intersection is not looked for; volumes then count with the winding number.

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

/// A body bounded by triangles; see the module's text.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    surface: Surface,
    shells: usize,
    holes: usize,
}

impl Polyhedron {
    /// The body that a surface bounds. Triangles may be wound either way: each shell is wound alike and outwards, or
    /// inwards where it lies inside an odd number of others.
    ///
    /// # Errors
    /// [`SurfaceError`] when the surface does not bound a volume.
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

    /// Its surface, wound outwards.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Number of closed pieces of the surface that bound material from outside.
    pub fn pieces(&self) -> usize {
        self.shells - self.holes
    }

    /// Number of closed pieces of the surface that bound holes inside.
    pub fn holes(&self) -> usize {
        self.holes
    }

    /// Volume, centroid and inertia, exact but for rounding.
    pub fn moments(&self) -> BodyMoments {
        moments::moments(&self.surface)
    }

    /// Sphericity ψ = π^⅓ (6V)^⅔ / S: surface of the sphere of the same volume over that of the body (H. Wadell,
    /// J. Geology 40, 1932); 1 for a sphere, 0.806 for a cube.
    pub fn sphericity(&self) -> f64 {
        sphericity(self.moments().volume, self.surface.area())
    }

    /// The same body with its centroid in the origin and its principal axes along x, y, z: moments of inertia rise
    /// from x to z, so that x is the long axis of an elongated body.
    pub fn in_principal_frame(&self) -> Polyhedron {
        let m = self.moments();
        let (_, axes) = super::clump::principal(m.inertia);
        self.mapped(&axes.transpose(), &m.centroid)
    }

    /// The same body with every point x taken to A (x − o). `A` must not mirror.
    pub fn mapped(&self, a: &Matrix3<f64>, o: &Vector3<f64>) -> Polyhedron {
        let vertices = self.surface.vertices.iter().map(|v| (a * (Vector3::from(*v) - o)).into()).collect();
        Polyhedron { surface: Surface { vertices, triangles: self.surface.triangles.clone() }, ..*self }
    }

    /// The same body `s` times as large (`s` > 0) about the origin.
    pub fn scaled(&self, s: f64) -> Polyhedron {
        self.mapped(&(Matrix3::identity() * s), &Vector3::zeros())
    }

    /// Extents of the bounding box in the principal frame [m], along x, y, z of that frame.
    pub fn extents(&self) -> [f64; 3] {
        let [lo, hi] = self.in_principal_frame().surface.bounds();
        std::array::from_fn(|k| hi[k] - lo[k])
    }

    /// Size of the square sieve that the body just passes [m]: the intermediate extent in the principal frame, as
    /// [`super::clump::Clump::sieve_size`].
    pub fn sieve_size(&self) -> f64 {
        let mut extents = self.extents();
        extents.sort_by(f64::total_cmp);
        extents[1]
    }

    /// `count` points on the surface, each for the same share of its area; the same points every time.
    pub fn surface_points(&self, count: usize) -> Vec<[f64; 3]> {
        sample::surface_points(&self.surface, count)
    }
}

/// Wadell's sphericity of a body of volume `volume` [m³] with surface `area` [m²].
pub fn sphericity(volume: f64, area: f64) -> f64 {
    libm::cbrt(std::f64::consts::PI) * libm::pow(6.0 * volume, 2.0 / 3.0) / area
}

#[cfg(test)]
#[path = "polyhedron/polyhedron_tests.rs"]
mod tests;
