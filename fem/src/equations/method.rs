//! The choice of a method for the equations of an elastic model.

use serde::{Deserialize, Serialize};

/// How linear equations with a constant matrix are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// A factor that is kept.
    #[default]
    Direct,
    /// Conjugate gradients.
    Iterative {
        /// Residual over right-hand side at which a solution counts as found [-], both measured as
        /// [`crate::solver::conjugate`] says: near the error in energy over the energy of the solution, as a root.
        tolerance: f64,
    },
    /// A factor that the library MUMPS makes and keeps; only in programs that are built with the feature `mumps`.
    Mumps(MumpsMethod),
}

/// How MUMPS factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MumpsMethod {
    /// Whether the factor lies in files, in the folder for temporary files.
    pub out_of_core: bool,
}

impl Method {
    /// Residual for steps in time: the account of energy misses the square of it, or what rounding leaves, some 1e-11 of the work.
    pub const WINDOW_TOLERANCE: f64 = 1e-8;
}

/// Methods by kind of matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Methods {
    /// For the stiffness alone.
    pub statics: Method,
    /// For stiffness and mass together: steps in time.
    pub dynamics: Method,
}
