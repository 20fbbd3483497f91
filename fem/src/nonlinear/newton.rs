//! Newton iteration (full, modified or elastic) with optional line search.
//!
//! ```text
//! r(w) = rhs - f(w) - S w - (stiffness K + mass M + dashpots D) w = 0 on the free dofs
//! ```
//!
//! The first iteration uses the elastic matrix, as yielding exactly on the surface would depend on
//! rounding.
//!
//! Convergence: residual at most `force_tolerance` of the forces (largest of |rhs|, |f|, 1e-6 of |f| at the start, all dofs), *and*
//! residual work on the last correction at most `energy_tolerance` of its maximum in the step.
//!
//! Line search: the residual work is halved (Crisfield 1991, vol. 1, section 9.2), or, for corrections
//! without positive work, the residual norm is reduced.
//!
//! Theory manual: equation (4.10) of `docs/theory/solid.md`.

use super::conditions::subtract_springs;
use super::internal_force::{InternalForce, PointFailure};
use super::linear_system::{LinearSystem, Matrix};
use super::options::{NewtonOptions, Variant};
use super::tangent::Tangent;
use crate::assembly::Combination;
use crate::element::stiffness_points;
use crate::error::SolveError;
use crate::integrator::{SolverState, Statistics, StepLength, StepReport};
use crate::material::{Law, Points, ReturnError, ReturnRegion};
use crate::model::Model;
use crate::state::State;
use std::time::Instant;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NotConverged {
    pub residual: f64,
    pub iterations: u32,
    element: usize,
    point: usize,
    region: ReturnRegion,
    cause: Option<ReturnError>,
}

pub(crate) enum Failure {
    /// No convergence; a smaller step may succeed.
    NotConverged(NotConverged),
    Fatal(SolveError),
}

impl NotConverged {
    /// Error with the element number of the files.
    pub fn error(&self, model: &Model, time: f64) -> SolveError {
        let mesh = model.mesh();
        if let (Law::UserMaterial(law), Some(cause)) = (&model.material(self.element).law, self.cause) {
            let (element, point) = (mesh.element_ids[self.element], self.point as u32 + 1);
            return SolveError::UserMaterial { time, element, point, law: law.label(), cause };
        }
        let points = stiffness_points(mesh.connectivity.kind(self.element), model.quadrature());
        SolveError::Diverged {
            time,
            iterations: self.iterations,
            residual: self.residual,
            element: mesh.element_ids[self.element],
            point: self.point as u32 + 1,
            xi: points[self.point].xi,
            region: self.region,
        }
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Problem<'a> {
    /// Committed point states. Shape `[points]`.
    pub old: &'a Points,
    /// Right-hand side [N]. Shape `[3 * nodes]`.
    pub rhs: &'a [f64],
    pub fixed: &'a [f64],
    /// Matrices added to the internal force.
    pub linear: Combination,
    /// Start and length of the step [s].
    pub step: [f64; 2],
    /// Reference force [N], if larger than the internal force; default: `rhs`.
    pub forces: Option<f64>,
    pub stop: &'a dyn Fn() -> bool,
}

/// Residual ratio without progress.
const PROGRESS: f64 = 0.5;
/// Stalled after these iterations.
const STALL_LIMIT: u32 = 3;
/// Fraction of the force tolerance that waives the energy criterion.
const FORCE_ONLY_RATIO: f64 = 0.1;
const MIN_STEP_LENGTH: f64 = 0.1;
/// Longest step without tangent.
const MAX_STEP_LENGTH: f64 = 4.0;
const LINE_SEARCH_TOLERANCE: f64 = 0.5;
const MAX_LINE_SEARCHES: u32 = 5;
/// Least reference force, over the internal force at the start of the step: loads may vanish.
const LEAST_REFERENCE: f64 = 1e-6;
/// Relative residual of an aborted iteration.
const DIVERGENCE_LIMIT: f64 = 1e6;

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Inertia fraction in the force norm, against velocity rounding.
pub(crate) const INERTIA: f64 = 1e-3;

pub(crate) struct Newton {
    pub options: NewtonOptions,
    pub force: InternalForce,
    pub system: LinearSystem,
    pub tangent: Tangent,
    /// Increment [m]. Shape `[3 * nodes]`.
    pub du: Vec<f64>,
    /// Residual [N] over all dofs.
    pub residual: Vec<f64>,
    pub statistics: Statistics,
    pub report: StepReport,
    stalls: u32,
    /// Least reference force of the step [N].
    least: f64,
    base: Vec<f64>,
    correction: Vec<f64>,
    product: Vec<f64>,
    equations: Vec<f64>,
}

impl Newton {
    pub fn new(model: &Model, options: NewtonOptions) -> Result<Newton, SolveError> {
        options.check()?;
        let n = model.dof_count();
        let report = StepReport {
            residuals: Vec::with_capacity(options.max_iterations as usize + 1),
            ..Default::default()
        };
        Ok(Newton {
            options,
            force: InternalForce::new(model),
            system: LinearSystem::new(model)?,
            tangent: Tangent::new(model),
            du: vec![0.0; n],
            residual: vec![0.0; n],
            statistics: Statistics::default(),
            report,
            stalls: 0,
            least: 0.0,
            base: vec![0.0; n],
            correction: vec![0.0; n],
            product: vec![0.0; n],
            equations: vec![0.0; model.free_dof_count()],
        })
    }

