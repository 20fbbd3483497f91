//! 4-node quadrilateral: face of hex8, wedge6 and pyramid5.
//!
//! ```text
//!      3─────────2        natural axes: xi along 0→1, eta along 1→2
//!      │         │        corners counter-clockwise seen from outside the body,
//!      0─────────1        so that dx/dxi × dx/deta points outward
//! ```
//!
//! `N = (1 + x_a x)(1 + y_a y) / 4`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8.

/// Node count.
pub const QUAD4_NODES: usize = 4;

/// Natural node coordinates. Shape `[4][2]`.
pub const NATURAL: [[f64; 2]; QUAD4_NODES] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Shape functions at `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; QUAD4_NODES] {
    NATURAL.map(|c| (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]) / 4.0)
}

/// Derivatives by (xi, eta). Shape `[4][2]`.
#[inline]
pub fn gradients(xi: [f64; 2]) -> [[f64; 2]; QUAD4_NODES] {
    NATURAL.map(|c| [c[0] * (1.0 + c[1] * xi[1]) / 4.0, c[1] * (1.0 + c[0] * xi[0]) / 4.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;

    #[test]
    fn shape_functions_are_valid() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 1);
        checks::differences(&NATURAL, shape_functions, gradients);
    }
}
