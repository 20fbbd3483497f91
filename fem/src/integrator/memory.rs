//! What a solver remembers from step to step beside the state of the body: with both of them a run goes on as if it had not
//! been stopped, in its results and in its counts.

use super::step_control::StepLength;
use crate::assembly::Combination;
use serde::{Deserialize, Serialize};

/// Memory of a solver of an elastoplastic body; part of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Counts and times so far.
    pub(crate) statistics: Statistics,
    /// Length of the next step and when it may grow; none where the steps are given.
    pub(crate) length: Option<StepLength>,
    /// The matrix that the elastic factor at hand is of.
    pub(crate) factored: Option<Combination>,
}

impl Memory {
    /// Counts and times so far.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }
}

/// Counts and times of a run. Seconds are those of the clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Steps accepted.
    pub steps: u64,
    /// Steps given up and repeated with half the length.
    pub halvings: u64,
    /// Iterations, those of steps given up included.
    pub iterations: u64,
    /// Evaluations of the stresses.
    pub evaluations: u64,
    /// Factorizations L L^T.
    pub factorizations_symmetric: u64,
    /// Factorizations L U.
    pub factorizations_unsymmetric: u64,
    /// Symmetric tangents that were not positive definite, and taken by L U.
    pub not_positive: u64,
    /// Tangents that L U failed on, and the elastic matrix replaced.
    pub singular: u64,
    /// Solves with a factor, those within GMRES not counted.
    pub solves: u64,
    /// Iterations of GMRES.
    pub krylov_iterations: u64,
    /// Systems that GMRES did not solve well enough, and L U took over.
    pub krylov_failures: u64,
    /// Seconds of stresses, internal forces and tangents.
    pub assembly_seconds: f64,
    /// Seconds of factorizations.
    pub factor_seconds: f64,
    /// Seconds of solves.
    pub solve_seconds: f64,
}
