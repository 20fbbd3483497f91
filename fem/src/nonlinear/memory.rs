//! What a solver remembers from step to step beside the state of the body: with both of them a run goes on as if it had not
//! been stopped, in its results and in its counts.

use super::newton::Newton;
use super::options::Statistics;
use super::step_control::StepLength;
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::model::Model;
use serde::{Deserialize, Serialize};

/// Memory of a solver of an elastoplastic body; part of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Counts and times so far.
    statistics: Statistics,
    /// Length of the next step and when it may grow; none where the steps are given.
    length: Option<StepLength>,
    /// The matrix that the elastic factor at hand is of.
    factored: Option<Combination>,
}

impl Newton {
    /// The memory of a solver with this iteration.
    pub(super) fn memory(&self, length: Option<StepLength>) -> Memory {
        Memory { statistics: self.statistics, length, factored: self.system.elastic_of() }
    }

    /// Takes a memory over; factors the elastic matrix that was at hand, so that no later count differs.
    ///
    /// # Errors
    /// The matrix cannot be factored.
    pub(super) fn recall(
        &mut self,
        model: &Model,
        memory: &Memory,
        length: Option<&mut StepLength>,
    ) -> Result<(), SolveError> {
        if let Some(combination) = memory.factored {
            self.system.factor_elastic(model, &mut self.tangent, combination, &mut self.statistics)?;
        }
        self.statistics = memory.statistics;
        if let (Some(length), Some(remembered)) = (length, memory.length) {
            *length = remembered;
        }
        Ok(())
    }
}
