//! Symmetric factorisation `L D Lᵀ` by MUMPS in a given order, optionally out of core.
//!
//! Without the feature `mumps`, every function returns [`MumpsError::Missing`]. Results are bitwise
//! reproducible only for fixed machine, library and thread count.
//!
//! Source: Amestoy, Duff, L'Excellent and Koster (2001). Limits: positive definite matrices, fewer than
//! 2^31 equations. No block compression (ICNTL(35)): MUMPS 5.5.1 with SCOTCH 7.0.3 (Debian 12) reads
//! uninitialised memory in its grouping and crashes.

#[cfg(feature = "mumps")]
mod library;

#[cfg(feature = "mumps")]
pub use library::{Factor, demand};
#[cfg(not(feature = "mumps"))]
pub use without::{Factor, demand};

use thiserror::Error;

/// Whether MUMPS is built in.
pub const BUILT_IN: bool = cfg!(feature = "mumps");

/// Symmetric matrix in coordinate format.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Rows of one triangle, from 1. Shape `[entries]`.
    pub row: Vec<i32>,
    /// Columns, from 1. Shape `[entries]`.
    pub column: Vec<i32>,
    /// Values; duplicates are added. Shape `[entries]`.
    pub value: Vec<f64>,
    /// Elimination position of each equation, from 1. Shape `[equations]`.
    pub place: Vec<i32>,
}

/// Factorisation settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Whether to store the factor in the temporary directory.
    pub out_of_core: bool,
    /// Size of a zero pivot.
    pub null_pivot: f64,
}

/// MUMPS errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MumpsError {
    /// Not built in.
    #[error("built without MUMPS; build with `cargo build --release --features mumps`")]
    Missing,
    /// Out of memory.
    #[error("MUMPS: out of memory for the factorization")]
    Memory,
    /// Far more memory needed than estimated.
    #[error("MUMPS: the factorization needs far more memory than estimated")]
    Room,
    /// I/O error of an out-of-core factor.
    #[error("MUMPS: I/O error in the temporary directory (variable TMPDIR, at most 255 bytes)")]
    Files,
    /// Zero pivot.
    #[error("MUMPS: singular matrix, zero pivot in equation {equation}")]
    Pivot {
        /// Equation, from 0.
        equation: usize,
    },
    /// Negative pivots.
    #[error("MUMPS: matrix not positive definite, {pivots} negative pivots")]
    NotPositive {
        /// Count.
        pivots: u32,
    },
    /// Other errors, as in the MUMPS manual.
    #[error("MUMPS: error INFOG(1) = {code}, INFOG(2) = {detail}")]
    Code {
        /// INFOG(1).
        code: i32,
        /// INFOG(2).
        detail: i32,
    },
}

/// Replacement without the library.
#[cfg(not(feature = "mumps"))]
mod without {
    use super::{Coordinates, MumpsError, Settings};

    /// Uninhabited factor.
    pub enum Factor {}

    impl Factor {
        /// # Errors
        /// [`MumpsError::Missing`].
        pub fn new(_: Coordinates, _: Settings) -> Result<Factor, MumpsError> {
            Err(MumpsError::Missing)
        }

        /// Memory of the factor [bytes].
        pub fn memory(&self) -> usize {
            match *self {}
        }

        /// # Errors
        /// Never called.
        pub fn solve_in_place(&mut self, _: &mut [f64]) -> Result<(), MumpsError> {
            match *self {}
        }
    }

    /// # Errors
    /// [`MumpsError::Missing`].
    pub fn demand(_: Coordinates, _: Settings) -> Result<usize, MumpsError> {
        Err(MumpsError::Missing)
    }
}
