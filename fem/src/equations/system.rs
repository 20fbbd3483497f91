//! Equations `A x = b` on the free dofs, and the trait of their solvers.

use super::pattern::analyse;
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::mesh::Mesh;
use crate::solver::analysis::Analysis;
use crate::supports::{Supports, name};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Relative pivot without stiffness.
///
/// Rounding leaves 1e-16 to 1e-13 on a mechanism; a slender column has 4e-9.
pub(crate) const NO_STIFFNESS: f64 = 1e-11;
const ITERATIONS: u32 = 100;

/// `A = k K + m M + d D` on the free dofs of a model.
#[derive(Clone, Copy)]
pub struct Equations<'a> {
    /// Mesh, for ordering and node names.
    pub mesh: &'a Mesh,
    /// K, M and D.
    pub matrices: &'a Arc<Matrices>,
    /// Constrained dofs.
    pub supports: &'a Supports,
    /// k, m and d.
    pub combination: Combination,
    /// Symbolic factorisation, set once.
    pub analysis: &'a OnceLock<Arc<Analysis>>,
}

impl Equations<'_> {
    /// Symbolic factorisation, shared by all factors of a model.
    ///
    /// # Errors
    /// Out of memory.
    pub fn analysis(&self) -> Result<Arc<Analysis>, SolveError> {
        if let Some(analysis) = self.analysis.get() {
            return Ok(analysis.clone());
        }
        let analysis = Arc::new(analyse(self.mesh, self.matrices, self.supports)?);
        Ok(self.analysis.get_or_init(|| analysis).clone())
    }

    /// Error with node and direction of a weak pivot [-].
    pub fn no_stiffness(&self, equation: usize, pivot: f64) -> SolveError {
        let (node, direction) = name(self.mesh, self.supports.free()[equation] as usize);
        SolveError::NoStiffness { node, direction, pivot }
    }
}

/// Counts of an iterative solver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct IterationCounts {
    /// Systems solved.
    pub solves: u64,
    /// Total iterations.
    pub iterations: u64,
    /// Most iterations of a solve.
    pub most: u32,
}

/// Positive semidefinite matrix `factor C`, added to a solver's and given by its products.
pub struct Added<'a> {
    /// Factor of the products.
    pub factor: f64,
    /// `times(x, y)` sets `y += C x`. Shapes `[3 * nodes]`.
    pub times: &'a mut dyn FnMut(&[f64], &mut [f64]),
    /// Work vectors. Shapes `[3 * nodes]`.
    pub scratch: [&'a mut [f64]; 2],
}

/// Solver of the equations of a model.
pub trait SystemSolver: Send + Sync {
    /// Solves in place. `guess` gives nodal start values for iterative solvers. Shape `[equations]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`], [`SolveError::Library`].
    fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: &dyn Fn(usize) -> f64,
    ) -> Result<(), SolveError>;

    /// Solves `(A + factor C) x = b` in place from zero to `tolerance` [-]; returns the iterations. Shape
    /// `[equations]`.
    ///
    /// With a factor as CG preconditioner, no product with A is needed.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`] of an iteration without a factor, [`SolveError::Library`].
    fn solve_with(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        added: Added<'_>,
        tolerance: f64,
    ) -> Result<u32, SolveError> {
        let (size, Added { factor, times, scratch: [work, product] }) = (x.len(), added);
        let mut r = x.to_vec();
        x.fill(0.0);
        let (mut z, mut p, mut ap, mut q) =
            (vec![0.0; size], vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (mut last, mut first, mut iterations) = (0.0, 0.0, 0);
        while iterations < ITERATIONS {
            z.copy_from_slice(&r);
            self.solve(supports, &mut z, &|_| 0.0)?;
            let rz = dot(&r, &z);
            if iterations == 0 {
                first = rz;
            }
            if rz <= tolerance * tolerance * first {
                break;
            }
            let beta = if iterations == 0 { 0.0 } else { rz / last };
            for i in 0..size {
                p[i] = z[i] + beta * p[i];
                ap[i] = r[i] + beta * ap[i];
            }
            work.fill(0.0);
            supports.scatter(&p, work);
            product.fill(0.0);
            times(work, product);
            supports.gather(product, &mut q);
            (0..size).for_each(|i| q[i] = ap[i] + factor * q[i]);
            let alpha = rz / dot(&p, &q);
            for i in 0..size {
                x[i] += alpha * p[i];
                r[i] -= alpha * q[i];
            }
            last = rz;
            iterations += 1;
        }
        Ok(iterations)
    }

    /// Counts of an iterative solver.
    fn counts(&self) -> Option<IterationCounts> {
        None
    }

    /// Memory of an iteration or a library [bytes].
    fn memory(&self) -> Option<usize> {
        None
    }
}
