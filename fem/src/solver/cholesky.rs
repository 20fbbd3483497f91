//! Supernodal Cholesky factorization `P A P^T = L L^T` of `A = k K + m M + d D` on the free dofs.
//!
//! Ordering and symbolic analysis depend on the mesh and the supports alone ([`Analysis`], made once per model);
//! numbers are factored when k, m, d change ([`Cholesky::factor`]); solves allocate nothing. The dense kernels run with a
//! constant, sequential setting, so the bits are the same on any number of threads.
//!
//! Source: faer, sparse::linalg::cholesky (supernodal left-looking LLT). Limits: A must be positive definite. A pivot of
//! zero or below is reported with its node and direction. A pivot that is only *tiny* does not stop a factorization; its
//! size against the diagonal is kept in [`Cholesky::weakest_pivot`] for the caller to judge.

use crate::assembly::{Combination, Matrices};
use crate::mesh::Mesh;
use crate::solver::ordering::nested_dissection;
use crate::solver::{LinearSolver, SolveError};
use crate::supports::{CONSTRAINED, Supports, name};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::sync::Arc;

/// Ordering, pattern and symbolic factor of the equation system of a model.
#[derive(Debug)]
pub struct Analysis {
    column_start: Vec<usize>,
    row: Vec<usize>,
    /// Elimination position → equation.
    order: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
}

impl Analysis {
    /// Orders and analyses the free dofs.
    ///
    /// # Errors
    /// Only when memory runs out.
    pub fn new(mesh: &Mesh, matrices: &Matrices, supports: &Supports) -> Result<Analysis, SolveError> {
        let equations = supports.free().len();
        let (mut column_start, mut row) = (vec![0; equations + 1], Vec::new());
        matrices.visit_free(supports, |c, r, _, _, _| {
            row.push(r);
            column_start[c + 1] = row.len();
        });
        let index = supports.free_index();
        let order: Vec<usize> = nested_dissection(mesh)
            .iter()
            .flat_map(|&n| (0..3).map(move |k| index[3 * n as usize + k]))
            .filter(|&e| e != CONSTRAINED)
            .map(|e| e as usize)
            .collect();
        let mut position = vec![0; equations];
        for (i, &e) in order.iter().enumerate() {
            position[e] = i;
        }
        let pattern = SymbolicSparseColMatRef::new_checked(equations, equations, &column_start, None, &row);
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &position, equations)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|_| SolveError::Memory { equations })?;
        Ok(Analysis { column_start, row, order, symbolic })
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.order.len()
    }

    /// Number of values that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.symbolic.len_val()
    }
}

/// The smallest pivot of a factor against the diagonal entry of its dof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakestPivot {
    /// Pivot over diagonal [-]; 1 for a diagonal matrix, rounding (1e-16 to 1e-13) for a singular one.
    pub ratio: f64,
    /// The dof, `3 * node + direction`.
    pub dof: usize,
}

/// A factor, ready to solve.
pub struct Cholesky {
    analysis: Arc<Analysis>,
    values: Vec<f64>,
    scratch: MemBuffer,
    weakest: WeakestPivot,
}

impl Cholesky {
    /// Factors `A = stiffness K + mass M + dashpots D` on the free dofs.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names the node and direction of a pivot that is not positive.
    pub fn factor(
        analysis: Arc<Analysis>,
        mesh: &Mesh,
        matrices: &Matrices,
        supports: &Supports,
        combination: Combination,
    ) -> Result<Cholesky, SolveError> {
        let equations = analysis.size();
        let mut a = Vec::with_capacity(analysis.row.len());
        let Combination { stiffness, mass, dashpots } = combination;
        matrices.visit_free(supports, |_, _, k, m, d| a.push(stiffness * k + mass * m + dashpots * d));
        let pattern = SymbolicSparseColMatRef::new_checked(
            equations,
            equations,
            &analysis.column_start,
            None,
            &analysis.row,
        );
        let symbolic = &analysis.symbolic;
        let mut values = vec![0.0; symbolic.len_val()];
        let work = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut work = MemBuffer::try_new(work).map_err(|_| SolveError::Memory { equations })?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(pattern, &a),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut work),
                Default::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| {
                let (node, direction) = name(mesh, supports.free()[analysis.order[index]] as usize);
                SolveError::NoStiffness { node, direction, pivot: 0.0 }
            })?;
        let diagonal = |equation: usize| a[analysis.column_start[equation]];
        let weakest = weakest_pivot(&analysis, &values, diagonal, supports);
        let scratch = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let scratch = MemBuffer::try_new(scratch).map_err(|_| SolveError::Memory { equations })?;
        Ok(Cholesky { analysis, values, scratch, weakest })
    }

    /// The smallest pivot against its diagonal entry; the last dof with ratio 1 when there are no equations.
    pub fn weakest_pivot(&self) -> WeakestPivot {
        self.weakest
    }
}

impl LinearSolver for Cholesky {
    fn size(&self) -> usize {
        self.analysis.size()
    }

