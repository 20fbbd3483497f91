//! A symmetric matrix factored by MUMPS (`L D Lᵀ`), a library of its own, in the order that is given; out of core where that
//! is asked for.
//!
//! Only with the feature `mumps`; without it every function returns [`MumpsError::Missing`]. MUMPS keeps a state that all its
//! instances share, so that calls from several threads wait for each other; it uses as many threads as it was built for. It has no say in the order of sums of the BLAS that it is linked with, so that
//! bits are those of one machine, one library and one number of its threads.
//!
//! Source: Amestoy, Duff, L'Excellent and Koster, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41. Limits: matrices that are not positive definite are refused; fewer than
//! 2^31 equations. Compression of blocks (ICNTL(35)) is left out: MUMPS 5.5.1 with SCOTCH 7.0.3, as Debian 12 has them, reads memory
//! that was never set while it groups the equations for it, and ends the program.

#[cfg(feature = "mumps")]
mod library;

#[cfg(feature = "mumps")]
pub use library::{Factor, demand};
#[cfg(not(feature = "mumps"))]
pub use without::{Factor, demand};

use thiserror::Error;

/// Whether the program was built with the library.
pub const BUILT_IN: bool = cfg!(feature = "mumps");

/// A symmetric matrix by coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Rows of the entries, from 1, of one triangle. Shape `[entries]`.
    pub row: Vec<i32>,
    /// Their columns, from 1. Shape `[entries]`.
    pub column: Vec<i32>,
    /// Their values; entries at the same place are added. Shape `[entries]`.
    pub value: Vec<f64>,
    /// When each equation is to be eliminated, from 1. Shape `[equations]`.
    pub place: Vec<i32>,
}

/// How a matrix is factored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Whether the factor goes to files, in the folder for temporary files of the process.
    pub out_of_core: bool,
    /// Size at which a pivot counts as zero.
    pub null_pivot: f64,
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

/// In place of the library.
#[cfg(not(feature = "mumps"))]
mod without {
    use super::{Coordinates, MumpsError, Settings};

    /// A factor that is never made.
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
