//! Solvers of sparse equations. This module knows matrices alone, no mesh and no material; the equations of a model are
//! made in [`crate::equations`].
//!
//! [`analysis`] finds the structure of the factor, [`multifrontal`] factors and solves, symmetric or not, and [`gmres`]
//! solves with a matrix near a factored one; [`conjugate`] needs products alone. With the feature `mumps`, the library of that name
//! factors, too.
pub mod analysis;
pub mod conjugate;
mod dense;
mod front;
pub mod gmres;
mod kernels;
pub mod multifrontal;
#[cfg(feature = "mumps")]
pub mod mumps;
mod pattern;
mod solution;
mod structure;

use thiserror::Error;

/// A direct solver: numbers in, factor kept, many right-hand sides.
pub trait LinearSolver {
    /// Number of equations.
    fn size(&self) -> usize;

    /// Solves in place: the right-hand side comes in, the solution goes out. Shape `[equations]`.
    fn solve_in_place(&mut self, x: &mut [f64]);
}

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

/// Why MUMPS has not factored or solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MumpsError {
    /// The program was built without it.
    #[error("built without MUMPS; build with `cargo build --release --features mumps`")]
    Missing,
    /// No memory.
    #[error("MUMPS: out of memory for the factorization")]
    Memory,
    /// More memory is needed than the analysis expected.
    #[error("MUMPS: the factorization needs far more memory than estimated")]
    Room,
    /// Files of a factor out of core.
    #[error("MUMPS: I/O error in the temporary directory (variable TMPDIR, at most 255 bytes)")]
    Files,
    /// A pivot near zero.
    #[error("MUMPS: singular matrix, zero pivot in equation {equation}")]
    Pivot {
        /// The equation, from 0.
        equation: usize,
    },
    /// Negative pivots.
    #[error("MUMPS: matrix not positive definite, {pivots} negative pivots")]
    NotPositive {
        /// How many.
        pivots: u32,
    },
    /// Another error, by the numbers of MUMPS's manual.
    #[error("MUMPS: error INFOG(1) = {code}, INFOG(2) = {detail}")]
    Code {
        /// INFOG(1).
        code: i32,
        /// INFOG(2).
        detail: i32,
    },
}
