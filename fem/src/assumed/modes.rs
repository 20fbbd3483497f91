//! Incompatible modes of the hex8 against parasitic shear in bending.
//!
//! Gradients use the central Jacobian, scaled to zero mean: the patch test is passed by any shape.
//! Amplitudes `α = A u` minimise the elastic energy (enhanced assumed strain, nine terms); yielding
//! materials keep A of constant volume, without state.
//!
//! Source: Taylor, Beresford and Wilson (1976); Simo and Rifai (1990). Limits: trapezoidal elements stay
//! stiff in bending (MacNeal 1987); elastic regions of a yielding material bend as if Poisson's ratio were
//! 1/2.
//!
//! Theory manual: equation (4.4) of `docs/theory/solid.md`.

use crate::kinematics::ElementCoordinates;
use nalgebra::SMatrix;

const NODES: usize = 8;
/// Number of incompatible displacements.
pub const COUNT: usize = 3;
/// Nodes and incompatible displacements.
pub const HEX8_TERMS: usize = NODES + COUNT;

/// Amplitude blocks: `α_m = sum_a A[m][a] u_a`, row-major.
pub type Amplitudes = [[[f64; 9]; NODES]; COUNT];

/// Modes of one element.
#[derive(Clone, Debug)]
pub struct Internal {
    /// Adjugate of the Jacobian at the centre [m²].
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
        let direction = std::array::from_fn(|m| {
            let (p, q) = ((m + 1) % 3, (m + 2) % 3);
            std::array::from_fn(|i| {
                let (r, s) = ((i + 1) % 3, (i + 2) % 3);
                j[r][p] * j[s][q] - j[s][p] * j[r][q]
            })
        });
        Internal { direction, amplitudes: [[[0.0; 9]; NODES]; COUNT] }
    }

    /// Amplitude blocks.
    pub fn amplitudes(&self) -> &Amplitudes {
        &self.amplitudes
    }

    pub(super) fn add_gradients(&self, xi: [f64; 3], determinant: f64, gradients: &mut ElementCoordinates) {
        for m in 0..COUNT {
            gradients[NODES + m] = self.direction[m].map(|d| xi[m] * d / determinant);
        }
    }

    /// Appends the amplitudes [m] to the nodal displacements.
    pub fn extend(&self, u: &mut ElementCoordinates) {
        extend(&self.amplitudes, u);
    }
}

/// Appends the amplitudes [m] to the nodal displacements.
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

/// Distributes the forces on the amplitudes to the nodes: transpose of [`extend`].
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

/// Amplitudes of least energy, `A = -K_αα^-1 K_αu`.
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
    // Positive definite for positive volume.
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