    /// Solves a step; results are in `w`, `force.points` and `report`.
    pub fn solve(&mut self, model: &Model, problem: &Problem<'_>) -> Result<(), Failure> {
        self.system
            .factor_elastic(model, &mut self.tangent, problem.linear, &mut self.statistics)
            .map_err(Failure::Fatal)?;
        self.force.step = problem.step;
        self.report.residuals.clear();
        self.report.iterations = 0;
        self.du.fill(0.0);
        self.evaluate(model, problem, 0.0)?;
        self.least = LEAST_REFERENCE * norm(&self.force.force);
        let moving = problem.fixed.iter().any(|f| *f != 0.0);
        let mut size = self.record_relative_residual(model, problem);
        if !moving && size <= self.options.force_tolerance {
            self.report.plastic_points = 0;
            return Ok(());
        }
        let mut most = 0.0_f64;
        let mut best = f64::INFINITY;
        self.stalls = 0;
        let mut matrix = Matrix::Elastic;
        for iteration in 1..=self.options.max_iterations {
            if (problem.stop)() {
                return Err(Failure::Fatal(SolveError::Stopped));
            }
            self.correction.fill(0.0);
            if iteration == 1 {
                self.predict(model, problem, moving);
            } else {
                matrix = self.select_matrix(model, problem, iteration, matrix);
                model.supports().gather(&self.residual, &mut self.equations);
            }
            self.system.solve(model, matrix, &self.tangent, &mut self.equations, &mut self.statistics);
            model.supports().scatter(&self.equations, &mut self.correction);
            let (work, norm) = (self.correction_work(model), self.residual_norm(model));
            self.base.copy_from_slice(&self.du);
            self.evaluate(model, problem, 1.0)?;
            // Prescribed increments are not scaled.
            if self.options.line_search && iteration > 1 {
                self.search(model, problem, work, norm, matrix)?;
            }
            self.report.iterations = iteration;
            self.statistics.iterations += 1;
            size = self.record_relative_residual(model, problem);
            if !size.is_finite() || size > DIVERGENCE_LIMIT {
                break;
            }
            self.stalls += u32::from(iteration > 2 && size > PROGRESS * best);
            best = best.min(size);
            let left = self.correction_work(model).abs();
            most = most.max(work.abs());
            let NewtonOptions { force_tolerance, energy_tolerance, .. } = self.options;
            let quiet = left <= energy_tolerance * most || size <= FORCE_ONLY_RATIO * force_tolerance;
            if size <= force_tolerance && quiet {
                self.report.plastic_points = self.force.plastic;
                return Ok(());
            }
        }
        Err(Failure::NotConverged(self.not_converged(model, problem, size)))
    }

