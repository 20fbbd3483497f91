//! The 4-node quadrilateral: the face of a hex8, and the quadrilateral faces of a wedge6 and a pyramid5.
//!
//! ```text
//!      3─────────2        natural axes: xi along 0→1, eta along 1→2
//!      │         │        corners counter-clockwise seen from outside the body,
//!      0─────────1        so that dx/dxi × dx/deta points outward
//! ```
//!
//! `N = (1 + x_a x)(1 + y_a y) / 4`.
//!
//! Source: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), chapter 8 (rectangular elements).
//! Limits: bilinear; complete linear polynomials only.

/// Number of nodes.
pub const QUAD4_NODES: usize = 4;

/// Natural coordinates of the nodes. Shape `[4][2]`, no unit.
pub const NATURAL: [[f64; 2]; QUAD4_NODES] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Values of the 4 shape functions at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; QUAD4_NODES] {
    NATURAL.map(|c| (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]) / 4.0)
}

/// First derivatives of the 4 shape functions with respect to (xi, eta). Shape `[4][2]`.
#[inline]
pub fn gradients(xi: [f64; 2]) -> [[f64; 2]; QUAD4_NODES] {
    NATURAL.map(|c| [c[0] * (1.0 + c[1] * xi[1]) / 4.0, c[1] * (1.0 + c[0] * xi[0]) / 4.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;

    #[test]
    fn shape_functions_are_nodal_complete_and_consistent_with_their_gradients() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 1);
        checks::differences(&NATURAL, shape_functions, gradients);
    }
}
