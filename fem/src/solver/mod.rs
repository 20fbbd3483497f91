//! Solvers of sparse equations. This module knows matrices alone, no mesh and no material; the equations of a model are
//! made in [`crate::equations`].
//!
//! [`analysis`] finds the structure of the factor, [`multifrontal`] factors and solves, symmetric or not, and [`gmres`]
//! solves with a matrix near a factored one; [`conjugate`] needs products alone; [`mumps`] binds a library that factors, too.
pub mod analysis;
pub mod conjugate;
mod dense;
mod front;
pub mod gmres;
mod kernels;
pub mod multifrontal;
pub mod mumps;
mod pattern;
mod solution;
mod structure;

use thiserror::Error;

/// Why a matrix cannot be analysed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum AnalysisError {
    /// The factor cannot be addressed, or there is no memory for its structure.
    #[error("not enough memory for the factorization of {equations} equations")]
    Memory {
        /// Number of equations.
        equations: usize,
    },
    /// The pattern or the order of elimination is not as described.
    #[error("invalid matrix pattern: {what}")]
    Pattern {
        /// What is wrong with it.
        what: &'static str,
    },
}

/// A pivot that ended a factorization.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("singular matrix: pivot of equation {equation} is {ratio:.3e} of its scale")]
pub struct PivotError {
    /// The equation, numbered as in the pattern.
    pub equation: usize,
    /// The pivot over the diagonal (symmetric) or over the largest entry of its column (unsymmetric); 0 when the
    /// factorization could not tell more than that it is not usable.
    pub ratio: f64,
}
