//! Natural coordinates of a point inside a 20-node hexahedron, by Newton (S2 eq. 21 and its text; the
//! iteration itself is not given there).
//!
//! Solves Σ Nᵢ(ξ) xᵢ = p from ξ = 0 or from a warm start. The stop is on the residual, 10⁻¹³ of the largest
//! coordinate difference of the element. A point of a *face* is found by [`crate::face::closest_point`]
//! instead: the three-dimensional map has no solution worth the name for a point off the element.

use nalgebra::{Matrix3, Vector3};
use trackbed_fem::element::hex20;

const TOLERANCE: f64 = 1e-13;
const MAX_ITERATIONS: usize = 30;

/// Result of the inverse map.
#[derive(Clone, Copy, Debug)]
pub struct Natural {
    /// Natural coordinates (ξ, η, ζ).
    pub xi: [f64; 3],
    /// Newton iterations used.
    pub iterations: usize,
}

/// Natural coordinates at which the element with node coordinates `x` [m], shape `[20][3]`, passes through
/// `point` [m]. `None` when Newton does not converge or the Jacobian is singular on the way.
pub fn hex20(x: &[[f64; 3]; 20], point: [f64; 3], start: [f64; 3]) -> Option<Natural> {
    let mut size = 0.0_f64;
    for d in 0..3 {
        let low = x.iter().map(|n| n[d]).fold(f64::INFINITY, f64::min);
        let high = x.iter().map(|n| n[d]).fold(f64::NEG_INFINITY, f64::max);
        size = size.max(high - low);
    }
    let mut xi = Vector3::from(start);
    for iterations in 0..=MAX_ITERATIONS {
        let n = hex20::shape_functions(xi.into());
        let mut residual = -Vector3::from(point);
        for i in 0..20 {
            residual += n[i] * Vector3::from(x[i]);
        }
        if residual.norm() < TOLERANCE * size {
            return Some(Natural { xi: xi.into(), iterations });
        }
        let dn = hex20::gradients(xi.into());
        let mut jacobian = Matrix3::zeros();
        for i in 0..20 {
            jacobian += Vector3::from(x[i]) * nalgebra::RowVector3::from(dn[i]);
        }
        xi -= jacobian.try_inverse()? * residual;
    }
    None
}
