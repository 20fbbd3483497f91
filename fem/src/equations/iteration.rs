//! Equations `A x = b` on the free dofs, solved by conjugate gradients.

use super::system::{Added, Counts, Equations, SystemSolver};
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::iterative::aggregation::{self, Aggregation};
use crate::iterative::block_jacobi::BlockJacobi;
use crate::iterative::product::Product;
use crate::solver::conjugate::{ConjugateGradients, Operator, Preconditioner};
use crate::supports::{Supports, name};
use std::sync::Arc;

/// Iterations at most. The window matrix takes tens.
const LIMIT: u32 = 2000;

/// A matrix, its preconditioner and work space; [`SystemSolver::solve`] allocates nothing.
pub struct Iteration<P> {
    matrix: Product,
    preconditioner: P,
    gradients: ConjugateGradients,
    tolerance: f64,
    /// Right-hand side and solution. Shapes `[3 * nodes]`.
    load: Vec<f64>,
    solution: Vec<f64>,
    counts: Counts,
}

impl Iteration<BlockJacobi> {
    /// A combination of matrices, preconditioned by the inverse blocks of the nodes.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names a node without stiffness and mass in some direction.
    pub fn block_jacobi(
        equations: &Equations<'_>,
        tolerance: f64,
    ) -> Result<Iteration<BlockJacobi>, SolveError> {
        let Equations { matrices, supports, combination, .. } = *equations;
        let matrix = Product::new(matrices.clone(), supports, combination);
        let preconditioner = jacobi(equations, &matrix)?;
        Ok(Iteration::new(matrix, preconditioner, 3 * equations.mesh.node_count(), tolerance))
    }
}

impl Iteration<Aggregation> {
    /// The stiffness, or another combination without a large mass, preconditioned by smoothed aggregation.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names a node without stiffness in some direction, [`SolveError::Singular`] says that a larger
    /// part of the body has none.
    pub fn aggregation(
        equations: &Equations<'_>,
        tolerance: f64,
    ) -> Result<Iteration<Aggregation>, SolveError> {
        let Equations { matrices, supports, combination, .. } = *equations;
        let matrix = Product::new(matrices.clone(), supports, combination);
        // Near the inverse is near enough for a preconditioner.
        let rounded = Product::rounded(matrices.clone(), supports, combination);
        let jacobi = jacobi(equations, &matrix)?;
        let preconditioner = Aggregation::new(rounded, &jacobi, &equations.mesh.coordinates)
            .map_err(|aggregation::NotPositive| SolveError::Singular)?;
        Ok(Iteration::new(matrix, preconditioner, 3 * equations.mesh.node_count(), tolerance))
    }

    /// Rows of each level of the aggregation, from the finest on.
    pub fn levels(&self) -> Vec<usize> {
        self.preconditioner.sizes()
    }
}

fn jacobi(equations: &Equations<'_>, matrix: &Product) -> Result<BlockJacobi, SolveError> {
    BlockJacobi::new(&matrix.diagonal_blocks()).map_err(|dof| {
        let (node, direction) = name(equations.mesh, dof);
        SolveError::NoStiffness { node, direction, pivot: 0.0 }
    })
}

/// Memory of an iteration with the inverse blocks of the nodes beside that of the model [bytes].
pub fn block_jacobi_memory(matrices: Arc<Matrices>, supports: &Supports) -> usize {
    let values = 3 * matrices.node_count();
    let product = Product::new(matrices, supports, Combination::default());
    // The product, inverse blocks, two vectors of the equations and four of the gradients.
    product.memory() + 16 * values + 6 * 8 * values
}

impl<P> Iteration<P> {
    fn new(matrix: Product, preconditioner: P, values: usize, tolerance: f64) -> Iteration<P> {
        let gradients = ConjugateGradients::new(values, LIMIT);
        let (load, solution) = (vec![0.0; values], vec![0.0; values]);
        let counts = Counts::default();
        Iteration { matrix, preconditioner, gradients, tolerance, load, solution, counts }
    }
}

impl<P: Preconditioner + Send + Sync> SystemSolver for Iteration<P> {
    fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: &dyn Fn(usize) -> f64,
    ) -> Result<(), SolveError> {
        for &d in supports.free() {
            self.solution[d as usize] = guess(d as usize);
        }
        let Iteration { matrix, preconditioner, gradients, tolerance, load, solution, counts } = self;
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
        let Iteration { matrix, preconditioner, gradients, load, solution, .. } = self;
        supports.scatter(x, load);
        solution.fill(0.0);
        let iterations = gradients
            .solve(&mut Sum { matrix, added, supports }, preconditioner, load, solution, tolerance)
            .map_err(|stopped| SolveError::NotConverged { stopped, tolerance })?;
        supports.gather(solution, x);
        Ok(iterations)
    }

    fn counts(&self) -> Option<Counts> {
        Some(self.counts)
    }

    fn memory(&self) -> Option<usize> {
        let vectors = 16 * self.load.len() + self.gradients.memory();
        Some(self.matrix.memory() + self.preconditioner.memory() + vectors)
    }
}

/// A matrix and another that is added.
struct Sum<'a, 'b> {
    matrix: &'a mut Product,
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
