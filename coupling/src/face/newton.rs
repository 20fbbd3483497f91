//! Closest point by Newton in the two natural coordinates.
//!
//! The closest point to `c` minimises g(ξ) = ½ |x(ξ) − c|² over the domain of the face. Newton uses
//! ∂g/∂ξₐ = (x − c)·x,ₐ and ∂²g/∂ξₐ∂ξᵦ = x,ₐ·x,ᵦ + (x − c)·x,ₐᵦ; where that matrix is not positive definite
//! the Gauss–Newton part x,ₐ·x,ᵦ takes its place. Steps stay in the domain of the face (`domain.rs`), and a step that
//! does not lower g is halved, so a point outside the face ends on the border: this is the fallback that a
//! three-dimensional inverse map lacks for a point above the surface.
//!
//! Limit: a face folded so strongly that several local minima lie within reach yields the one nearest to the
//! start.
//!
//! Theory manual: equation (5.1) of `docs/theory/coupling.md`.

use super::domain::{Domain, Location};
use super::form::{Form, cross, dot};

/// Newton stops when the step in natural coordinates is below this: convergence is quadratic, so the error left is
/// about its square.
const STEP: f64 = 1e-8;
const MAX_ITERATIONS: usize = 50;

/// Closest point of a face to a given centre.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Natural coordinates (ξ, η): in [−1, 1]² on a quadrilateral; 0 or more with a sum of at most 1 on a triangle.
    pub natural: [f64; 2],
    /// The point itself [m].
    pub point: [f64; 3],
    /// Unit normal of the face there, outward for faces ordered as [`trackbed_fem::mesh::Face`].
    pub normal: [f64; 3],
    /// Inside, on a side or on a corner.
    pub location: Location,
    /// Newton iterations used.
    pub iterations: usize,
}

/// The face and the distance function at one natural point.
pub(super) struct Local {
    pub point: [f64; 3],
    pub distance2: f64,
    pub tangent: [[f64; 3]; 2],
    pub gradient: [f64; 2],
    /// x,ₐ·x,ᵦ: 11, 22, 12.
    pub metric: [f64; 3],
    /// (x − c)·x,ₐᵦ: 11, 22, 12.
    pub curvature: [f64; 3],
}

impl Local {
    #[inline]
    pub fn at(form: &Form, centre: [f64; 3], xi: [f64; 2]) -> Local {
        let (point, tangent, second) = (form.at(xi), form.tangents(xi), form.second(xi));
        let r = [point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]];
        Local {
            point,
            distance2: dot(r, r),
            gradient: [dot(r, tangent[0]), dot(r, tangent[1])],
            metric: [dot(tangent[0], tangent[0]), dot(tangent[1], tangent[1]), dot(tangent[0], tangent[1])],
            curvature: [dot(r, second[0]), dot(r, second[1]), dot(r, second[2])],
            tangent,
        }
    }

    /// Second derivatives of g, and whether they are positive definite.
    #[inline]
    pub fn hessian(&self) -> ([f64; 3], bool) {
        let full = [0, 1, 2].map(|k| self.metric[k] + self.curvature[k]);
        (full, full[0] > 0.0 && full[0] * full[1] - full[2] * full[2] > 0.0)
    }

    /// The step to where the quadratic with the second derivatives `h` and this gradient is least.
    #[inline]
    pub fn free_step(&self, h: [f64; 3]) -> [f64; 2] {
        let g = self.gradient;
        let det = h[0] * h[1] - h[2] * h[2];
        [-(h[1] * g[0] - h[2] * g[1]) / det, -(h[0] * g[1] - h[2] * g[0]) / det]
    }
}

/// Closest point of the face to `centre`, starting from the natural coordinates `start`.
#[inline]
pub(super) fn closest_point<D: Domain>(form: &Form, centre: [f64; 3], start: [f64; 2]) -> Closest {
    let mut xi = D::clamp(start);
    let mut iterations = 0;
    let mut here = Local::at(form, centre, xi);
    while iterations < MAX_ITERATIONS {
        iterations += 1;
        let step = D::step(&here, xi);
        let mut scale = 1.0;
        let mut moved = [0.0; 2];
        loop {
            let next = D::clamp([xi[0] + scale * step[0], xi[1] + scale * step[1]]);
            let there = Local::at(form, centre, next);
            // Rounding may raise g by a few ulps at the minimum itself: that still counts as no worse.
            if there.distance2 <= here.distance2 * (1.0 + 1e-14) {
                moved = [next[0] - xi[0], next[1] - xi[1]];
                xi = next;
                here = there;
                break;
            }
            scale *= 0.5;
            if scale < 1e-6 {
                break;
            }
        }
        if moved[0].abs().max(moved[1].abs()) < STEP {
            break;
        }
    }
    result::<D>(&here, xi, iterations)
}

/// The point that was found.
#[inline]
pub(super) fn result<D: Domain>(here: &Local, xi: [f64; 2], iterations: usize) -> Closest {
    let n = cross(here.tangent[0], here.tangent[1]);
    let length = dot(n, n).sqrt();
    Closest {
        natural: xi,
        point: here.point,
        normal: n.map(|c| c / length),
        location: D::locate(xi),
        iterations,
    }
}