    /// Prescribed increments act through the elastic matrix.
    fn predict(&mut self, model: &Model, problem: &Problem<'_>, moving: bool) {
        if moving {
            for (&(dof, _), value) in model.supports().fixed().iter().zip(problem.fixed) {
                self.du[dof as usize] = *value;
            }
            let stiffness = 1.0 + problem.linear.stiffness;
            self.add_linear(model, Combination { stiffness, ..problem.linear });
        }
        model.supports().gather(&self.residual, &mut self.equations);
    }

    fn add_linear(&mut self, model: &Model, linear: Combination) {
        let Combination { stiffness, mass, dashpots } = linear;
        if dashpots != 0.0 && !model.matrices().dashpots().is_empty() {
            self.product.fill(0.0);
            model.dashpot_times(&self.du, &mut self.product);
            self.residual.iter_mut().zip(&self.product).for_each(|(r, p)| *r -= dashpots * p);
        }
        if stiffness != 0.0 {
            model.stiffness_times(&self.du, &mut self.product);
            self.residual.iter_mut().zip(&self.product).for_each(|(r, p)| *r -= stiffness * p);
        }
        if mass != 0.0 {
            model.mass_times(&self.du, &mut self.product);
            self.residual.iter_mut().zip(&self.product).for_each(|(r, p)| *r -= mass * p);
        }
    }

    fn select_matrix(
        &mut self,
        model: &Model,
        problem: &Problem<'_>,
        iteration: u32,
        last: Matrix,
    ) -> Matrix {
        let due = match self.options.variant {
            Variant::Full => true,
            Variant::Modified(0) => iteration == 2,
            Variant::Modified(every) => (iteration - 2).is_multiple_of(every),
            Variant::InitialStiffness => return Matrix::Elastic,
        };
        if !due {
            return last;
        }
        if self.force.plastic == 0 && model.has_constant_elasticity() {
            return Matrix::Elastic;
        }
        let start = Instant::now();
        self.tangent.assemble(
            model,
            &self.force,
            problem.old,
            &self.du,
            problem.linear,
            self.stalls >= STALL_LIMIT,
        );
        self.statistics.assembly_seconds += start.elapsed().as_secs_f64();
        self.system.set_tangent(model, &self.tangent, self.options.linear, &mut self.statistics)
    }

    /// Residual at `base + length * correction`, or at `w`.
    fn evaluate(&mut self, model: &Model, problem: &Problem<'_>, length: f64) -> Result<(), Failure> {
        if length > 0.0 {
            for d in 0..self.du.len() {
                self.du[d] = self.base[d] + length * self.correction[d];
            }
        }
        let start = Instant::now();
        let outcome = self.force.evaluate(model, problem.old, &self.du);
        self.statistics.evaluations += 1;
        self.statistics.assembly_seconds += start.elapsed().as_secs_f64();
        if let Err(PointFailure { element, point, cause }) = outcome {
            return Err(Failure::NotConverged(NotConverged {
                residual: f64::NAN,
                iterations: self.report.iterations + 1,
                element,
                point,
                region: ReturnRegion::Elastic,
                cause: Some(cause),
            }));
        }
        for d in 0..self.du.len() {
            self.residual[d] = problem.rhs[d] - self.force.force[d];
        }
        subtract_springs(model, &self.du, &mut self.residual);
        self.add_linear(model, problem.linear);
        Ok(())
    }

    fn record_relative_residual(&mut self, model: &Model, problem: &Problem<'_>) -> f64 {
        let given = problem.forces.unwrap_or_else(|| norm(problem.rhs));
        let forces = given.max(norm(&self.force.force)).max(self.least);
        let residual = self.residual_norm(model);
        let size = if residual == 0.0 { 0.0 } else { residual / forces };
        self.report.residuals.push(size);
        size
    }

    fn residual_norm(&self, model: &Model) -> f64 {
        let free = model.supports().free();
        free.iter().map(|&d| self.residual[d as usize].powi(2)).sum::<f64>().sqrt()
    }

    fn correction_work(&self, model: &Model) -> f64 {
        let free = model.supports().free();
        free.iter().map(|&d| self.residual[d as usize] * self.correction[d as usize]).sum()
    }

