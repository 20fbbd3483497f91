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

/// Node count.
pub const TET4_NODES: usize = 4;

/// Natural node coordinates. Shape `[4][3]`.
pub const NATURAL: [[f64; 3]; TET4_NODES] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Face nodes, counter-clockwise from outside.
pub const FACES: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];

/// Shape functions (volume coordinates) at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 3]) -> [f64; TET4_NODES] {
    [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
}

/// Derivatives by (r, s, t), constant. Shape `[4][3]`.
#[inline]
pub fn gradients(_xi: [f64; 3]) -> [[f64; 3]; TET4_NODES] {
    [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;
    use crate::element::quadrature::{TET1, TET4};

    #[test]
    fn shape_functions_are_valid() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 1);
        checks::differences(&NATURAL, shape_functions, gradients);
    }

    #[test]
    fn faces_close_element() {
        checks::faces(&NATURAL, shape_functions, &FACES);
        checks::volume(&NATURAL, gradients, &FACES, &TET1, 1e-13);
        checks::volume(&NATURAL, gradients, &FACES, &TET4, 1e-13);
    }
}
