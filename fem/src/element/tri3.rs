//! The 3-node triangle: the face of a tet4, and the triangular faces of a wedge6 and a pyramid5.
//!
//! ```text
//!      2
//!      │\        natural axes: r along 0→1, s along 0→2; r, s >= 0, r + s <= 1
//!      │ \       corners counter-clockwise seen from outside the body,
//!      0──1      so that dx/dr × dx/ds points outward
//! ```
//!
//! `N = 1 - r - s, r, s`.
//!
//! Source: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), chapter 8 (triangular element family).
//! Limits: the gradient is constant.

/// Number of nodes.
pub const TRI3_NODES: usize = 3;

/// Natural coordinates of the nodes. Shape `[3][2]`, no unit.
pub const NATURAL: [[f64; 2]; TRI3_NODES] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Values of the 3 shape functions (the area coordinates) at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; TRI3_NODES] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}

/// First derivatives of the 3 shape functions with respect to (r, s): the same at every point. Shape `[3][2]`.
#[inline]
pub fn gradients(_xi: [f64; 2]) -> [[f64; 2]; TRI3_NODES] {
    [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]
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
