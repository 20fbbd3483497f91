//! 8-node hexahedron: corners of the hex20.
//!
//! ```text
//!            4─────────5       natural axes: xi along 0→1, eta along 1→2, zeta along 0→4
//!           /│        /│       corners 0 1 2 3 (zeta = -1), 4 5 6 7 (zeta = +1),
//!          7─────────6 │       placed and ordered as the corners I…P of [`super::hex20`]
//!          │ │       │ │
//!          │ 0───────│─1
//!          │/        │/
//!          3─────────2
//! ```
//!
//! `N = (1 + x_a x)(1 + y_a y)(1 + z_a z) / 8`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8. Limits: locks with full integration.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::GAUSS2;

/// Node count.
pub const NODES: usize = 8;

/// Natural node coordinates. Shape `[8][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Face nodes, counter-clockwise from outside, by SOLID186 face number minus one.
pub const FACES: [&[usize]; 6] =
    [&[1, 0, 3, 2], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7], &[4, 5, 6, 7]];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Hexahedron,
    stiffness_rules: [&GAUSS2; 3],
    mass_rule: &GAUSS2,
    constant_stress: false,
    linear_dilatation: false,
    incompatible_modes: true,
    locking: Locking::Never,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    NATURAL.map(|c| (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]) * (1.0 + c[2] * xi[2]) / 8.0)
}

/// Derivatives by the natural coordinates. Shape `[8][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    NATURAL.map(|c| {
        let s = [1.0 + c[0] * xi[0], 1.0 + c[1] * xi[1], 1.0 + c[2] * xi[2]];
        [c[0] * s[1] * s[2] / 8.0, c[1] * s[2] * s[0] / 8.0, c[2] * s[0] * s[1] / 8.0]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::hex20;

    #[test]
    fn corners_and_faces_agree_with_the_hex20() {
        assert_eq!(NATURAL, hex20::NATURAL[..8]);
        for (face, nodes) in FACES.iter().zip(hex20::FACES) {
            assert_eq!(**face, nodes[..4]);
        }
    }
}
