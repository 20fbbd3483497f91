//! 13-node pyramid: connects hex20 or wedge15 to tet10.
//!
//! ```text
//!              4             natural axes: x along 0→1, y along 1→2, t from the base to the apex;
//!             /│\\           |x|, |y| <= 1 - t, 0 <= t <= 1
//!            / │ \ 11        base 0 1 2 3 (t = 0), counter-clockwise seen from the apex;
//!           / 12  \  \       apex 4 (0, 0, 1)
//!          9  │   10  \      mid-sides 5 6 7 8 of the base (0-1, 1-2, 2-3, 3-0),
//!         /   3──7─\───2     9 10 11 12 of the uprights (0-4, 1-4, 2-4, 3-4)
//!        /  8       \ 6
//!       0─────5──────1
//! ```
//!
//! With `u = 1 - t`, `p = x / u`, `q = y / u` (section coordinates, in [-1, 1]):
//! corner `N = u (x_a x + y_a y - 1)(1 + x_a p)(1 + y_a q) / 4`, apex `N = t (2 t - 1)`,
//! mid-side of the base along x `N = u² (1 - p²)(1 + y_a q) / 2` (along y: p and q exchanged),
//! mid-side of an upright `N = t u (1 + x_a p)(1 + y_a q)` (signs of its corner).
//!
//! Source: Bedrosian, Int. J. Numer. Methods Eng. 35 (1992) 95-108.
//! Limits: gradients at the apex depend on direction. Closer than `1 - t` = 1e-10 the limit along the axis
//! (p = q = 0) is used, exact for quadratic fields.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::{PYRAMID18, PYRAMID27};

/// Node count.
pub const NODES: usize = 13;

/// Natural node coordinates. Shape `[13][3]`.
pub const NATURAL: [[f64; 3]; NODES] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [-0.5, -0.5, 0.5],
    [0.5, -0.5, 0.5],
    [0.5, 0.5, 0.5],
    [-0.5, 0.5, 0.5],
];

/// Face nodes: corners counter-clockwise from outside, then mid-sides. Base ([`super::quad8`]), then sides
/// 0-1, 1-2, 2-3, 3-0 ([`super::tri6`]).
pub const FACES: [&[usize]; 5] = [
    &[0, 3, 2, 1, 8, 7, 6, 5],
    &[0, 1, 4, 5, 10, 9],
    &[1, 2, 4, 6, 11, 10],
    &[2, 3, 4, 7, 12, 11],
    &[3, 0, 4, 8, 9, 12],
];

/// Height `u = 1 - t` that counts as the apex.
const APEX: f64 = 1e-10;

/// Returns (u, p, q).
#[inline]
pub(super) fn section(xi: [f64; 3]) -> (f64, f64, f64) {
    let u = 1.0 - xi[2];
    if u.abs() < APEX { (u, 0.0, 0.0) } else { (u, xi[0] / u, xi[1] / u) }
}

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Pyramid,
    stiffness_rules: [&PYRAMID18, &PYRAMID18, &PYRAMID27],
    mass_rule: &PYRAMID27,
    constant_stress: false,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Pointwise,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let (u, p, q) = section(xi);
    let t = xi[2];
    let mut n = [0.0; NODES];
    for (i, c) in NATURAL[..4].iter().enumerate() {
        let (a, b) = (c[0] * p, c[1] * q);
        let bilinear = u * (1.0 + a) * (1.0 + b);
        n[i] = (u * (a + b) - 1.0) * bilinear / 4.0;
        n[9 + i] = t * bilinear;
    }
    n[4] = t * (2.0 * t - 1.0);
    for i in [5, 7] {
        n[i] = u * u * (1.0 - p * p) * (1.0 + NATURAL[i][1] * q) / 2.0;
        n[i + 1] = u * u * (1.0 - q * q) * (1.0 + NATURAL[i + 1][0] * p) / 2.0;
    }
    n
}

/// Derivatives by (x, y, t); at the apex the limit along the axis. Shape `[13][3]`.
///
/// Chain rule: `F,x = F,p / u`, `F,y = F,q / u`, `F,t = p F,x + q F,y - F,u`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let (u, p, q) = section(xi);
    let t = xi[2];
    let chain = |x: f64, y: f64, fu: f64| [x, y, p * x + q * y - fu];
    let mut d = [[0.0; 3]; NODES];
    for (i, c) in NATURAL[..4].iter().enumerate() {
        let (a, b) = (1.0 + c[0] * p, 1.0 + c[1] * q);
        let g = u * (a + b - 2.0) - 1.0;
        d[i] =
            chain(c[0] * b * (u * a + g) / 4.0, c[1] * a * (u * b + g) / 4.0, a * b * (2.0 * g + 1.0) / 4.0);
        d[9 + i] = chain(t * c[0] * b, t * c[1] * a, (1.0 - 2.0 * u) * a * b);
    }
    d[4] = [0.0, 0.0, 4.0 * t - 1.0];
    for i in [5, 7] {
        let (c, b) = (NATURAL[i][1], 1.0 + NATURAL[i][1] * q);
        let bubble = u * (1.0 - p * p);
        d[i] = chain(-u * p * b, bubble * c / 2.0, bubble * b);
        let (c, a) = (NATURAL[i + 1][0], 1.0 + NATURAL[i + 1][0] * p);
        let bubble = u * (1.0 - q * q);
        d[i + 1] = chain(bubble * c / 2.0, -u * q * a, bubble * a);
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apex_gradients_are_exact_for_quadratics() {
        let apex = gradients([0.0, 0.0, 1.0]);
        for (at_apex, below) in apex.iter().zip(gradients([0.0, 0.0, 1.0 - 1e-8])) {
            assert!((0..3).all(|k| (at_apex[k] - below[k]).abs() < 1e-7));
        }
        let field = |f: &dyn Fn([f64; 3]) -> f64, exact: [f64; 3]| {
            for k in 0..3 {
                let d: f64 = apex.iter().zip(NATURAL).map(|(d, x)| d[k] * f(x)).sum();
                assert!((d - exact[k]).abs() < 1e-14, "axis {k}: {d} for {}", exact[k]);
            }
        };
        field(&|x| x[0] * x[1], [0.0, 0.0, 0.0]);
        field(&|x| x[0] * x[2], [1.0, 0.0, 0.0]);
        field(&|x| x[2] * x[2], [0.0, 0.0, 2.0]);
    }
}
