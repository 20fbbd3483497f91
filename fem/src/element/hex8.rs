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

/// Node count.
pub const HEX8_NODES: usize = 8;

/// Natural node coordinates. Shape `[8][3]`.
pub const NATURAL: [[f64; 3]; HEX8_NODES] = [
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

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; HEX8_NODES] {
    NATURAL.map(|c| (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]) * (1.0 + c[2] * xi[2]) / 8.0)
}

/// Derivatives by the natural coordinates. Shape `[8][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; HEX8_NODES] {
    NATURAL.map(|c| {
        let s = [1.0 + c[0] * xi[0], 1.0 + c[1] * xi[1], 1.0 + c[2] * xi[2]];
        [c[0] * s[1] * s[2] / 8.0, c[1] * s[2] * s[0] / 8.0, c[2] * s[0] * s[1] / 8.0]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::hex20::FACE_NODES;
    use crate::element::quadrature::{GAUSS2, GAUSS3};
    use crate::element::{checks, hex20};

    #[test]
    fn shape_functions_are_valid() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 1);
        checks::differences(&NATURAL, shape_functions, gradients);
        assert_eq!(NATURAL, hex20::NATURAL[..8]);
    }

    #[test]
    fn faces_are_quad4() {
        checks::faces(&NATURAL, shape_functions, &FACES);
        checks::volume(&NATURAL, gradients, &FACES, &GAUSS2, 1e-13);
        checks::volume(&NATURAL, gradients, &FACES, &GAUSS3, 1e-13);
        for (face, nodes) in FACES.iter().zip(FACE_NODES) {
            assert_eq!(**face, nodes[..4]);
        }
    }

    #[test]
    fn the_hex20_passes_the_shared_checks() {
        checks::nodal(&hex20::NATURAL, hex20::shape_functions);
        checks::complete(&hex20::NATURAL, hex20::shape_functions, 2);
        let faces: Vec<&[usize]> = FACE_NODES.iter().map(|f| f.as_slice()).collect();
        checks::faces(&hex20::NATURAL, hex20::shape_functions, &faces);
        checks::volume(&hex20::NATURAL, hex20::gradients, &faces, &GAUSS3, 1e-13);
    }
}
