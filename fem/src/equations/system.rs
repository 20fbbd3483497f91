//! The equations `A x = b` of a model on its free dofs, and the trait of all that solves them.

use super::pattern::analyse;
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::mesh::Mesh;
use crate::solver::analysis::Analysis;
use crate::supports::{Supports, name};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Pivot over diagonal below which a dof counts as having no stiffness.
///
/// Rounding leaves 1e-16 to 1e-13 on a mechanism, growing with the mesh; a column a thousand times as high as its elements
/// has 4e-9.
pub(crate) const NO_STIFFNESS: f64 = 1e-11;
/// Iterations on a factor at most.
const ITERATIONS: u32 = 100;

/// `A = k K + m M + d D` of a model on its free dofs, from which a solver is made.
#[derive(Clone, Copy)]
pub struct Equations<'a> {
    /// The mesh, for the order of elimination and for names of nodes.
    pub mesh: &'a Mesh,
    /// K, M and D.
    pub matrices: &'a Arc<Matrices>,
    /// Which dofs are free.
    pub supports: &'a Supports,
    /// k, m and d.
    pub combination: Combination,
    /// Ordering and symbolic factorization of the model, empty until the first factor.
    pub analysis: &'a OnceLock<Arc<Analysis>>,
}

impl Equations<'_> {
    /// The ordering and symbolic factorization, made once for all factors of a model.
    ///
    /// # Errors
    /// Only when memory runs out.
    pub fn analysis(&self) -> Result<Arc<Analysis>, SolveError> {
        if let Some(analysis) = self.analysis.get() {
            return Ok(analysis.clone());
        }
        let analysis = Arc::new(analyse(self.mesh, self.matrices, self.supports)?);
        Ok(self.analysis.get_or_init(|| analysis).clone())
    }

    /// The error that names node and direction of an equation whose pivot [-] is too small against its diagonal.
    pub fn no_stiffness(&self, equation: usize, pivot: f64) -> SolveError {
        let (node, direction) = name(self.mesh, self.supports.free()[equation] as usize);
        SolveError::NoStiffness { node, direction, pivot }
    }
}

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

/// A symmetric matrix `factor C`, positive semidefinite, that is added to the one of a solver and known by its products.
pub struct Added<'a> {
    /// Factor of the products.
    pub factor: f64,
    /// `times(x, y)` sets `y += C x`. Shapes `[3 * nodes]`.
    pub times: &'a mut dyn FnMut(&[f64], &mut [f64]),
    /// Two nodal vectors. Shapes `[3 * nodes]`.
    pub scratch: [&'a mut [f64]; 2],
}

/// A solver of the equations of a model, with its factor or its iteration.
pub trait SystemSolver: Send + Sync {
    /// Solves in place: the right-hand side comes in, the solution goes out. `guess` gives a value near the solution by
    /// dofs; only an iteration looks at it. Shape `[equations]`.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`], [`SolveError::Library`].
    fn solve(
        &mut self,
        supports: &Supports,
        x: &mut [f64],
        guess: &dyn Fn(usize) -> f64,
    ) -> Result<(), SolveError>;

    /// Solves `(A + factor C) x = b` in place, from zero, to a residual of `tolerance` [-], and returns the iterations. Shape
    /// `[equations]`.
    ///
    /// A factor is the preconditioner of conjugate gradients that need no product with the matrix, since `A z = r` where z is the
    /// preconditioned residual r, and as many iterations as C has directions that are stiff against A. Residuals after the last
    /// iteration are accepted.
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

    /// Counts of an iteration so far.
    fn counts(&self) -> Option<Counts> {
        None
    }

    /// Memory beside the model's, of an iteration or of a library [bytes]; that of the program's own factor is known from its
    /// analysis.
    fn memory(&self) -> Option<usize> {
        None
    }
}
