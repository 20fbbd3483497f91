//! The incompatible modes of the hex8, with which it bends without parasitic shear.
//!
//! Three displacements that vanish at the nodes, quadratic along one natural axis each, give the strain nine more terms.
//! Their gradients are taken with the Jacobian of the middle and scaled so that they vanish in the mean; the patch test is
//! then passed by elements of any shape. Their amplitudes are those that leave elastic energy least, `α = A u`, which
//! makes the element that of the enhanced assumed strain (nine terms) as long as it is elastic. A material that yields keeps the
//! same A, worked out for constant volume; no amplitude has to be remembered, and the volume strain stays constant in the element.
//!
//! Source: Taylor, Beresford and Wilson, Int. J. Numer. Methods Eng. 10 (1976) 1211-1219; Simo and Rifai, Int. J. Numer. Methods
//! Eng. 29 (1990) 1595-1638. Limits: trapezoidal elements stay stiff in bending (MacNeal, Finite Elements in Analysis and Design 3
//! (1987) 175-181); an elastic part of a body whose material yields bends as one of Poisson's ratio 1/2 within each element.
//!
//! Theory manual: equation (4.4) of `docs/theory/solid.md`.

use crate::kinematics::ElementCoordinates;
use nalgebra::SMatrix;

/// Nodes of the element.
const NODES: usize = 8;
/// Incompatible displacements.
pub const COUNT: usize = 3;
/// Nodes and incompatible displacements.
pub const HEX8_TERMS: usize = NODES + COUNT;

/// Blocks of the amplitudes: `α_m = sum_a A[m][a] u_a`, row by row.
pub type Amplitudes = [[[f64; 9]; NODES]; COUNT];

/// The modes of one element.
#[derive(Clone, Debug)]
pub struct Internal {
    /// Rows of the inverse Jacobian of the middle times its determinant [m²]: direction of the gradient of each mode.
    direction: [[f64; 3]; 3],
    pub(super) amplitudes: Amplitudes,
}

impl Internal {
    pub(super) fn new(coordinates: &ElementCoordinates) -> Internal {
        let centre = crate::element::hex8::gradients([0.0; 3]);
        let mut j = [[0.0; 3]; 3];
        for (x, d) in coordinates.iter().zip(&centre) {
            for i in 0..3 {
                for k in 0..3 {
                    j[i][k] += x[i] * d[k];
                }
            }
        }
        // Row m of the adjugate: the cross product of the other two columns of J.
        let direction = std::array::from_fn(|m| {
            let (p, q) = ((m + 1) % 3, (m + 2) % 3);
            std::array::from_fn(|i| {
                let (r, s) = ((i + 1) % 3, (i + 2) % 3);
                j[r][p] * j[s][q] - j[s][p] * j[r][q]
            })
        });
        Internal { direction, amplitudes: [[[0.0; 9]; NODES]; COUNT] }
    }

    /// The blocks of the amplitudes.
    pub fn amplitudes(&self) -> &Amplitudes {
        &self.amplitudes
    }

    /// Puts the gradients of the modes at the natural point `xi` after those of the nodes.
    pub(super) fn add_gradients(&self, xi: [f64; 3], determinant: f64, gradients: &mut ElementCoordinates) {
        for m in 0..COUNT {
            gradients[NODES + m] = self.direction[m].map(|d| xi[m] * d / determinant);
        }
    }

    /// Puts the amplitudes [m] after the displacements of the nodes.
    pub fn extend(&self, u: &mut ElementCoordinates) {
        extend(&self.amplitudes, u);
    }
}

/// Puts the amplitudes [m] after the displacements of the nodes.
#[inline]
pub fn extend(amplitudes: &Amplitudes, u: &mut ElementCoordinates) {
    for (m, of_mode) in amplitudes.iter().enumerate() {
        let mut sum = [0.0; 3];
        for (block, u) in of_mode.iter().zip(&*u) {
            for i in 0..3 {
                sum[i] += block[3 * i] * u[0] + block[3 * i + 1] * u[1] + block[3 * i + 2] * u[2];
            }
        }
        u[NODES + m] = sum;
    }
}

/// Adds the forces on the amplitudes, which stand after those on the nodes, to the nodes: the transposed of [`extend`].
#[inline]
pub fn condense(amplitudes: &Amplitudes, force: &mut ElementCoordinates) {
    for (m, of_mode) in amplitudes.iter().enumerate() {
        let f = force[NODES + m];
        for (block, force) in of_mode.iter().zip(force.iter_mut()) {
            for j in 0..3 {
                force[j] += block[j] * f[0] + block[3 + j] * f[1] + block[6 + j] * f[2];
            }
        }
    }
}

/// Amplitudes of the least energy, from the blocks of the stiffness: `A = -K_αα^-1 K_αu`.
pub(super) fn amplitudes(block: impl Fn(usize, usize) -> [f64; 9]) -> Amplitudes {
    let mut own = SMatrix::<f64, 9, 9>::zeros();
    let mut with_nodes = SMatrix::<f64, 9, 24>::zeros();
    for m in 0..COUNT {
        for b in 0..HEX8_TERMS {
            let k = block(NODES + m, b);
            for (i, k) in k.into_iter().enumerate() {
                let row = 3 * m + i / 3;
                if b < NODES {
                    with_nodes[(row, 3 * b + i % 3)] = k;
                } else {
                    own[(row, 3 * (b - NODES) + i % 3)] = k;
                }
            }
        }
    }
    let mut amplitudes = [[[0.0; 9]; NODES]; COUNT];
    // Positive definite in every element with a volume: no amplitude is without strain.
    if let Some(factor) = own.cholesky() {
        let solved = factor.solve(&with_nodes);
        for (m, of_mode) in amplitudes.iter_mut().enumerate() {
            for (a, block) in of_mode.iter_mut().enumerate() {
                for (i, value) in block.iter_mut().enumerate() {
                    *value = -solved[(3 * m + i / 3, 3 * a + i % 3)];
                }
            }
        }
    }
    amplitudes
}
