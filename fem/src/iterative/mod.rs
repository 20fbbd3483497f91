//! Preconditioned conjugate gradients for `A = k K + m M + d D` of large solids.
//!
//! [`block_jacobi`] suits window matrices with lumped mass, of condition about `1 + (c dt / h)^2` (c wave
//! speed, h element size); [`aggregation`] suits the stiffness. Vectors are nodal, shape `[3 * nodes]`, 0 at
//! constrained dofs. Fixed ranges of nodes make results bitwise independent of the number of threads.
//!
//! Source: Saad (2003), algorithm 9.1.

pub mod aggregation;
pub mod block_jacobi;
pub mod matrix_product;
mod upper_blocks;
