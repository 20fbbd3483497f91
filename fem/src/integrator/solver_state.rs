//! Solver state in checkpoints, so that resumed runs are identical.

use super::step_control::StepLength;
use crate::assembly::Combination;
use serde::{Deserialize, Serialize};

/// Checkpointed state of an elastoplastic solver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolverState {
    pub(crate) statistics: Statistics,
    /// Next step length, unless prescribed.
    pub(crate) length: Option<StepLength>,
    /// Matrix of the current elastic factor.
    pub(crate) factored: Option<Combination>,
}

impl SolverState {
    /// Counts and times.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }
}

/// Counts and wall times [s].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected and halved steps.
    pub halvings: u64,
    /// Iterations, including rejected steps.
    pub iterations: u64,
    /// Stress evaluations.
    pub evaluations: u64,
    /// Factorisations L L^T.
    pub factorizations_symmetric: u64,
    /// Factorisations L U.
    pub factorizations_unsymmetric: u64,
    /// Indefinite symmetric tangents (L U used).
    pub not_positive: u64,
    /// Singular tangents (elastic matrix used).
    pub singular: u64,
    /// Solves, without those in GMRES.
    pub solves: u64,
    /// GMRES iterations.
    pub krylov_iterations: u64,
    /// GMRES failures (L U used).
    pub krylov_failures: u64,
    /// Stresses, forces and tangents.
    pub assembly_seconds: f64,
    /// Factorisations.
    pub factor_seconds: f64,
    /// Solves.
    pub solve_seconds: f64,
}
