//! The equations of an elastic model, by whatever method.

use super::cholesky::Cholesky;
use super::iteration::{Counts, Iteration};
use super::method::MumpsMethod;
#[cfg(feature = "mumps")]
use super::mumps;
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::iterative::aggregation::Aggregation;
use crate::iterative::block_jacobi::BlockJacobi;
use crate::mesh::Mesh;
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
    /// A factor of the library MUMPS.
    #[cfg(feature = "mumps")]
    Mumps(Box<mumps::Factor>),
}

impl Equations {
    /// The equations of a combination of a model's matrices by the library MUMPS; pivots below `null_pivot` of their diagonal count as
    /// zero.
    ///
    /// # Errors
    /// [`crate::solver::MumpsError::Missing`] in a program that was built without it; else [`SolveError::NoStiffness`],
    /// [`SolveError::Singular`], or what the library lacks.
    pub fn by_mumps(
        mesh: &Mesh,
        matrices: &Matrices,
        supports: &Supports,
        combination: Combination,
        method: MumpsMethod,
        null_pivot: f64,
    ) -> Result<Equations, SolveError> {
        #[cfg(feature = "mumps")]
        {
            let factor = mumps::Factor::new(mesh, matrices, supports, combination, method, null_pivot)?;
            Ok(Equations::Mumps(Box::new(factor)))
        }
        #[cfg(not(feature = "mumps"))]
        {
            let _ = (mesh, matrices, supports, combination, method, null_pivot);
            Err(crate::solver::MumpsError::Missing.into())
        }
    }

    /// Solves in place: the right-hand side comes in, the solution goes out. `guess` gives a value near the solution by
    /// dofs; only an iteration looks at it. Shape `[equations]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`], [`SolveError::Mumps`].
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
            #[cfg(feature = "mumps")]
            Equations::Mumps(factor) => Ok(factor.solve_in_place(x)?),
        }
    }

    /// Counts of an iteration so far.
    pub fn counts(&self) -> Option<Counts> {
        match self {
            Equations::Direct(_) => None,
            Equations::BlockJacobi(iteration) => Some(iteration.counts()),
            Equations::Aggregation(iteration) => Some(iteration.counts()),
            #[cfg(feature = "mumps")]
            Equations::Mumps(_) => None,
        }
    }

    /// Memory beside the model's, of an iteration or of MUMPS [bytes]; that of the program's own factor is known from its analysis.
    pub fn memory(&self) -> Option<usize> {
        match self {
            Equations::Direct(_) => None,
            Equations::BlockJacobi(iteration) => Some(iteration.memory()),
            Equations::Aggregation(iteration) => Some(iteration.memory()),
            #[cfg(feature = "mumps")]
            Equations::Mumps(factor) => Some(factor.memory()),
        }
    }
}

/// Memory that MUMPS expects to take for equations with the pattern of the stiffness [bytes].
///
/// # Errors
/// [`crate::solver::MumpsError::Missing`] in a program that was built without it; else what the library lacks.
pub fn mumps_memory(
    mesh: &Mesh,
    matrices: &Matrices,
    supports: &Supports,
    method: MumpsMethod,
) -> Result<usize, SolveError> {
    #[cfg(feature = "mumps")]
    {
        mumps::demand(mesh, matrices, supports, method)
    }
    #[cfg(not(feature = "mumps"))]
    {
        let _ = (mesh, matrices, supports, method);
        Err(crate::solver::MumpsError::Missing.into())
    }
}
