//! Cholesky factorisation `P A P^T = L L^T` of `A = k K + m M + d D` on the free dofs.
//!
//! Solves allocate nothing. Method: [`crate::solver::multifrontal`]. Limits: A must be positive definite;
//! tiny positive pivots are only reported by [`Cholesky::weakest_pivot`].

use super::pattern::values;
use super::system::{Equations, NO_STIFFNESS, SystemSolver};
use crate::error::SolveError;
use crate::solver::multifrontal::DirectSolver;
use crate::supports::Supports;

/// Smallest pivot relative to the diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakestPivot {
    /// Pivot over diagonal [-]; rounding (1e-16 to 1e-13) for a singular matrix.
    pub ratio: f64,
    /// Equation; 0 if there are no equations.
    pub equation: usize,
}

/// Cholesky factor.
pub struct Cholesky {
    solver: DirectSolver,
    weakest: WeakestPivot,
}

impl Cholesky {
    /// Factors a combination of matrices on the free dofs.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] with node and direction of a pivot that is not positive.
    pub fn factor(equations: &Equations<'_>) -> Result<Cholesky, SolveError> {
        let analysis = equations.analysis()?;
        let a = values(&analysis, equations.matrices, equations.supports, equations.combination);
        let mut solver = DirectSolver::new(analysis);
        solver.factor_symmetric(&a).map_err(|pivot| equations.no_stiffness(pivot.equation, pivot.ratio))?;
        let (ratio, equation) = solver.weakest_pivot();
        Ok(Cholesky { solver, weakest: WeakestPivot { ratio, equation } })
    }

    /// Like [`Cholesky::factor`], and requires stiffness at every dof.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] with node and direction of a pivot below 1e-11 of its diagonal.
    pub fn of_stiffness(equations: &Equations<'_>) -> Result<Cholesky, SolveError> {
        let factor = Cholesky::factor(equations)?;
        let WeakestPivot { ratio, equation } = factor.weakest;
        if ratio.is_nan() || ratio < NO_STIFFNESS {
            return Err(equations.no_stiffness(equation, ratio));
        }
        Ok(factor)
    }

    /// Smallest pivot relative to its diagonal entry.
    pub fn weakest_pivot(&self) -> WeakestPivot {
        self.weakest
    }

    /// Solves in place. Shape `[equations]`.
    pub fn solve_in_place(&mut self, x: &mut [f64]) {
        self.solver.solve_in_place(x);
    }
}

impl SystemSolver for Cholesky {
    fn solve(&mut self, _: &Supports, x: &mut [f64], _: &dyn Fn(usize) -> f64) -> Result<(), SolveError> {
        self.solve_in_place(x);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{Combination, Matrices};
    use crate::element::quadrature::Quadrature;
    use crate::material::elastic::Elastic;
    use crate::mesh::{Constraint, Mesh};
    use crate::solver::analysis::Analysis;
    use crate::supports::name;
    use std::sync::{Arc, OnceLock};

    fn factor(
        (mesh, matrices): (&Mesh, &Arc<Matrices>),
        supports: &Supports,
        [stiffness, mass]: [f64; 2],
    ) -> (Result<Cholesky, SolveError>, Arc<Analysis>) {
        let combination = Combination { stiffness, mass, dashpots: 0.0 };
        let analysis = &OnceLock::new();
        let equations = Equations { mesh, matrices, supports, combination, analysis };
        (Cholesky::factor(&equations), equations.analysis().unwrap())
    }

    fn block() -> (Mesh, Arc<Matrices>) {
        let mesh = Mesh::block([4, 3, 3], [4.0, 3.0, 3.0]);
        let soil = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
        let matrices = Matrices::assemble(&mesh, Quadrature::Gauss3, |_| &soil);
        (mesh, Arc::new(matrices))
    }

    #[test]
    fn the_solution_meets_the_equations() {
        let (mesh, matrices) = block();
        let constraint = |node| Constraint { node, direction: 1, value: 0.0 };
        let supports = Supports::new(&mesh, &[constraint(7), constraint(50)]).unwrap();
        let mut solver = factor((&mesh, &matrices), &supports, [1e-4, 1.0]).0.unwrap();
        let n = 3 * mesh.node_count();
        let exact: Vec<f64> =
            (0..n).map(|i| if i == 22 || i == 151 { 0.0 } else { (i as f64).cos() }).collect();
        let (mut kx, mut mx) = (vec![0.0; n], vec![0.0; n]);
        matrices.stiffness_times(&exact, &mut kx);
        matrices.mass_times(&exact, &mut mx);
        let b: Vec<f64> = kx.iter().zip(&mx).map(|(k, m)| 1e-4 * k + m).collect();
        let mut x = vec![0.0; supports.free().len()];
        supports.gather(&b, &mut x);
        solver.solve_in_place(&mut x);
        let mut found = vec![0.0; n];
        supports.scatter(&x, &mut found);
        assert!(found.iter().zip(&exact).all(|(f, e)| (f - e).abs() < 1e-11));
    }

    #[test]
    fn reports_dof_of_nonpositive_pivot() {
        let (mesh, matrices) = block();
        let supports = Supports::new(&mesh, &[]).unwrap();
        let (factor, analysis) = factor((&mesh, &matrices), &supports, [-1.0, 0.0]);
        let first = supports.free()[analysis.order()[0]] as usize;
        let error = factor.err().unwrap();
        let (node, direction) = name(&mesh, first);
        assert_eq!(error, SolveError::NoStiffness { node, direction, pivot: 0.0 });
    }

    #[test]
    fn finds_weakest_pivot() {
        let mesh = Mesh::block([1, 1, 2], [1.0, 1.0, 2.0]);
        let soil = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
        let matrices = Arc::new(Matrices::assemble(&mesh, Quadrature::Gauss3, |_| &soil));
        let constraint = Constraint { node: 9, direction: 2, value: 0.0 };
        let supports = Supports::new(&mesh, &[constraint]).unwrap();
        let (solver, analysis) = factor((&mesh, &matrices), &supports, [1.0, 1e3]);
        let n = analysis.size();
        let mut position = vec![0; n];
        analysis.order().iter().enumerate().for_each(|(i, &e)| position[e] = i);
        let mut a = vec![vec![0.0; n]; n];
        matrices.visit_free(&supports, |c, r, k, m, _| {
            let (c, r) = (position[c], position[r]);
            a[c][r] = k + 1e3 * m;
            a[r][c] = a[c][r];
        });
        let diagonal: Vec<f64> = (0..n).map(|i| a[i][i]).collect();
        let mut least = (f64::INFINITY, 0);
        for p in 0..n {
            if a[p][p] / diagonal[p] < least.0 {
                least = (a[p][p] / diagonal[p], p);
            }
            for r in p + 1..n {
                let factor = a[r][p] / a[p][p];
                for c in p + 1..n {
                    a[r][c] -= factor * a[p][c];
                }
            }
        }
        let found = solver.unwrap().weakest_pivot();
        assert!((found.ratio / least.0 - 1.0).abs() < 1e-9, "{found:?} {least:?}");
        assert_eq!(found.equation, analysis.order()[least.1]);
    }

    #[test]
    fn solvers_can_move_between_threads() {
        fn is_send<T: Send>() {}
        is_send::<Cholesky>();
        is_send::<crate::model::Model>();
    }
}
