//! 6-node wedge (triangular prism): corners of the wedge15.
//!
//! ```text
//!          5
//!         /│\            natural axes: r along 0→1, s along 0→2, t along 0→3;
//!        / │ \           r, s >= 0, r + s <= 1, -1 <= t <= 1
//!       3─────4          corners 0 1 2 (t = -1), 3 4 5 (t = +1);
//!       │  2  │          0-1-2 counter-clockwise seen from the top
//!       │ / \ │
//!       0─────1
//! ```
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, chapter 8. Limits: too stiff in bending. Locks near
//! incompressibility in spite of mean dilatation.

use super::natural_shape::NaturalShape;
use super::properties::{Locking, Properties};
use super::quadrature::WEDGE6;
use super::tri3;

/// Node count.
pub const NODES: usize = 6;

/// Natural node coordinates. Shape `[6][3]`.
pub const NATURAL: [[f64; 3]; NODES] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];

/// Face nodes, counter-clockwise from outside: bottom, top ([`super::tri3`]), sides 0-1, 1-2, 2-0
/// ([`super::quad4`]).
pub const FACES: [&[usize]; 5] = [&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];

/// What stiffness, mass and stress of the kind use.
pub const PROPERTIES: Properties = Properties {
    shape: NaturalShape::Wedge,
    stiffness_rules: [&WEDGE6; 3],
    mass_rule: &WEDGE6,
    constant_stress: false,
    linear_dilatation: false,
    incompatible_modes: false,
    locking: Locking::Always,
};

/// Shape functions at `xi`.
pub fn shape_functions(xi: [f64; 3]) -> [f64; NODES] {
    let l = tri3::shape_functions([xi[0], xi[1]]);
    let mut n = [0.0; NODES];
    for i in 0..3 {
        n[i] = l[i] * (1.0 - xi[2]) / 2.0;
        n[3 + i] = l[i] * (1.0 + xi[2]) / 2.0;
    }
    n
}

/// Derivatives by (r, s, t). Shape `[6][3]`.
pub fn gradients(xi: [f64; 3]) -> [[f64; 3]; NODES] {
    let (l, dl) = (tri3::shape_functions([xi[0], xi[1]]), tri3::gradients([xi[0], xi[1]]));
    let mut d = [[0.0; 3]; NODES];
    for i in 0..3 {
        for k in 0..2 {
            d[i][k] = dl[i][k] * (1.0 - xi[2]) / 2.0;
            d[3 + i][k] = dl[i][k] * (1.0 + xi[2]) / 2.0;
        }
        d[i][2] = -l[i] / 2.0;
        d[3 + i][2] = l[i] / 2.0;
    }
    d
}
