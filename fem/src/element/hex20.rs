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

/// Node count.
pub const HEX20_NODES: usize = 20;

/// Face nodes (0-based), by SOLID186 face number minus one: corners counter-clockwise from outside, then
/// mid-sides.
///
/// SOLID186 faces: 1 J-I-L-K, 2 I-J-N-M, 3 J-K-O-N, 4 K-L-P-O, 5 L-I-M-P, 6 M-N-O-P.
pub const FACE_NODES: [[usize; 8]; 6] = [
    [1, 0, 3, 2, 8, 11, 10, 9],
    [0, 1, 5, 4, 8, 17, 12, 16],
    [1, 2, 6, 5, 9, 18, 13, 17],
    [2, 3, 7, 6, 10, 19, 14, 18],
    [3, 0, 4, 7, 11, 16, 15, 19],
    [4, 5, 6, 7, 12, 13, 14, 15],
];

/// Natural node coordinates, in SOLID186 order. Shape `[20][3]`.
pub const NATURAL: [[f64; 3]; HEX20_NODES] = [
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

#[inline]
fn side_axis(node: usize) -> usize {
    match node {
        16.. => 2,
        n => n % 2,
    }
}

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; HEX20_NODES] {
    let mut n = [0.0; HEX20_NODES];
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
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; HEX20_NODES] {
    let mut d = [[0.0; 3]; HEX20_NODES];
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

#[cfg(test)]
mod tests {
    use super::*;

    /// V0.1: a wrong axis order keeps the sum at one.
    #[test]
    fn shape_functions_are_nodal() {
        for (b, &xi) in NATURAL.iter().enumerate() {
            for (a, value) in shape_functions(xi).into_iter().enumerate() {
                let expected = if a == b { 1.0 } else { 0.0 };
                assert!((value - expected).abs() < 1e-14, "N{a} at node {b} is {value}");
            }
        }
    }

    #[test]
    fn mid_side_nodes_bisect_sides() {
        let sides =
            [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)];
        for (m, (a, b)) in sides.into_iter().enumerate() {
            for k in 0..3 {
                assert_eq!(NATURAL[8 + m][k], (NATURAL[a][k] + NATURAL[b][k]) / 2.0);
            }
        }
    }

    #[test]
    fn gradients_match_central_differences() {
        let (xi, h) = ([0.31, -0.72, 0.55], 1e-5);
        let exact = gradients(xi);
        for k in 0..3 {
            let (mut up, mut down) = (xi, xi);
            up[k] += h;
            down[k] -= h;
            let (up, down) = (shape_functions(up), shape_functions(down));
            for a in 0..HEX20_NODES {
                let difference = (up[a] - down[a]) / (2.0 * h);
                assert!((difference - exact[a][k]).abs() < 1e-9, "node {a} axis {k}");
            }
        }
    }
}
