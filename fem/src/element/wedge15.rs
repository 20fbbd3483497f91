//! 15-node serendipity wedge (triangular prism).
//!
//! ```text
//!            5
//!           /│\            natural axes: r along 0→1, s along 0→2, t along 0→3;
//!         11 │ 10          r, s >= 0, r + s <= 1, -1 <= t <= 1
//!         /  14  \         corners 0 1 2 (t = -1), 3 4 5 (t = +1);
//!        3───9────4        0-1-2 counter-clockwise seen from the top
//!        │   2    │        mid-sides 6 7 8 of the bottom (0-1, 1-2, 2-0),
//!       12  / \   13       9 10 11 of the top (3-4, 4-5, 5-3),
//!        │ 8   7  │        12 13 14 of the uprights (0-3, 1-4, 2-5)
//!        │/      \│
//!        0───6────1
//! ```
//!
//! With the area coordinates `L = (1 - r - s, r, s)` and `t_a = ±1`:
//! corner `N = L (1 + t_a t)(2 L + t_a t - 2) / 2`, mid-side of a triangle `N = 2 L_i L_j (1 + t_a t)`,
//! mid-side of an upright `N = L (1 - t²)`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::{WEDGE9, WEDGE21};
use super::tri3;

/// Node count.
pub const NODES: usize = 15;

/// Natural node coordinates. Shape `[15][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, -1.0],
    [0.5, 0.5, -1.0],
    [0.0, 0.5, -1.0],
    [0.5, 0.0, 1.0],
    [0.5, 0.5, 1.0],
    [0.0, 0.5, 1.0],
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
];

/// Face nodes: corners counter-clockwise from outside, then mid-sides. Bottom, top ([`super::tri6`]), sides
/// 0-1, 1-2, 2-0 ([`super::quad8`]).
pub const FACES: [&[usize]; 5] = [
    &[0, 2, 1, 8, 7, 6],
    &[3, 4, 5, 9, 10, 11],
    &[0, 1, 4, 3, 6, 13, 9, 12],
    &[1, 2, 5, 4, 7, 14, 10, 13],
    &[2, 0, 3, 5, 8, 12, 11, 14],
];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Wedge,
    stiffness_rules: [&WEDGE9, &WEDGE9, &WEDGE21],
    mass_rule: &WEDGE21,
    constant_stress: false,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Pointwise,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let (l, t) = (tri3::shape_functions([xi[0], xi[1]]), xi[2]);
    let mut n = [0.0; NODES];
    for i in 0..3 {
        let pair = 2.0 * l[i] * l[(i + 1) % 3];
        n[i] = l[i] * (1.0 - t) * (2.0 * l[i] - t - 2.0) / 2.0;
        n[3 + i] = l[i] * (1.0 + t) * (2.0 * l[i] + t - 2.0) / 2.0;
        n[6 + i] = pair * (1.0 - t);
        n[9 + i] = pair * (1.0 + t);
        n[12 + i] = l[i] * (1.0 - t * t);
    }
    n
}

/// Derivatives by (r, s, t). Shape `[15][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let (l, dl) = (tri3::shape_functions([xi[0], xi[1]]), tri3::gradients([xi[0], xi[1]]));
    let t = xi[2];
    let mut d = [[0.0; 3]; NODES];
    for i in 0..3 {
        let j = (i + 1) % 3;
        for k in 0..2 {
            let pair = 2.0 * (dl[i][k] * l[j] + l[i] * dl[j][k]);
            d[i][k] = dl[i][k] * (1.0 - t) * (4.0 * l[i] - t - 2.0) / 2.0;
            d[3 + i][k] = dl[i][k] * (1.0 + t) * (4.0 * l[i] + t - 2.0) / 2.0;
            d[6 + i][k] = pair * (1.0 - t);
            d[9 + i][k] = pair * (1.0 + t);
            d[12 + i][k] = dl[i][k] * (1.0 - t * t);
        }
        d[i][2] = l[i] * (0.5 + t - l[i]);
        d[3 + i][2] = l[i] * (l[i] + t - 0.5);
        d[6 + i][2] = -2.0 * l[i] * l[j];
        d[9 + i][2] = 2.0 * l[i] * l[j];
        d[12 + i][2] = -2.0 * l[i] * t;
    }
    d
}
