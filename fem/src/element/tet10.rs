//! The 10-node tetrahedron.
//!
//! ```text
//!      3
//!      │\ \            natural axes: r along 0→1, s along 0→2, t along 0→3;
//!      7  9  2         r, s, t >= 0, r + s + t <= 1;
//!      │6  \8 \5       0-1-2 counter-clockwise seen from 3;
//!      0───4──1        mid-sides 4 (0-1), 5 (1-2), 6 (2-0), 7 (0-3), 8 (1-3), 9 (2-3)
//! ```
//!
//! With the volume coordinates `L = (1 - r - s - t, r, s, t)`: corner `N = L (2 L - 1)`, mid-side of i and j
//! `N = 4 L_i L_j`.
//!
//! Source: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), chapter 8 (tetrahedral elements).
//! Limits: complete quadratic polynomials while mid-side nodes stay near the middle of straight sides. With straight
//! sides the 4-point rule integrates the stiffness exactly; the mass needs degree 4.

use super::tet4;

/// Number of nodes.
pub const TET10_NODES: usize = 10;

/// Natural coordinates of the nodes. Shape `[10][3]`, no unit.
pub const NATURAL: [[f64; 3]; TET10_NODES] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// Local nodes of each face: corners counter-clockwise seen from outside, then the mid-side node after each corner
/// (a [`super::tri6`] each).
pub const FACES: [&[usize]; 4] =
    [&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9]];

/// Corners of the side of each mid-side node 4–9.
const SIDES: [(usize, usize); 6] = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];

/// Values of the 10 shape functions at the natural point `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; TET10_NODES] {
    let l = tet4::shape_functions(xi);
    let mut n = [0.0; TET10_NODES];
    for i in 0..4 {
        n[i] = l[i] * (2.0 * l[i] - 1.0);
    }
    for (m, (i, j)) in SIDES.into_iter().enumerate() {
        n[4 + m] = 4.0 * l[i] * l[j];
    }
    n
}

/// Derivatives of the 10 shape functions with respect to (r, s, t), at `xi`. Shape `[10][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; TET10_NODES] {
    let (l, dl) = (tet4::shape_functions(xi), tet4::gradients(xi));
    let mut d = [[0.0; 3]; TET10_NODES];
    for k in 0..3 {
        for i in 0..4 {
            d[i][k] = (4.0 * l[i] - 1.0) * dl[i][k];
        }
        for (m, (i, j)) in SIDES.into_iter().enumerate() {
            d[4 + m][k] = 4.0 * (dl[i][k] * l[j] + l[i] * dl[j][k]);
        }
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;
    use crate::element::quadrature::{TET14, TET24};

    #[test]
    fn shape_functions_are_nodal_complete_and_consistent_with_their_gradients() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 2);
        checks::differences(&NATURAL, shape_functions, gradients);
        checks::mid_sides(&NATURAL, 4, &SIDES);
    }

    /// The Jacobian determinant of a curved tet10 is of degree 3, so that both rules are exact.
    #[test]
    fn faces_are_tri6_and_close_the_element() {
        checks::faces(&NATURAL, shape_functions, &FACES);
        checks::volume(&NATURAL, gradients, &FACES, &TET14, 1e-13);
        checks::volume(&NATURAL, gradients, &FACES, &TET24, 1e-13);
    }
}
