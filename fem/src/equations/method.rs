//! Solution methods for the linear equations of an elastic model.

use super::cholesky::Cholesky;
use super::mumps;
use super::pcg::{PcgSystem, block_jacobi_memory};
use super::system::{Equations, NO_STIFFNESS, SystemSolver};
use crate::error::SolveError;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Solution method for a constant matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Cholesky factor.
    #[default]
    Direct,
    /// Conjugate gradients.
    Iterative {
        /// Relative residual [-] as in [`crate::solver::conjugate`], close to the energy-norm error.
        tolerance: f64,
    },
    /// Factor by MUMPS; requires the feature `mumps`.
    Mumps(MumpsMethod),
}

/// Options of MUMPS.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MumpsMethod {
    /// Whether the factor is stored in temporary files.
    pub out_of_core: bool,
}

/// Type of equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// Stiffness only.
    Statics,
    /// Stiffness and mass: time steps.
    Dynamics,
}

/// Methods by regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Methods {
    /// For stiffness only.
    pub statics: Method,
    /// For time steps.
    pub dynamics: Method,
}

impl Method {
    /// Residual tolerance of time steps; its square, or rounding (about 1e-11 of the work), is the energy
    /// error.
    pub const WINDOW_TOLERANCE: f64 = 1e-8;

    /// Name in scenes and records.
    pub fn name(self) -> &'static str {
        match self {
            Method::Direct => "direct",
            Method::Iterative { .. } => "iterative",
            Method::Mumps(_) => "mumps",
        }
    }

    /// References of the method.
    pub fn source(self, regime: Regime) -> &'static str {
        match (self, regime) {
            (Method::Direct, _) => {
                "sparse factorization: multifrontal (Duff & Reid 1983) over dense kernels of the crate faer, nested dissection by \
                 coordinates (George 1973)"
            }
            (Method::Iterative { .. }, Regime::Statics) => {
                "static equations: conjugate gradients with smoothed aggregation, Vaněk, Mandel & Brezina 1996"
            }
            (Method::Iterative { .. }, Regime::Dynamics) => {
                "equations of steps: conjugate gradients with inverse nodal blocks, Saad 2003"
            }
            (Method::Mumps(_), _) => {
                "sparse factorization: the library MUMPS, Amestoy, Duff, L'Excellent & Koster, SIAM J. Matrix Anal. Appl. 23, 2001; \
                 nested dissection by coordinates (George 1973)"
            }
        }
    }

    /// Stiffness products of a static solve, if iterative: about 60 iterations of 12, mostly single precision, and set-up.
    pub fn statics_products(self) -> Option<f64> {
        matches!(self, Method::Iterative { .. }).then_some(560.0)
    }

    /// Whether it runs on one thread only.
    pub fn is_serial(self) -> bool {
        matches!(self, Method::Mumps(_))
    }

    pub(crate) fn tolerance(self) -> f64 {
        if let Method::Iterative { tolerance } = self { tolerance } else { 0.0 }
    }

    /// Solver; in statics it detects missing stiffness.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`], [`SolveError::Singular`], [`SolveError::Library`], or out of memory.
    pub(crate) fn solver(
        self,
        equations: &Equations<'_>,
        regime: Regime,
    ) -> Result<Box<dyn SystemSolver>, SolveError> {
        Ok(match (self, regime) {
            (Method::Direct, Regime::Statics) => Box::new(Cholesky::of_stiffness(equations)?),
            (Method::Direct, Regime::Dynamics) => Box::new(Cholesky::factor(equations)?),
            (Method::Iterative { tolerance }, Regime::Statics) => {
                Box::new(PcgSystem::aggregation(equations, tolerance)?)
            }
            (Method::Iterative { tolerance }, Regime::Dynamics) => {
                Box::new(PcgSystem::block_jacobi(equations, tolerance)?)
            }
            (Method::Mumps(method), regime) => {
                let null_pivot = if regime == Regime::Statics { NO_STIFFNESS } else { f64::EPSILON };
                Box::new(mumps::Factor::new(equations, method, null_pivot)?)
            }
        })
    }

    /// Predicted memory [bytes].
    ///
    /// # Errors
    /// Failed analysis; [`SolveError::Library`].
    pub(crate) fn memory(self, equations: &Equations<'_>, regime: Regime) -> Result<usize, SolveError> {
        Ok(match (self, regime) {
            (Method::Direct, _) => equations.analysis()?.memory(true),
            (Method::Iterative { .. }, Regime::Statics) => 2750 * equations.mesh.node_count(),
            (Method::Iterative { .. }, Regime::Dynamics) => {
                block_jacobi_memory(equations.matrices.clone(), equations.supports)
            }
            (Method::Mumps(method), _) => mumps::demand(equations, method)?,
        })
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Method::Direct => write!(f, "direct solver"),
            Method::Iterative { tolerance } => write!(f, "conjugate gradients, tolerance {tolerance:e}"),
            Method::Mumps(MumpsMethod { out_of_core }) => {
                write!(f, "MUMPS{}", if *out_of_core { " in files" } else { "" })
            }
        }
    }
}
