//! 20-node serendipity hexahedron (SOLID186 order).
//!
//! ```text
//!            M────U────N           natural axes: xi along I→J, eta along J→K, zeta along I→M
//!           /X        /V           corners I J K L (zeta = -1), M N O P (zeta = +1)
//!          P────W────O |           mid-sides Q R S T of the bottom (IJ, JK, KL, LI),
//!          | Y       | Z           U V W X of the top (MN, NO, OP, PM),
//!          B |       A |           Y Z A B of the uprights (IM, JN, KO, LP)
//!          | I────Q──|─J
//!          |/T       |/R
//!          L────S────K
//! ```
//!
//! Corner a: `N = (1 + x_a x)(1 + y_a y)(1 + z_a z)(x_a x + y_a y + z_a z - 2) / 8`
//! Mid-side a: `N = (1 - x²)(1 + y_a y)(1 + z_a z) / 4` for a side along x, and cyclically.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, section 8.9.
//!
//! Theory manual: equation (4.1) of `docs/theory/solid.md`.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::{GAUSS2, GAUSS3, IRONS14};

/// Node count.
pub const NODES: usize = 20;

/// Natural node coordinates, in SOLID186 order. Shape `[20][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Face nodes (0-based), by SOLID186 face number minus one: corners counter-clockwise from outside, then
/// mid-sides.
///
/// SOLID186 faces: 1 J-I-L-K, 2 I-J-N-M, 3 J-K-O-N, 4 K-L-P-O, 5 L-I-M-P, 6 M-N-O-P.
pub const FACES: [&[usize]; 6] = [
    &[1, 0, 3, 2, 8, 11, 10, 9],
    &[0, 1, 5, 4, 8, 17, 12, 16],
    &[1, 2, 6, 5, 9, 18, 13, 17],
    &[2, 3, 7, 6, 10, 19, 14, 18],
    &[3, 0, 4, 7, 11, 16, 15, 19],
    &[4, 5, 6, 7, 12, 13, 14, 15],
];

#[inline]
fn side_axis(node: usize) -> usize {
    match node {
        16.. => 2,
        n => n % 2,
    }
}

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Hexahedron,
    stiffness_rules: [&GAUSS2, &IRONS14, &GAUSS3],
    mass_rule: &GAUSS3,
    constant_stress: false,
    linear_dilatation: true,
    incompatible_modes: false,
    locking: Locking::FullRules,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let mut n = [0.0; NODES];
    for (a, c) in NATURAL.iter().enumerate() {
        let s = [c[0] * xi[0], c[1] * xi[1], c[2] * xi[2]];
        n[a] = if a < 8 {
            (1.0 + s[0]) * (1.0 + s[1]) * (1.0 + s[2]) * (s[0] + s[1] + s[2] - 2.0) / 8.0
        } else {
            let (k, i, j) = cyclic(side_axis(a));
            (1.0 - xi[k] * xi[k]) * (1.0 + s[i]) * (1.0 + s[j]) / 4.0
        };
    }
    n
}

/// Derivatives by the natural coordinates. Shape `[20][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let mut d = [[0.0; 3]; NODES];
    for (a, c) in NATURAL.iter().enumerate() {
        let s = [c[0] * xi[0], c[1] * xi[1], c[2] * xi[2]];
        if a < 8 {
            let sum = s[0] + s[1] + s[2];
            for k in 0..3 {
                let (_, i, j) = cyclic(k);
                d[a][k] = c[k] * (1.0 + s[i]) * (1.0 + s[j]) * (sum + s[k] - 1.0) / 8.0;
            }
        } else {
            let (k, i, j) = cyclic(side_axis(a));
            let bubble = 1.0 - xi[k] * xi[k];
            d[a][k] = -2.0 * xi[k] * (1.0 + s[i]) * (1.0 + s[j]) / 4.0;
            d[a][i] = bubble * c[i] * (1.0 + s[j]) / 4.0;
            d[a][j] = bubble * (1.0 + s[i]) * c[j] / 4.0;
        }
    }
    d
}

#[inline]
fn cyclic(k: usize) -> (usize, usize, usize) {
    (k, (k + 1) % 3, (k + 2) % 3)
}
