//! Linear systems of an iteration, with elastic and tangent factors.
//!
//! Symmetric tangents use L L^T, or L U if indefinite (softening). Unsymmetric tangents use L U or, if large,
//! inexact GMRES with the elastic factor (Dembo, Eisenstat and Steihaug, SIAM J. Numer. Anal. 19 (1982)
//! 400-408), then the elastic matrix.

use super::options::LinearMethod;
use super::tangent::Tangent;
use crate::assembly::Combination;
use crate::equations::system::NO_STIFFNESS;
use crate::error::SolveError;
use crate::integrator::Statistics;
use crate::model::Model;
use crate::solver::analysis::Analysis;
use crate::solver::gmres::Gmres;
use crate::solver::multifrontal::DirectSolver;
use std::sync::Arc;
use std::time::Instant;

/// Free dofs above which `Auto` uses GMRES.
const DIRECT_LIMIT: usize = 30_000;
const RESTART: usize = 60;
const LIMIT: usize = 180;
/// GMRES tolerance over the right-hand side.
const TOLERANCE: f64 = 1e-3;
/// Largest residual useful to Newton.
const ACCEPTED: f64 = 1e-1;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Matrix {
    Elastic,
    Tangent,
    Iterated,
}

pub(crate) struct LinearSystem {
    analysis: Arc<Analysis>,
    elastic: DirectSolver,
    elastic_combination: Option<Combination>,
    tangent: Option<DirectSolver>,
    tangent_ready: bool,
    lower: Vec<f64>,
    upper: Vec<f64>,
    krylov: Option<Krylov>,
}

struct Krylov {
    gmres: Gmres,
    solution: Vec<f64>,
    nodal: [Vec<f64>; 2],
}

impl LinearSystem {
    pub fn new(model: &Model) -> Result<LinearSystem, SolveError> {
        let analysis = model.analysis()?;
        let entries = analysis.pattern().1.len();
        let unsymmetric = if model.symmetric_tangent() { 0 } else { entries };
        Ok(LinearSystem {
            elastic: DirectSolver::new(analysis.clone()),
            elastic_combination: None,
            tangent: None,
            tangent_ready: false,
            lower: vec![0.0; entries],
            upper: vec![0.0; unsymmetric],
            krylov: None,
            analysis,
        })
    }

    pub fn elastic_combination(&self) -> Option<Combination> {
        self.elastic_combination
    }

    /// Factors the elastic matrix unless current.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] without constraints; impossible with mass.
    pub fn factor_elastic(
        &mut self,
        model: &Model,
        tangent: &mut Tangent,
        linear: Combination,
        statistics: &mut Statistics,
    ) -> Result<(), SolveError> {
        if self.elastic_combination == Some(linear) {
            return Ok(());
        }
        self.elastic_combination = None;
        let start = Instant::now();
        tangent.set_elastic(model, linear);
        tangent.write(model, &mut self.lower, &mut self.upper);
        statistics.assembly_seconds += start.elapsed().as_secs_f64();
        let start = Instant::now();
        let equations = model.equations(linear);
        self.elastic
            .factor_symmetric(&self.lower)
            .map_err(|e| equations.no_stiffness(e.equation, e.ratio))?;
        let (ratio, equation) = self.elastic.weakest_pivot();
        if ratio.is_nan() || ratio < NO_STIFFNESS {
            return Err(equations.no_stiffness(equation, ratio));
        }
        statistics.factorizations_symmetric += 1;
        statistics.factor_seconds += start.elapsed().as_secs_f64();
        self.elastic_combination = Some(linear);
        Ok(())
    }

    /// Prepares the tangent: factors it or selects GMRES.
    pub fn set_tangent(
        &mut self,
        model: &Model,
        tangent: &Tangent,
        method: LinearMethod,
        statistics: &mut Statistics,
    ) -> Matrix {
        let iterate = match method {
            LinearMethod::Auto => self.analysis.size() > DIRECT_LIMIT,
            LinearMethod::Direct => false,
            LinearMethod::Krylov => true,
        };
        if iterate && !tangent.symmetric() {
            return Matrix::Iterated;
        }
        self.factor_tangent(model, tangent, statistics)
    }

    fn factor_tangent(&mut self, model: &Model, tangent: &Tangent, statistics: &mut Statistics) -> Matrix {
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

    pub fn solve(
        &mut self,
        model: &Model,
        matrix: Matrix,
        tangent: &Tangent,
        x: &mut [f64],
        statistics: &mut Statistics,
    ) {
        if matrix == Matrix::Iterated {
            let start = Instant::now();
            let solved = self.iterate(model, tangent, x, statistics);
            statistics.solve_seconds += start.elapsed().as_secs_f64();
            if solved {
                return;
            }
            statistics.krylov_failures += 1;
            self.factor_tangent(model, tangent, statistics);
        }
        let start = Instant::now();
        match &mut self.tangent {
            Some(factor) if matrix != Matrix::Elastic && self.tangent_ready => factor.solve_in_place(x),
            _ => self.elastic.solve_in_place(x),
        }
        statistics.solves += 1;
        statistics.solve_seconds += start.elapsed().as_secs_f64();
    }

    /// GMRES solve; on failure false, `x` unchanged.
    fn iterate(
        &mut self,
        model: &Model,
        tangent: &Tangent,
        x: &mut [f64],
        statistics: &mut Statistics,
    ) -> bool {
        let (size, dofs) = (x.len(), model.dof_count());
        let krylov = self.krylov.get_or_insert_with(|| Krylov {
            gmres: Gmres::new(size, RESTART),
            solution: vec![0.0; size],
            nodal: [vec![0.0; dofs], vec![0.0; dofs]],
        });
        let (supports, [from, to]) = (model.supports(), &mut krylov.nodal);
        krylov.solution.fill(0.0);
        let outcome = krylov.gmres.solve(
            |v, y| {
                // Constrained dofs stay 0.
                supports.scatter(v, from);
                tangent.times(model, from, to);
                supports.gather(to, y);
            },
            |z| self.elastic.solve_in_place(z),
            x,
            &mut krylov.solution,
            TOLERANCE,
            LIMIT,
        );
        statistics.krylov_iterations += outcome.iterations as u64;
        let good = outcome.residual <= ACCEPTED;
        if good {
            x.copy_from_slice(&krylov.solution);
        }
        good
    }
}
