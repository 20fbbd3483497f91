//! Equations `A x = b` on the free dofs, solved by conjugate gradients.

use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::iterative::aggregation::{self, Aggregation};
use crate::iterative::block_jacobi::BlockJacobi;
use crate::iterative::product::Product;
use crate::mesh::Mesh;
use crate::solver::conjugate::{ConjugateGradients, Operator, Preconditioner};
use crate::supports::{Supports, name};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Iterations at most. The window matrix takes tens.
const LIMIT: u32 = 2000;

/// Counts of an iterative solver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Systems solved.
    pub solves: u64,
    /// Iterations of all.
    pub iterations: u64,
    /// Iterations of the one that took most.
    pub most: u32,
}

/// A matrix, its preconditioner and work space; [`Iteration::solve`] allocates nothing.
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
    /// `A = stiffness K + mass M + dashpots D`, preconditioned by the inverse blocks of the nodes.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names a node without stiffness and mass in some direction.
    pub fn block_jacobi(
        mesh: &Mesh,
        matrices: Arc<Matrices>,
        supports: &Supports,
        combination: Combination,
        tolerance: f64,
    ) -> Result<Iteration<BlockJacobi>, SolveError> {
        let matrix = Product::new(matrices, supports, combination);
        let preconditioner = jacobi(mesh, &matrix)?;
        Ok(Iteration::new(matrix, preconditioner, 3 * mesh.node_count(), tolerance))
    }
}

impl Iteration<Aggregation> {
    /// The stiffness, preconditioned by smoothed aggregation.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names a node without stiffness in some direction, [`SolveError::Singular`] says that a larger
    /// part of the body has none.
    pub fn aggregation(
        mesh: &Mesh,
        matrices: &Arc<Matrices>,
        supports: &Supports,
        tolerance: f64,
    ) -> Result<Iteration<Aggregation>, SolveError> {
        let stiffness = Combination { stiffness: 1.0, ..Combination::default() };
        let matrix = Product::new(matrices.clone(), supports, stiffness);
        // Near the inverse is near enough for a preconditioner.
        let rounded = Product::rounded(matrices.clone(), supports, stiffness);
        let jacobi = jacobi(mesh, &matrix)?;
        let preconditioner = Aggregation::new(rounded, &jacobi, &mesh.coordinates)
            .map_err(|aggregation::NotPositive| SolveError::Singular)?;
        Ok(Iteration::new(matrix, preconditioner, 3 * mesh.node_count(), tolerance))
    }

    /// Rows of each level of the aggregation, from the finest on.
    pub fn levels(&self) -> Vec<usize> {
        self.preconditioner.sizes()
    }
}

fn jacobi(mesh: &Mesh, matrix: &Product) -> Result<BlockJacobi, SolveError> {
    BlockJacobi::new(&matrix.diagonal_blocks()).map_err(|dof| {
        let (node, direction) = name(mesh, dof);
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

impl<P: Preconditioner> Iteration<P> {
    fn new(matrix: Product, preconditioner: P, values: usize, tolerance: f64) -> Iteration<P> {
        let gradients = ConjugateGradients::new(values, LIMIT);
        let (load, solution) = (vec![0.0; values], vec![0.0; values]);
        let counts = Counts::default();
        Iteration { matrix, preconditioner, gradients, tolerance, load, solution, counts }
    }

    /// Memory beside the model's [bytes].
    pub fn memory(&self) -> usize {
        let vectors = 16 * self.load.len() + self.gradients.memory();
        self.matrix.memory() + self.preconditioner.memory() + vectors
    }

    /// Counts so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Solves in place, from a guess by dofs. Shape `[equations]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`].
    pub fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: impl Fn(usize) -> f64,
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

    /// Solves `(A + factor C) x = b` in place, from zero, with other matrices C added: `add(x, y)` sets `y += C x`, C symmetric and not
    /// negative. Returns the iterations. Shapes `[equations]`, of `add` `[3 * nodes]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`].
    pub fn solve_with(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        factor: f64,
        add: impl FnMut(&[f64], &mut [f64]),
        tolerance: f64,
    ) -> Result<u32, SolveError> {
        let Iteration { matrix, preconditioner, gradients, load, solution, .. } = self;
        supports.scatter(x, load);
        solution.fill(0.0);
        let added = vec![0.0; load.len()];
        let mut sum = Sum { matrix, factor, add, added, supports };
        let iterations = gradients
            .solve(&mut sum, preconditioner, load, solution, tolerance)
            .map_err(|stopped| SolveError::NotConverged { stopped, tolerance })?;
        supports.gather(solution, x);
        Ok(iterations)
    }
}

/// A matrix and a multiple of another.
struct Sum<'a, F> {
    matrix: &'a mut Product,
    factor: f64,
    add: F,
    added: Vec<f64>,
    supports: &'a Supports,
}

impl<F: FnMut(&[f64], &mut [f64])> Operator for Sum<'_, F> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        self.matrix.apply(x, y);
        self.added.fill(0.0);
        (self.add)(x, &mut self.added);
        for d in self.supports.free().iter().map(|&d| d as usize) {
            y[d] += self.factor * self.added[d];
        }
    }
}
