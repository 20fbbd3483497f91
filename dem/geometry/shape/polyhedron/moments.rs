//! Volume integrals of a closed surface.
//!
//! Signed sums over tetrahedra to the origin, with d = a · (b × c) and s = a + b + c:
//!
//! ```text
//! V = Σ d/6,   ∫x dV = Σ d/24 s,   ∫x xᵀ dV = Σ d/120 (a aᵀ + b bᵀ + c cᵀ + s sᵀ)
//! ```
//!
//! Source: B. Mirtich, J. Graphics Tools 1 (2), 1996; F. Tonon, J. Math. Statistics 1, 2005.

use super::surface::Surface;
use nalgebra::{Matrix3, Vector3};

/// Volume integrals at unit density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMoments {
    /// Volume [m³].
    pub volume: f64,
    /// Centroid [m].
    pub centroid: Vector3<f64>,
    /// Inertia tensor about the centroid per unit density [m⁵].
    pub inertia: Matrix3<f64>,
}

impl BodyMoments {
    /// Principal moments of inertia per unit density [m⁵], ascending.
    pub fn principal(&self) -> [f64; 3] {
        crate::shape::clump::principal(self.inertia).0
    }
}

pub(super) fn moments(surface: &Surface) -> BodyMoments {
    let [lo, hi] = surface.bounds();
    let middle = (Vector3::from(lo) + Vector3::from(hi)) * 0.5;
    let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for t in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(t).map(|x| x - middle);
        let d = a.dot(&b.cross(&c));
        let s = a + b + c;
        volume += d / 6.0;
        first += s * (d / 24.0);
        second +=
            (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose()) * (d / 120.0);
    }
    let centre = if volume == 0.0 { Vector3::zeros() } else { first / volume };
    let central = second - centre * centre.transpose() * volume;
    let inertia = Matrix3::identity() * central.trace() - central;
    BodyMoments { volume, centroid: middle + centre, inertia }
}
