//! Solvers of sparse equations, independent of mesh and material.
pub mod analysis;
pub mod conjugate;
mod dense;
mod front;
pub mod gmres;
pub(crate) mod kernels;
pub mod multifrontal;
pub mod mumps;
mod pattern;
mod solution;
mod structure;

use thiserror::Error;

/// Analysis errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum AnalysisError {
    /// Factor not addressable, or out of memory.
    #[error("not enough memory for the factorization of {equations} equations")]
    Memory {
        /// Equation count.
        equations: usize,
    },
    /// Invalid pattern or elimination order.
    #[error("invalid matrix pattern: {what}")]
    Pattern {
        /// Reason.
        what: &'static str,
    },
}

/// Pivot that stopped a factorisation.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("singular matrix: pivot of equation {equation} is {ratio:.3e} of its scale")]
pub struct PivotError {
    /// Equation of the pattern.
    pub equation: usize,
    /// Pivot over diagonal (symmetric) or largest column entry (unsymmetric); 0 if unknown.
    pub ratio: f64,
}
