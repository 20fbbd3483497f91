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
    #[error("there is not enough memory to factor {equations} equations")]
    Memory {
        /// Number of equations.
        equations: usize,
    },
    /// The pattern or the order of elimination is not as described.
    #[error("the pattern of the matrix cannot be used: {what}")]
    Pattern {
        /// What is wrong with it.
        what: &'static str,
    },
}

/// A pivot that ended a factorization.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the pivot of equation {equation} is {ratio:.3e} of its scale: the matrix cannot be factored")]
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
    #[error("this program was built without MUMPS; `cargo build --release --features mumps` builds it in")]
    Missing,
    /// No memory.
    #[error("MUMPS found no memory for the factor")]
    Memory,
    /// More memory is needed than the analysis expected.
    #[error("MUMPS needs far more memory for the factor than it expected")]
    Room,
    /// Files of a factor out of core.
    #[error(
        "MUMPS cannot write or read the files of the factor in the folder for temporary files (variable TMPDIR, at most 255 bytes)"
    )]
    Files,
    /// A pivot near zero.
    #[error("MUMPS found no pivot for equation {equation}: the matrix cannot be factored")]
    Pivot {
        /// The equation, from 0.
        equation: usize,
    },
    /// Negative pivots.
    #[error("MUMPS found {pivots} negative pivots: the matrix is not positive definite")]
    NotPositive {
        /// How many.
        pivots: u32,
    },
    /// Another error, by the numbers of MUMPS's manual.
    #[error("MUMPS stopped with INFOG(1) = {code}, INFOG(2) = {detail}")]
    Code {
        /// INFOG(1).
        code: i32,
        /// INFOG(2).
        detail: i32,
    },
}
