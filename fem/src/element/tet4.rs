//! 4-node tetrahedron.
//!
//! ```text
//!      3
//!      │\ \            natural axes: r along 0→1, s along 0→2, t along 0→3;
//!      │  \  2         r, s, t >= 0, r + s + t <= 1;
//!      │ / \  \        0-1-2 counter-clockwise seen from 3
//!      0──────1
//! ```
//!
//! `N = 1 - r - s - t, r, s, t`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8. Limits: too stiff in bending and near
//! incompressibility; use tet10 for accuracy.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::{TET1, TET4};

/// Node count.
pub const NODES: usize = 4;

/// Natural node coordinates. Shape `[4][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Face nodes, counter-clockwise from outside.
pub const FACES: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Tetrahedron,
    stiffness_rules: [&TET1; 3],
    mass_rule: &TET4,
    constant_stress: true,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Always,
};

/// Shape functions (volume coordinates) at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
}

/// Derivatives by (r, s, t), constant. Shape `[4][3]`.
#[inline]
pub fn gradients(_xi: [f64; 3]) -> [[f64; 3]; NODES] {
    [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}
