//! Conjugate gradients for `A x = b` on the free dofs.

use super::system::{Added, Equations, IterationCounts, SystemSolver};
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::iterative::aggregation::{self, Aggregation};
use crate::iterative::block_jacobi::BlockJacobi;
use crate::iterative::matrix_product::MatrixProduct;
use crate::solver::conjugate::{ConjugateGradients, Operator, Preconditioner};
use crate::supports::{Supports, name};
use std::sync::Arc;

/// Iteration limit; window matrices need tens.
const LIMIT: u32 = 2000;

/// Matrix, preconditioner and work space; solves allocate nothing.
pub struct PcgSystem<P> {
    matrix: MatrixProduct,
    preconditioner: P,
    gradients: ConjugateGradients,
    tolerance: f64,
    load: Vec<f64>,
    solution: Vec<f64>,
    counts: IterationCounts,
}

impl PcgSystem<BlockJacobi> {
    /// Builds an iteration with block-Jacobi preconditioner.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] for a node without stiffness and mass.
    pub fn block_jacobi(
        equations: &Equations<'_>,
        tolerance: f64,
    ) -> Result<PcgSystem<BlockJacobi>, SolveError> {
        let Equations { matrices, supports, combination, .. } = *equations;
        let matrix = MatrixProduct::new(matrices.clone(), supports, combination);
        let preconditioner = jacobi(equations, &matrix)?;
        Ok(PcgSystem::new(matrix, preconditioner, 3 * equations.mesh.node_count(), tolerance))
    }
}

impl PcgSystem<Aggregation> {
    /// Builds an iteration with smoothed aggregation, for stiffness-dominated matrices.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] for a node, [`SolveError::Singular`] for a larger part without stiffness.
    pub fn aggregation(
        equations: &Equations<'_>,
        tolerance: f64,
    ) -> Result<PcgSystem<Aggregation>, SolveError> {
        let Equations { matrices, supports, combination, .. } = *equations;
        let matrix = MatrixProduct::new(matrices.clone(), supports, combination);
        // Reduced precision suffices for a preconditioner.
        let rounded = MatrixProduct::rounded(matrices.clone(), supports, combination);
        let jacobi = jacobi(equations, &matrix)?;
        let preconditioner = Aggregation::new(rounded, &jacobi, &equations.mesh.coordinates)
            .map_err(|aggregation::NotPositive| SolveError::Singular)?;
        Ok(PcgSystem::new(matrix, preconditioner, 3 * equations.mesh.node_count(), tolerance))
    }

    /// Rows of each aggregation level, finest first.
    pub fn levels(&self) -> Vec<usize> {
        self.preconditioner.sizes()
    }
}

fn jacobi(equations: &Equations<'_>, matrix: &MatrixProduct) -> Result<BlockJacobi, SolveError> {
    BlockJacobi::new(&matrix.diagonal_blocks()).map_err(|dof| {
        let (node, direction) = name(equations.mesh, dof);
        SolveError::NoStiffness { node, direction, pivot: 0.0 }
    })
}

/// Additional memory of a block-Jacobi iteration [bytes].
pub fn block_jacobi_memory(matrices: Arc<Matrices>, supports: &Supports) -> usize {
    let values = 3 * matrices.node_count();
    let product = MatrixProduct::new(matrices, supports, Combination::default());
    // Product, inverse blocks, six vectors.
    product.memory() + 16 * values + 6 * 8 * values
}

impl<P> PcgSystem<P> {
    fn new(matrix: MatrixProduct, preconditioner: P, values: usize, tolerance: f64) -> PcgSystem<P> {
        let gradients = ConjugateGradients::new(values, LIMIT);
        let (load, solution) = (vec![0.0; values], vec![0.0; values]);
        let counts = IterationCounts::default();
        PcgSystem { matrix, preconditioner, gradients, tolerance, load, solution, counts }
    }
}

impl<P: Preconditioner + Send + Sync> SystemSolver for PcgSystem<P> {
    fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: &dyn Fn(usize) -> f64,
    ) -> Result<(), SolveError> {
        for &d in supports.free() {
            self.solution[d as usize] = guess(d as usize);
        }
        let PcgSystem { matrix, preconditioner, gradients, tolerance, load, solution, counts } = self;
        supports.scatter(x, load);
        let iterations = gradients
            .solve(matrix, preconditioner, load, solution, *tolerance)
            .map_err(|stopped| SolveError::NotConverged { stopped, tolerance: *tolerance })?;
        counts.solves += 1;
        counts.iterations += u64::from(iterations);
        counts.most = counts.most.max(iterations);
        supports.gather(solution, x);
        Ok(())
    }

    fn solve_with(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        added: Added<'_>,
        tolerance: f64,
    ) -> Result<u32, SolveError> {
        let PcgSystem { matrix, preconditioner, gradients, load, solution, .. } = self;
        supports.scatter(x, load);
        solution.fill(0.0);
        let iterations = gradients
            .solve(&mut Sum { matrix, added, supports }, preconditioner, load, solution, tolerance)
            .map_err(|stopped| SolveError::NotConverged { stopped, tolerance })?;
        supports.gather(solution, x);
        Ok(iterations)
    }

    fn counts(&self) -> Option<IterationCounts> {
        Some(self.counts)
    }

    fn memory(&self) -> Option<usize> {
        let vectors = 16 * self.load.len() + self.gradients.memory();
        Some(self.matrix.memory() + self.preconditioner.memory() + vectors)
    }
}

struct Sum<'a, 'b> {
    matrix: &'a mut MatrixProduct,
    added: Added<'b>,
    supports: &'a Supports,
}

impl Operator for Sum<'_, '_> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        self.matrix.apply(x, y);
        let Added { factor, times, scratch: [product, _] } = &mut self.added;
        product.fill(0.0);
        times(x, product);
        for d in self.supports.free().iter().map(|&d| d as usize) {
            y[d] += *factor * product[d];
        }
    }
}
