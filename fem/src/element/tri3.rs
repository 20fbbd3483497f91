//! 3-node triangle: face of tet4, wedge6 and pyramid5.
//!
//! ```text
//!      2
//!      │\        natural axes: r along 0→1, s along 0→2; r, s >= 0, r + s <= 1
//!      │ \       corners counter-clockwise seen from outside the body,
//!      0──1      so that dx/dr × dx/ds points outward
//! ```
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8.

/// Node count.
pub const TRI3_NODES: usize = 3;

/// Natural node coordinates. Shape `[3][2]`.
pub const NATURAL: [[f64; 2]; TRI3_NODES] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Shape functions (area coordinates) at the natural point `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; TRI3_NODES] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}

/// Derivatives by (r, s), constant. Shape `[3][2]`.
#[inline]
pub fn gradients(_xi: [f64; 2]) -> [[f64; 2]; TRI3_NODES] {
    [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]
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
