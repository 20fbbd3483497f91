//! 8-node serendipity quadrilateral: face of the hex20.
//!
//! ```text
//!      3────6────2        natural axes: xi along 0→1, eta along 1→2
//!      7         5        corners counter-clockwise seen from outside the body,
//!      0────4────1        so that dx/dxi × dx/deta points outward
//! ```
//!
//! Node order as in [`crate::mesh::Face`].
//! Source: Zienkiewicz and Taylor (2000), vol. 1, section 8.5.

/// Node count.
pub const QUAD8_NODES: usize = 8;

/// Natural node coordinates. Shape `[8][2]`.
pub const NATURAL: [[f64; 2]; QUAD8_NODES] =
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];

/// Shape functions at `xi`.
#[inline]
pub fn shape_functions(xi: [f64; 2]) -> [f64; QUAD8_NODES] {
    let mut n = [0.0; QUAD8_NODES];
    for (a, c) in NATURAL.iter().enumerate() {
        let (s, t) = (c[0] * xi[0], c[1] * xi[1]);
        n[a] = match a {
            0..4 => (1.0 + s) * (1.0 + t) * (s + t - 1.0) / 4.0,
            4 | 6 => (1.0 - xi[0] * xi[0]) * (1.0 + t) / 2.0,
            _ => (1.0 + s) * (1.0 - xi[1] * xi[1]) / 2.0,
        };
    }
    n
}

/// First derivatives of the shape functions by (xi, eta). Shape `[8][2]`.
#[inline]
pub fn gradients(xi: [f64; 2]) -> [[f64; 2]; QUAD8_NODES] {
    let mut d = [[0.0; 2]; QUAD8_NODES];
    for (a, c) in NATURAL.iter().enumerate() {
        let (s, t) = (c[0] * xi[0], c[1] * xi[1]);
        d[a] = match a {
            0..4 => [c[0] * (1.0 + t) * (2.0 * s + t) / 4.0, c[1] * (1.0 + s) * (s + 2.0 * t) / 4.0],
            4 | 6 => [-xi[0] * (1.0 + t), (1.0 - xi[0] * xi[0]) * c[1] / 2.0],
            _ => [c[0] * (1.0 - xi[1] * xi[1]) / 2.0, -(1.0 + s) * xi[1]],
        };
    }
    d
}

/// Second derivatives (d²/dxi², d²/deta², d²/dxi deta) of the shape functions. Shape `[8][3]`.
#[inline]
pub fn second_gradients(xi: [f64; 2]) -> [[f64; 3]; QUAD8_NODES] {
    let mut d = [[0.0; 3]; QUAD8_NODES];
    for (a, c) in NATURAL.iter().enumerate() {
        let (s, t) = (c[0] * xi[0], c[1] * xi[1]);
        d[a] = match a {
            0..4 => [(1.0 + t) / 2.0, (1.0 + s) / 2.0, c[0] * c[1] * (2.0 * s + 2.0 * t + 1.0) / 4.0],
            4 | 6 => [-(1.0 + t), 0.0, -xi[0] * c[1]],
            _ => [0.0, -(1.0 + s), -c[0] * xi[1]],
        };
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::hex20;

    #[test]
    fn shape_functions_are_nodal() {
        for (b, &xi) in NATURAL.iter().enumerate() {
            for (a, value) in shape_functions(xi).into_iter().enumerate() {
                let expected = if a == b { 1.0 } else { 0.0 };
                assert!((value - expected).abs() < 1e-15, "N{a} at node {b} is {value}");
            }
        }
    }

    #[test]
    fn derivatives_match_central_differences() {
        let (xi, h) = ([0.37, -0.61], 1e-5);
        let (first, second) = (gradients(xi), second_gradients(xi));
        let at = |dx: f64, dy: f64| [xi[0] + dx, xi[1] + dy];
        for a in 0..QUAD8_NODES {
            for k in 0..2 {
                let step = |s: f64| if k == 0 { at(s * h, 0.0) } else { at(0.0, s * h) };
                let n = (shape_functions(step(1.0))[a] - shape_functions(step(-1.0))[a]) / (2.0 * h);
                assert!((n - first[a][k]).abs() < 1e-9, "first, node {a} axis {k}");
                let d = (gradients(step(1.0))[a][k] - gradients(step(-1.0))[a][k]) / (2.0 * h);
                assert!((d - second[a][k]).abs() < 1e-9, "second, node {a} axis {k}");
            }
            let mixed = (gradients(at(0.0, h))[a][0] - gradients(at(0.0, -h))[a][0]) / (2.0 * h);
            assert!((mixed - second[a][2]).abs() < 1e-9, "mixed, node {a}");
        }
    }

    #[test]
    fn faces_of_the_hex20_are_quad8() {
        for nodes in hex20::FACES {
            let xi = [0.23, -0.48];
            let n8 = shape_functions(xi);
            let mut natural = [0.0; 3];
            for (a, &node) in nodes.iter().enumerate() {
                for k in 0..3 {
                    natural[k] += n8[a] * hex20::NATURAL[node][k];
                }
            }
            let n20 = hex20::shape_functions(natural);
            assert!(nodes.iter().enumerate().all(|(a, &node)| (n20[node] - n8[a]).abs() < 1e-15));
        }
    }
}
