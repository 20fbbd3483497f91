//! Closest point by Newton's method in two natural coordinates.
//!
//! Minimises g(ξ) = ½ |x(ξ) − c|²; an indefinite Hessian is replaced by its Gauss–Newton part. Steps stay
//! in the domain and are halved until g decreases, so outside points end on the border. Theory manual: eq.
//! (5.1).

use super::domain::{Domain, Location};
use super::form::{Form, cross, dot};

/// Tolerance in natural coordinates; the error is about its square.
const STEP: f64 = 1e-8;
const MAX_ITERATIONS: usize = 50;

/// Closest point of a face.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Natural coordinates (ξ, η).
    pub natural: [f64; 2],
    /// Position [m].
    pub point: [f64; 3],
    /// Unit normal, outward for faces ordered as [`trackbed_fem::mesh::Face`].
    pub normal: [f64; 3],
    /// Interior, side or corner.
    pub location: Location,
    /// Newton iterations.
    pub iterations: usize,
}

/// Face and distance function at one natural point.
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

    /// Hessian of g, and whether it is positive definite.
    #[inline]
    pub fn hessian(&self) -> ([f64; 3], bool) {
        let full = [0, 1, 2].map(|k| self.metric[k] + self.curvature[k]);
        (full, full[0] > 0.0 && full[0] * full[1] - full[2] * full[2] > 0.0)
    }

    /// Minimiser of the quadratic model with Hessian `h`.
    #[inline]
    pub fn free_step(&self, h: [f64; 3]) -> [f64; 2] {
        let g = self.gradient;
        let det = h[0] * h[1] - h[2] * h[2];
        [-(h[1] * g[0] - h[2] * g[1]) / det, -(h[0] * g[1] - h[2] * g[0]) / det]
    }
}

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
            // Rounding may raise g by a few ulps at the minimum.
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
