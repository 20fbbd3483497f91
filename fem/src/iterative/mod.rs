//! Preconditioned conjugate gradients for `A = k K + m M + d D` of large solids.
//!
//! [`block_jacobi`] suits window matrices with lumped mass, of condition about `1 + (c dt / h)^2` (c wave
//! speed, h element size); [`aggregation`] suits the stiffness.
//!
//! Source: Saad (2003), algorithm 9.1.

pub mod aggregation;
pub mod block_jacobi;
pub mod matrix_product;
mod upper_blocks;
