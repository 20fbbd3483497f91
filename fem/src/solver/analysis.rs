//! Ordering, pattern and symbolic factorisation of an equation system.
//!
//! Source: supernodes from faer (sparse::linalg::cholesky::supernodal, relaxed amalgamation) on a postordered
//! elimination tree. Limits: fewer than 2^31 entries.

use super::AnalysisError;
use super::pattern::{MIRRORED, UpperPattern, postorder};
use super::structure::Structure;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};

/// Amalgamation limits: columns and fraction of zeros.
const AMALGAMATION: [(usize, f64); 4] = [(4, 1.0), (16, 0.8), (48, 0.1), (usize::MAX, 0.05)];

/// Symbolic factorisation.
#[derive(Debug)]
pub struct Analysis {
    column_start: Vec<usize>,
    row: Vec<usize>,
    /// Elimination position → equation.
    pub(super) order: Vec<usize>,
    structure: Structure,
}

impl Analysis {
    /// Analyses a structurally symmetric matrix.
    ///
    /// * `column_start` `[equations + 1]`, `row` `[entries]`: lower columns, ascending from the stored
    ///   diagonal.
    /// * `order` `[equations]`: elimination order, possibly postordered.
    ///
    /// # Errors
    /// [`AnalysisError::Pattern`] if the input is invalid, [`AnalysisError::Memory`] if the factor cannot be
    /// addressed.
    pub fn from_pattern(
        column_start: Vec<usize>,
        row: Vec<usize>,
        mut order: Vec<usize>,
    ) -> Result<Analysis, AnalysisError> {
        check(&column_start, &row, &order)?;
        let equations = order.len();
        let memory = || AnalysisError::Memory { equations };
        if row.len() >= MIRRORED as usize || equations >= MIRRORED as usize {
            return Err(memory());
        }
        let mut upper = UpperPattern::new(&column_start, &row, &positions(&order));
        let post = postorder(&upper.elimination_tree());
        if post.iter().enumerate().any(|(i, &p)| i != p as usize) {
            order = post.iter().map(|&p| order[p as usize]).collect();
            upper = UpperPattern::new(&column_start, &row, &positions(&order));
        }
        let symbolic = supernodes(&upper, equations).ok_or_else(memory)?;
        let count = symbolic.n_supernodes();
        let mut begin: Vec<u32> = symbolic.supernode_begin().iter().map(|&b| b as u32).collect();
        begin.push(equations as u32);
        let (mut rows_start, mut rows) = (vec![0], Vec::with_capacity(symbolic.row_idx().len()));
        for s in 0..count {
            rows.extend(symbolic.supernode(s).pattern().iter().map(|&r| r as u32));
            rows_start.push(rows.len());
        }
        drop(symbolic);
        let structure = Structure::new(begin, rows_start, rows, &upper);
        Ok(Analysis { column_start, row, order, structure })
    }

    /// Equation count.
    pub fn size(&self) -> usize {
        self.order.len()
    }

    /// Values in a symmetric factor.
    pub fn factor_len(&self) -> usize {
        self.structure.panel[self.structure.count()]
    }

    /// Flops of a symmetric factorisation; twice as many if unsymmetric.
    pub fn flops(&self) -> f64 {
        self.structure.flops
    }

    /// Column starts `[equations + 1]` and rows `[entries]` of the lower triangle.
    pub fn pattern(&self) -> (&[usize], &[usize]) {
        (&self.column_start, &self.row)
    }

    /// Elimination order of the equations.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Peak memory [bytes] of a [`super::multifrontal::DirectSolver`] (`symmetric`: L L^T, else L U) with
    /// single solves; each thread adds a few per cent.
    pub fn memory(&self, symmetric: bool) -> usize {
        let structure = &self.structure;
        let triangles = if symmetric { 1 } else { 2 };
        let threads = structure.most_tasks().min(rayon::current_num_threads());
        let places = structure.work_len + structure.exported_len + threads * structure.branch_len;
        let second = if symmetric { 0 } else { structure.second[structure.count()] };
        let rows = if symmetric { 0 } else { 4 * self.size() };
        let scratch = 28 * (threads * structure.branch_width + structure.max_width);
        let vectors = self.size() + structure.rows.len();
        8 * (self.factor_len() + second + triangles * places + vectors) + rows + scratch
    }

    pub(super) fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.row.len()
    }

    pub(super) fn equation(&self, position: usize) -> usize {
        self.order[position]
    }

    /// Largest entry of each unsymmetric column; 1 for zero columns.
    pub(super) fn column_scale(&self, lower: &[f64], upper: &[f64]) -> Vec<f64> {
        let mut scale = vec![0.0_f64; self.size()];
        for c in 0..self.size() {
            for k in self.column_start[c]..self.column_start[c + 1] {
                let r = self.row[k];
                scale[c] = scale[c].max(lower[k].abs());
                if r != c {
                    scale[r] = scale[r].max(upper[k].abs());
                }
            }
        }
        scale.iter_mut().filter(|s| **s == 0.0).for_each(|s| *s = 1.0);
        scale
    }
}

fn check(column_start: &[usize], row: &[usize], order: &[usize]) -> Result<(), AnalysisError> {
    let n = order.len();
    let wrong = |what| Err(AnalysisError::Pattern { what });
    if column_start.len() != n + 1 || column_start[0] != 0 || column_start[n] != row.len() {
        return wrong("the column starts do not span the rows");
    }
    for c in 0..n {
        let (first, end) = (column_start[c], column_start[c + 1]);
        if first >= end || end > row.len() || row[first] != c {
            return wrong("a column does not begin with its diagonal");
        }
        if row[end - 1] >= n || row[first..end].windows(2).any(|pair| pair[0] >= pair[1]) {
            return wrong("the rows of a column do not ascend");
        }
    }
    let mut seen = vec![false; n];
    if order.iter().any(|&e| e >= n || std::mem::replace(&mut seen[e], true)) {
        return wrong("the order is not a permutation of the equations");
    }
    Ok(())
}

fn positions(order: &[usize]) -> Vec<u32> {
    let mut position = vec![0; order.len()];
    for (i, &e) in order.iter().enumerate() {
        position[e] = i as u32;
    }
    position
}

fn supernodes(upper: &UpperPattern, n: usize) -> Option<SymbolicSupernodalCholesky<usize>> {
    let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &upper.start, None, &upper.row);
    let need = StackReq::or(
        prefactorize_symbolic_cholesky_scratch::<usize>(n, upper.row.len()),
        factorize_supernodal_symbolic_cholesky_scratch::<usize>(n),
    );
    let mut memory = MemBuffer::try_new(need).ok()?;
    let stack = MemStack::new(&mut memory);
    let (mut tree, mut counts) = (vec![0_isize; n], vec![0; n]);
    let tree = prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, stack);
    let params = SymbolicSupernodalParams { relax: Some(&AMALGAMATION) };
    factorize_supernodal_symbolic_cholesky(pattern, tree, &counts, stack, params).ok()
}
