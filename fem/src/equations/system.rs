//! The equations of an elastic model, by whatever method.

use super::cholesky::Cholesky;
use super::iteration::{Counts, Iteration};
use crate::error::SolveError;
use crate::iterative::aggregation::Aggregation;
use crate::iterative::block_jacobi::BlockJacobi;
use crate::solver::LinearSolver;
use crate::supports::Supports;

/// Equations `A x = b` on the free dofs, ready to solve.
pub enum Equations {
    /// A factor.
    Direct(Box<Cholesky>),
    /// Conjugate gradients with the inverse blocks of the nodes.
    BlockJacobi(Box<Iteration<BlockJacobi>>),
    /// Conjugate gradients with smoothed aggregation.
    Aggregation(Box<Iteration<Aggregation>>),
}

impl Equations {
    /// Solves in place: the right-hand side comes in, the solution goes out. `guess` gives a value near the solution by
    /// dofs; only an iteration looks at it. Shape `[equations]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`].
    pub fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: impl Fn(usize) -> f64,
    ) -> Result<(), SolveError> {
        match self {
            Equations::Direct(factor) => {
                factor.solve_in_place(x);
                Ok(())
            }
            Equations::BlockJacobi(iteration) => iteration.solve(supports, x, guess),
            Equations::Aggregation(iteration) => iteration.solve(supports, x, guess),
        }
    }

    /// Counts of an iteration so far.
    pub fn counts(&self) -> Option<Counts> {
        match self {
            Equations::Direct(_) => None,
            Equations::BlockJacobi(iteration) => Some(iteration.counts()),
            Equations::Aggregation(iteration) => Some(iteration.counts()),
        }
    }

    /// Memory of an iteration beside the model's [bytes].
    pub fn iteration_memory(&self) -> Option<usize> {
        match self {
            Equations::Direct(_) => None,
            Equations::BlockJacobi(iteration) => Some(iteration.memory()),
            Equations::Aggregation(iteration) => Some(iteration.memory()),
        }
    }
}