    fn solve_in_place(&mut self, x: &mut [f64]) {
        let size = x.len();
        if size == 0 {
            return;
        }
        LltRef::new(&self.analysis.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, size, 1),
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
    }
}

fn weakest_pivot(
    analysis: &Analysis,
    values: &[f64],
    diagonal: impl Fn(usize) -> f64,
    supports: &Supports,
) -> WeakestPivot {
    let mut weakest = WeakestPivot { ratio: 1.0, dof: supports.free().last().map_or(0, |&d| d as usize) };
    // The analysis forces supernodes, so there is no other form to look into.
    if let SymbolicCholeskyRaw::Supernodal(symbolic) = analysis.symbolic.raw() {
        let factor = SupernodalLltRef::new(symbolic, values);
        for s in 0..symbolic.n_supernodes() {
            let (panel, start) = (factor.supernode(s).val(), symbolic.supernode_begin()[s]);
            for j in 0..panel.ncols() {
                let equation = analysis.order[start + j];
                let ratio = panel[(j, j)] * panel[(j, j)] / diagonal(equation);
                if ratio < weakest.ratio {
                    weakest = WeakestPivot { ratio, dof: supports.free()[equation] as usize };
                }
            }
        }
    }
    weakest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quadrature::Quadrature;
    use crate::material::elastic::Elastic;
    use crate::mesh::Constraint;

    fn of(stiffness: f64, mass: f64) -> Combination {
        Combination { stiffness, mass, dashpots: 0.0 }
    }

    fn block() -> (Mesh, Matrices) {
        let mesh = Mesh::block([4, 3, 3], [4.0, 3.0, 3.0]);
        let soil = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
        let matrices = Matrices::assemble(&mesh, Quadrature::Gauss3, |_| &soil);
        (mesh, matrices)
    }

    #[test]
    fn the_solution_meets_the_equations() {
        let (mesh, matrices) = block();
        let constraint = |node| Constraint { node, direction: 1, value: 0.0 };
        let supports = Supports::new(&mesh, &[constraint(7), constraint(50)]).unwrap();
        let analysis = Arc::new(Analysis::new(&mesh, &matrices, &supports).unwrap());
        let mut solver = Cholesky::factor(analysis, &mesh, &matrices, &supports, of(1e-4, 1.0)).unwrap();
        let n = 3 * mesh.node_count();
        let exact: Vec<f64> =
            (0..n).map(|i| if i == 22 || i == 151 { 0.0 } else { (i as f64).cos() }).collect();
        let (mut kx, mut mx) = (vec![0.0; n], vec![0.0; n]);
        matrices.stiffness_times(&exact, &mut kx);
        matrices.mass_times(&exact, &mut mx);
        let b: Vec<f64> = kx.iter().zip(&mx).map(|(k, m)| 1e-4 * k + m).collect();
        let mut x = vec![0.0; solver.size()];
        supports.gather(&b, &mut x);
        solver.solve_in_place(&mut x);
        let mut found = vec![0.0; n];
        supports.scatter(&x, &mut found);
        assert!(found.iter().zip(&exact).all(|(f, e)| (f - e).abs() < 1e-11));
    }

    /// A matrix that is not positive: the message leads back through the ordering to the dof.
    #[test]
    fn a_pivot_that_is_not_positive_is_named() {
        let (mesh, matrices) = block();
        let supports = Supports::new(&mesh, &[]).unwrap();
        let analysis = Arc::new(Analysis::new(&mesh, &matrices, &supports).unwrap());
        let first = supports.free()[analysis.order[0]] as usize;
        let error = Cholesky::factor(analysis, &mesh, &matrices, &supports, of(-1.0, 0.0)).err().unwrap();
        let (node, direction) = name(&mesh, first);
        assert_eq!(error, SolveError::NoStiffness { node, direction, pivot: 0.0 });
    }

    /// A plain dense factorization in the same order finds the same smallest pivot, at the same dof.
    #[test]
    fn the_weakest_pivot_is_found_and_named() {
        let mesh = Mesh::block([1, 1, 2], [1.0, 1.0, 2.0]);
        let soil = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
        let matrices = Matrices::assemble(&mesh, Quadrature::Gauss3, |_| &soil);
        let constraint = Constraint { node: 9, direction: 2, value: 0.0 };
        let supports = Supports::new(&mesh, &[constraint]).unwrap();
        let analysis = Arc::new(Analysis::new(&mesh, &matrices, &supports).unwrap());
        let n = analysis.size();
        let mut position = vec![0; n];
        analysis.order.iter().enumerate().for_each(|(i, &e)| position[e] = i);
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
        let solver = Cholesky::factor(analysis.clone(), &mesh, &matrices, &supports, of(1.0, 1e3)).unwrap();
        let found = solver.weakest_pivot();
        assert!((found.ratio / least.0 - 1.0).abs() < 1e-9, "{found:?} {least:?}");
        assert_eq!(found.dof, supports.free()[analysis.order[least.1]] as usize);
    }

    #[test]
    fn solvers_can_move_between_threads() {
        fn is_send<T: Send>() {}
        is_send::<Cholesky>();
        is_send::<crate::model::Model>();
    }
}