    /// `before` and `size`: work and norm of the residual at length 0.
    fn search(
        &mut self,
        model: &Model,
        problem: &Problem<'_>,
        before: f64,
        size: f64,
        matrix: Matrix,
    ) -> Result<(), Failure> {
        if before <= 0.0 {
            return self.search_by_norm(model, problem, size);
        }
        let tangent = self.options.variant == Variant::Full && matrix == Matrix::Tangent;
        let longest = if tangent { 1.0 } else { MAX_STEP_LENGTH };
        let (mut low, mut high) = ((0.0, before), None);
        let mut now = (1.0, self.correction_work(model));
        for _ in 0..MAX_LINE_SEARCHES {
            if now.1.abs() <= LINE_SEARCH_TOLERANCE * before || (now.1 > 0.0 && now.0 >= longest) {
                break;
            }
            if now.1 > 0.0 {
                low = now;
            } else {
                high = Some(now);
            }
            let next: f64 = match high {
                Some(high) => {
                    let cut = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
                    let margin = 0.1 * (high.0 - low.0);
                    cut.clamp(low.0 + margin, high.0 - margin)
                }
                None => longest.min(2.0 * now.0),
            };
            let next = next.max(MIN_STEP_LENGTH);
            if next == now.0 {
                break;
            }
            self.evaluate(model, problem, next)?;
            now = (next, self.correction_work(model));
        }
        Ok(())
    }

    fn search_by_norm(&mut self, model: &Model, problem: &Problem<'_>, before: f64) -> Result<(), Failure> {
        let mut length = 1.0;
        while length > 2.0 * MIN_STEP_LENGTH && self.residual_norm(model) > before {
            length *= 0.5;
            self.evaluate(model, problem, length)?;
        }
        Ok(())
    }

    /// Position for error messages: largest residual, then largest plastic strain growth.
    fn not_converged(&self, model: &Model, problem: &Problem<'_>, residual: f64) -> NotConverged {
        let mut worst = (0.0, 0);
        for &d in model.supports().free() {
            let r = self.residual[d as usize].abs();
            if r.is_nan() || r > worst.0 {
                worst = (if r.is_nan() { f64::INFINITY } else { r }, d / 3);
            }
        }
        let (mut element, mut point, mut most) = (usize::MAX, 0, -1.0);
        for (e, nodes) in model.mesh().connectivity.iter().enumerate() {
            if nodes.contains(&worst.1) {
                for (i, p) in self.force.table.points(e).enumerate() {
                    let growth = self.force.points[p].kappa - problem.old[p].kappa;
                    if growth > most {
                        (element, point, most) = (e, i, growth);
                    }
                }
            }
        }
        let element = if element == usize::MAX { 0 } else { element };
        let region = self.force.regions[self.force.table.points(element).start + point];
        NotConverged { residual, iterations: self.report.iterations, element, point, region, cause: None }
    }
}

impl Newton {
    pub fn commit(&mut self, state: &mut State, time: f64, dt: f64) {
        state.u.iter_mut().zip(&self.du).for_each(|(u, w)| *u += w);
        std::mem::swap(&mut state.points, &mut self.force.points);
        state.time = time;
        self.statistics.steps += 1;
        self.report.time = time;
        self.report.dt = dt;
    }

    pub fn solver_state(&self, length: Option<StepLength>) -> SolverState {
        SolverState { statistics: self.statistics, length, factored: self.system.elastic_combination() }
    }

    /// Restores checkpointed state, including the elastic factor.
    ///
    /// # Errors
    /// Failed factorisation.
    pub fn restore(
        &mut self,
        model: &Model,
        memory: &SolverState,
        length: Option<&mut StepLength>,
    ) -> Result<(), SolveError> {
        if let Some(combination) = memory.factored {
            self.system.factor_elastic(model, &mut self.tangent, combination, &mut self.statistics)?;
        }
        self.statistics = memory.statistics;
        if let (Some(length), Some(remembered)) = (length, memory.length) {
            *length = remembered;
        }
        Ok(())
    }
}
