//! 6-node triangle: face of tet10, wedge15 and pyramid13.
//!
//! ```text
//!      2
//!      │\          natural axes: r along 0→1, s along 0→2; r, s >= 0, r + s <= 1
//!      5  4        corners counter-clockwise seen from outside the body,
//!      │    \      so that dx/dr × dx/ds points outward;
//!      0──3──1     mid-sides 3 (0-1), 4 (1-2), 5 (2-0)
//! ```
//!
//! With the area coordinates `L = (1 - r - s, r, s)`: corner `N = L (2 L - 1)`, mid-side `N = 4 L_i L_j`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8.

use super::tri3;

/// Node count.
pub const TRI6_NODES: usize = 6;

/// Natural node coordinates. Shape `[6][2]`.
pub const NATURAL: [[f64; 2]; TRI6_NODES] =
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// Shape functions at `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; TRI6_NODES] {
    let l = tri3::shape_functions(xi);
    let mut n = [0.0; TRI6_NODES];
    for i in 0..3 {
        n[i] = l[i] * (2.0 * l[i] - 1.0);
        n[3 + i] = 4.0 * l[i] * l[(i + 1) % 3];
    }
    n
}

/// Derivatives by (r, s). Shape `[6][2]`.
#[inline]
pub fn gradients(xi: [f64; 2]) -> [[f64; 2]; TRI6_NODES] {
    let (l, dl) = (tri3::shape_functions(xi), tri3::gradients(xi));
    let mut d = [[0.0; 2]; TRI6_NODES];
    for i in 0..3 {
        let j = (i + 1) % 3;
        for k in 0..2 {
            d[i][k] = (4.0 * l[i] - 1.0) * dl[i][k];
            d[3 + i][k] = 4.0 * (dl[i][k] * l[j] + l[i] * dl[j][k]);
        }
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::checks;

    #[test]
    fn shape_functions_are_valid() {
        checks::nodal(&NATURAL, shape_functions);
        checks::complete(&NATURAL, shape_functions, 2);
        checks::differences(&NATURAL, shape_functions, gradients);
        checks::mid_sides(&NATURAL, 3, &[(0, 1), (1, 2), (2, 0)]);
    }
}
