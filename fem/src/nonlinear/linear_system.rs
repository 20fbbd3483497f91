//! The equation systems of an iteration: a kept factor of the elastic matrix, and the factor of the tangent.
//!
//! A symmetric tangent takes L L^T; if a pivot is not positive (softening), that is counted and L U takes over. An
//! unsymmetric one takes L U. Should that fail too, the iteration falls back on the elastic matrix, which is counted as well.

use super::newton::{LinearMethod, Statistics};
use super::tangent::{LinearPart, Tangent};
use crate::model::Model;
use crate::solver::analysis::Analysis;
use crate::solver::multifrontal::DirectSolver;
use crate::solver::{LinearSolver, SolveError};
use crate::supports::name;
use std::sync::Arc;
use std::time::Instant;

/// Free dofs above which `Auto` solves unsymmetric systems by iteration.
const DIRECT_LIMIT: usize = 30_000;
/// Pivot over diagonal below which a dof counts as having no stiffness, as in statics.
const NO_STIFFNESS: f64 = 1e-11;

/// The matrix of the next solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Matrix {
    Elastic,
    Tangent,
}

/// Factors of one model and their buffers.
pub(crate) struct LinearSystem {
    analysis: Arc<Analysis>,
    elastic: DirectSolver,
    elastic_of: Option<LinearPart>,
    tangent: Option<DirectSolver>,
    tangent_ready: bool,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl LinearSystem {
    pub fn new(model: &Model) -> Result<LinearSystem, SolveError> {
        let analysis = model.analysis()?;
        let entries = analysis.pattern().1.len();
        let unsymmetric = if model.symmetric_tangent() { 0 } else { entries };
        Ok(LinearSystem {
            elastic: DirectSolver::new(analysis.clone()),
            elastic_of: None,
            tangent: None,
            tangent_ready: false,
            lower: vec![0.0; entries],
            upper: vec![0.0; unsymmetric],
            analysis,
        })
    }

    /// Factors the elastic matrix, unless it is at hand. Leaves it in `tangent` when it had to be formed.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] where the body is not held; with a mass that cannot be.
    pub fn factor_elastic(
        &mut self,
        model: &Model,
        tangent: &mut Tangent,
        linear: LinearPart,
        statistics: &mut Statistics,
    ) -> Result<(), SolveError> {
        if self.elastic_of == Some(linear) {
            return Ok(());
        }
        self.elastic_of = None;
        let start = Instant::now();
        tangent.set_elastic(model, linear);
        tangent.write(model, &mut self.lower, &mut self.upper);
        statistics.assembly_seconds += start.elapsed().as_secs_f64();
        let start = Instant::now();
        let refuse = |equation: usize, pivot: f64| {
            let (node, direction) = name(model.mesh(), model.supports().free()[equation] as usize);
            SolveError::NoStiffness { node, direction, pivot }
        };
        self.elastic.factor_symmetric(&self.lower).map_err(|e| refuse(e.equation, e.ratio))?;
        let (ratio, equation) = self.elastic.weakest_pivot();
        if ratio.is_nan() || ratio < NO_STIFFNESS {
            return Err(refuse(equation, ratio));
        }
        statistics.factorizations_symmetric += 1;
        statistics.factor_seconds += start.elapsed().as_secs_f64();
        self.elastic_of = Some(linear);
        Ok(())
    }

    /// Factors the assembled tangent; the matrix that may be solved with.
    pub fn factor_tangent(
        &mut self,
        model: &Model,
        tangent: &Tangent,
        statistics: &mut Statistics,
    ) -> Matrix {
        let start = Instant::now();
        tangent.write(model, &mut self.lower, &mut self.upper);
        statistics.assembly_seconds += start.elapsed().as_secs_f64();
        let start = Instant::now();
        let solver = self.tangent.get_or_insert_with(|| DirectSolver::new(self.analysis.clone()));
        let mut done = false;
        if tangent.symmetric() {
            statistics.factorizations_symmetric += 1;
            done = solver.factor_symmetric(&self.lower).is_ok();
            statistics.not_positive += u64::from(!done);
        }
        if !done {
            let upper = if tangent.symmetric() { &self.lower } else { &self.upper };
            statistics.factorizations_unsymmetric += 1;
            done = solver.factor_unsymmetric(&self.lower, upper).is_ok();
            statistics.singular += u64::from(!done);
        }
        self.tangent_ready = done;
        statistics.factor_seconds += start.elapsed().as_secs_f64();
        if done { Matrix::Tangent } else { Matrix::Elastic }
    }

    /// Whether an unsymmetric tangent is to be solved with by iteration.
    pub fn iterates(&self, method: LinearMethod) -> bool {
        match method {
            LinearMethod::Auto => self.analysis.size() > DIRECT_LIMIT,
            LinearMethod::Direct => false,
            LinearMethod::Krylov => true,
        }
    }

    /// Solves in place with a factor at hand.
    pub fn solve(&mut self, matrix: Matrix, x: &mut [f64], statistics: &mut Statistics) {
        let start = Instant::now();
        match &mut self.tangent {
            Some(tangent) if matrix == Matrix::Tangent && self.tangent_ready => tangent.solve_in_place(x),
            _ => self.elastic.solve_in_place(x),
        }
        statistics.solves += 1;
        statistics.solve_seconds += start.elapsed().as_secs_f64();
    }
}
