//! The 6-node triangle: the face of a tet10, and the triangular faces of a wedge15 and a pyramid13.
//!
//! ```text
//!      2
//!      │\          natural axes: r along 0→1, s along 0→2; r, s >= 0, r + s <= 1
//!      5  4        corners counter-clockwise seen from outside the body,
//!      │    \      so that dx/dr × dx/ds points outward;
//!      0──3──1     mid-sides 3 (0-1), 4 (1-2), 5 (2-0)
//! ```
//!
//! With the area coordinates `L = (1 - r - s, r, s)`: corner `N = L (2 L - 1)`, mid-side of i and j `N = 4 L_i L_j`.
//!
//! Source: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), chapter 8 (triangular element family).
//! Limits: complete quadratic polynomials while mid-side nodes stay near the middle of straight sides.

use super::tri3;

/// Number of nodes.
pub const TRI6_NODES: usize = 6;

/// Natural coordinates of the nodes. Shape `[6][2]`, no unit.
pub const NATURAL: [[f64; 2]; TRI6_NODES] =
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// Values of the 6 shape functions at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; TRI6_NODES] {
    let l = tri3::shape_functions(xi);
    let mut n = [0.0; TRI6_NODES];
    for i in 0..3 {
        n[i] = l[i] * (2.0 * l[i] - 1.0);
        n[3 + i] = 4.0 * l[i] * l[(i + 1) % 3];
    }
    n
}

/// First derivatives of the 6 shape functions with respect to (r, s). Shape `[6][2]`.
#[inline]
pub fn gradients(xi: [f64; 2]) -> [[f64; 2]; TRI6_NODES] {
    let (l, dl) = (tri3::shape_functions(xi), tri3::gradients(xi));
    let mut d = [[0.0; 2]; TRI6_NODES];
    for i in 0..3 {
        let j = (i + 1) % 3;
        for k in 0..2 {
            d[i][k] = (4.0 * l[i] - 1.0) * dl[i][k];
            d[3 + i][k] = 4.0 * (dl[i][k] * l[j] + l[i] * dl[j][k]);
        }
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;

    #[test]
    fn shape_functions_are_nodal_complete_and_consistent_with_their_gradients() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 2);
        checks::differences(&NATURAL, shape_functions, gradients);
        checks::mid_sides(&NATURAL, 3, &[(0, 1), (1, 2), (2, 0)]);
    }
}
