//! The choice of a method for the equations of an elastic model, and all that is known of each: its solver, memory and source.

use super::cholesky::Cholesky;
use super::iteration::{Iteration, block_jacobi_memory};
use super::mumps;
use super::system::{Equations, NO_STIFFNESS, SystemSolver};
use crate::error::SolveError;
use serde::{Deserialize, Serialize};
use std::fmt;

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

/// Which equations are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// The stiffness alone.
    Statics,
    /// Stiffness and mass together: steps in time.
    Dynamics,
}

/// Methods by regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Methods {
    /// For the stiffness alone.
    pub statics: Method,
    /// For stiffness and mass together: steps in time.
    pub dynamics: Method,
}

impl Method {
    /// Residual for steps in time: the energy balance misses the square of it, or what rounding leaves, some 1e-11 of the work.
    pub const WINDOW_TOLERANCE: f64 = 1e-8;

    /// Name of the method in scenes and records.
    pub fn name(self) -> &'static str {
        match self {
            Method::Direct => "direct",
            Method::Iterative { .. } => "iterative",
            Method::Mumps(_) => "mumps",
        }
    }

    /// Sources of the method, for the list of a run.
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

    /// Residual over right-hand side that is left [-]; 0 for a factor, which leaves rounding alone.
    pub(crate) fn tolerance(self) -> f64 {
        if let Method::Iterative { tolerance } = self { tolerance } else { 0.0 }
    }

    /// A solver of the equations; in statics one that finds a lack of stiffness.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`], [`SolveError::Singular`], [`SolveError::Library`], or no memory.
    pub(crate) fn solver(
        self,
        equations: &Equations<'_>,
        regime: Regime,
    ) -> Result<Box<dyn SystemSolver>, SolveError> {
        Ok(match (self, regime) {
            (Method::Direct, Regime::Statics) => Box::new(Cholesky::of_stiffness(equations)?),
            (Method::Direct, Regime::Dynamics) => Box::new(Cholesky::factor(equations)?),
            (Method::Iterative { tolerance }, Regime::Statics) => {
                Box::new(Iteration::aggregation(equations, tolerance)?)
            }
            (Method::Iterative { tolerance }, Regime::Dynamics) => {
                Box::new(Iteration::block_jacobi(equations, tolerance)?)
            }
            (Method::Mumps(method), regime) => {
                let null_pivot = if regime == Regime::Statics { NO_STIFFNESS } else { f64::EPSILON };
                Box::new(mumps::Factor::new(equations, method, null_pivot)?)
            }
        })
    }

    /// Memory that a solver of the equations takes, known before it is made [bytes]. That of conjugate gradients for statics is known from
    /// embankments (2.5 to 2.75 kB a node at 7,500 to 100,000 nodes).
    ///
    /// # Errors
    /// The equations cannot be analysed; [`SolveError::Library`].
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

/// The method in a few words, after "by".
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
