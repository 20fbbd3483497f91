//! 5-node pyramid: corners of the pyramid13.
//!
//! ```text
//!            4             natural axes: x along 0→1, y along 1→2, t from the base to the apex;
//!          / │\\           |x|, |y| <= 1 - t, 0 <= t <= 1
//!         / 3│─\─2         base 0 1 2 3 (t = 0), counter-clockwise seen from the apex;
//!        / / │  \/         apex 4 (0, 0, 1)
//!       0───────1
//! ```
//!
//! Source: Bedrosian, Int. J. Numer. Methods Eng. 35 (1992) 95-108.
//! Limits: at the apex the limit along the axis (p = q = 0) is used, exact for linear fields. Meshes of
//! pyramids only lock slightly near incompressibility.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::pyramid13::section;
use super::quadrature::{PYRAMID8, PYRAMID27};

/// Node count.
pub const NODES: usize = 5;

/// Natural node coordinates. Shape `[5][3]`.
pub const NATURAL: [[f64; 3]; NODES] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Face nodes, counter-clockwise from outside: base ([`super::quad4`]), then sides 0-1, 1-2, 2-3, 3-0
/// ([`super::tri3`]).
pub const FACES: [&[usize]; 5] = [&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Pyramid,
    stiffness_rules: [&PYRAMID8; 3],
    mass_rule: &PYRAMID27,
    constant_stress: true,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Always,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let (u, p, q) = section(xi);
    let mut n = [0.0; NODES];
    for (i, c) in NATURAL[..4].iter().enumerate() {
        n[i] = u * (1.0 + c[0] * p) * (1.0 + c[1] * q) / 4.0;
    }
    n[4] = xi[2];
    n
}

/// Derivatives by (x, y, t). Shape `[5][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let (_, p, q) = section(xi);
    let mut d = [[0.0; 3]; NODES];
    for (i, c) in NATURAL[..4].iter().enumerate() {
        let (a, b) = (c[0] * p, c[1] * q);
        d[i] = [c[0] * (1.0 + b) / 4.0, c[1] * (1.0 + a) / 4.0, (a * b - 1.0) / 4.0];
    }
    d[4] = [0.0, 0.0, 1.0];
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apex_gradients_are_axis_limit() {
        assert_eq!(gradients([0.0, 0.0, 1.0]), gradients([0.0, 0.0, 1.0 - 1e-6]));
        assert_eq!(shape_functions([0.0, 0.0, 1.0]), [0.0, 0.0, 0.0, 0.0, 1.0]);
    }
}
