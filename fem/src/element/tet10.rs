//! 10-node tetrahedron.
//!
//! ```text
//!      3
//!      │\ \            natural axes: r along 0→1, s along 0→2, t along 0→3;
//!      7  9  2         r, s, t >= 0, r + s + t <= 1;
//!      │6  \8 \5       0-1-2 counter-clockwise seen from 3;
//!      0───4──1        mid-sides 4 (0-1), 5 (1-2), 6 (2-0), 7 (0-3), 8 (1-3), 9 (2-3)
//! ```
//!
//! With the volume coordinates `L = (1 - r - s - t, r, s, t)`: corner `N = L (2 L - 1)`, mid-side
//! `N = 4 L_i L_j`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::{TET4, TET14};
use super::tet4;

/// Node count.
pub const NODES: usize = 10;

/// Natural node coordinates. Shape `[10][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [
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

/// Face nodes: corners counter-clockwise from outside, then mid-sides.
pub const FACES: [&[usize]; 4] =
    [&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9]];

const SIDES: [(usize, usize); 6] = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Tetrahedron,
    stiffness_rules: [&TET4, &TET4, &TET14],
    mass_rule: &TET14,
    constant_stress: false,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Pointwise,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let l = tet4::shape_functions(xi);
    let mut n = [0.0; NODES];
    for i in 0..4 {
        n[i] = l[i] * (2.0 * l[i] - 1.0);
    }
    for (m, (i, j)) in SIDES.into_iter().enumerate() {
        n[4 + m] = 4.0 * l[i] * l[j];
    }
    n
}

/// Derivatives by (r, s, t). Shape `[10][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let (l, dl) = (tet4::shape_functions(xi), tet4::gradients(xi));
    let mut d = [[0.0; 3]; NODES];
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
