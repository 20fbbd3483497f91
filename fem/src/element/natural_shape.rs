//! Natural shapes of volume elements.

use self::NaturalShape::{Hexahedron, Pyramid, Tetrahedron, Wedge};
use super::quadrature::{GAUSS2, LINE2, PYRAMID8, TET4, VolumePoint, WEDGE6};

/// Natural shape; axes as in the modules of its kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NaturalShape {
    /// Cube.
    Hexahedron,
    /// Triangular prism.
    Wedge,
    /// Square pyramid.
    Pyramid,
    /// Tetrahedron.
    Tetrahedron,
}

const HEXAHEDRON_EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Points below the apex of a pyramid on the uprights 0-4, 1-4, 2-4, 3-4.
const APEX_LIMITS: [[f64; 3]; 4] = {
    const U: f64 = 1e-7;
    [[-U, -U, 1.0 - U], [U, -U, 1.0 - U], [U, U, 1.0 - U], [-U, U, 1.0 - U]]
};

impl NaturalShape {
    /// Corners of each edge, in the order of mid-side nodes.
    pub const fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Hexahedron => &HEXAHEDRON_EDGES,
            Wedge => &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
            Pyramid => &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
            Tetrahedron => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
        }
    }

    /// Natural volume.
    pub const fn volume(self) -> f64 {
        match self {
            Hexahedron => 8.0,
            Wedge => 1.0,
            Pyramid => 4.0 / 3.0,
            Tetrahedron => 1.0 / 6.0,
        }
    }

    /// Centre.
    pub const fn centre(self) -> [f64; 3] {
        const THIRD: f64 = 1.0 / 3.0;
        match self {
            Hexahedron => [0.0; 3],
            Wedge => [THIRD, THIRD, 0.0],
            Pyramid => [0.0, 0.0, 0.25],
            Tetrahedron => [0.25; 3],
        }
    }

    /// Whether a natural point is inside, with tolerance `slack`.
    pub fn contains(self, [r, s, t]: [f64; 3], slack: f64) -> bool {
        let low = -slack;
        match self {
            Hexahedron => [r, s, t].iter().all(|c| c.abs() <= 1.0 + slack),
            Wedge => r >= low && s >= low && r + s <= 1.0 + slack && t.abs() <= 1.0 + slack,
            Pyramid => t >= low && t <= 1.0 + slack && r.abs().max(s.abs()) <= 1.0 - t + slack,
            Tetrahedron => r >= low && s >= low && t >= low && r + s + t <= 1.0 + slack,
        }
    }

    /// Points next to corner `node` if gradients have no limit there: the apex of a pyramid.
    pub(super) fn limits_at_corner(self, node: usize) -> Option<&'static [[f64; 3]]> {
        (self == Pyramid && node == 4).then_some(&APEX_LIMITS)
    }

    /// Points of stress recovery; superconvergent in the hex20 (Barlow 1976).
    pub const fn sampling_rule(self) -> &'static [VolumePoint] {
        match self {
            Hexahedron => &GAUSS2,
            Wedge => &WEDGE6,
            // Not the nodes: stress has no limit at the apex.
            Pyramid => &PYRAMID8,
            Tetrahedron => &TET4,
        }
    }

    /// Weight of point `i` of [`Self::sampling_rule`] at `x`: trilinear (hexahedron), linear (wedge,
    /// tetrahedron), linear least squares (pyramid).
    pub fn extrapolation_weight(self, i: usize, x: [f64; 3]) -> f64 {
        let p = self.sampling_rule()[i].0;
        match self {
            Hexahedron => (0..3).map(|k| 0.5 * (1.0 + x[k] * p[k] / LINE2[1].0.powi(2))).product(),
            Wedge => {
                // Triangle points: 1/6, 1/6, 2/3 in area coordinates.
                let area = |at: [f64; 3]| [1.0 - at[0] - at[1], at[0], at[1]];
                let corner = (0..3).max_by(|a, b| area(p)[*a].total_cmp(&area(p)[*b])).unwrap_or(0);
                (2.0 * area(x)[corner] - 1.0 / 3.0) * 0.5 * (1.0 + x[2] * p[2] / LINE2[1].0.powi(2))
            }
            Pyramid => {
                // Constant, x, y and t - middle are orthogonal on the points.
                let middle = PYRAMID8.iter().map(|p| p.0[2]).sum::<f64>() / 8.0;
                let functions = |at: [f64; 3]| [1.0, at[0], at[1], at[2] - middle];
                let term = |k: usize| {
                    let norm: f64 = PYRAMID8.iter().map(|p| functions(p.0)[k].powi(2)).sum();
                    functions(x)[k] * functions(p)[k] / norm
                };
                (0..4).map(term).sum()
            }
            Tetrahedron => {
                // Points: (5 - √5)/20 and once (5 + 3√5)/20 in volume coordinates.
                let volume = |at: [f64; 3]| [1.0 - at[0] - at[1] - at[2], at[0], at[1], at[2]];
                let corner = (0..4).max_by(|a, b| volume(p)[*a].total_cmp(&volume(p)[*b])).unwrap_or(0);
                let (far, near) = ((5.0 - 5.0_f64.sqrt()) / 20.0, (5.0 + 3.0 * 5.0_f64.sqrt()) / 20.0);
                (volume(x)[corner] - far) / (near - far)
            }
        }
    }

    /// Polynomials at `x` that are fitted to values at integration points.
    pub fn fit_terms(self, [r, s, t]: [f64; 3]) -> Vec<f64> {
        match self {
            Hexahedron => vec![1.0, r, s, t, r * s, s * t, t * r, r * s * t],
            Wedge => vec![1.0, r, s, t, r * t, s * t],
            Pyramid => vec![1.0],
            Tetrahedron => vec![1.0, r, s, t],
        }
    }
}
