//! One implicit step of an elastoplastic body under the mean load of a time window: the solid's part of a coupled step.
//!
//! ```text
//! M (v1 - v0)/dt + C vt + (1 - theta) (f(s0) + S u0) + theta (f(s1) + S u1) = F_mean,   vt = (u1 - u0)/dt = (1 - theta) v0 + theta v1
//! ```
//!
//! For an elastic body this is [`crate::window::WindowSolver`] exactly. The impulse of the window is handed over whole. When the
//! iteration of a window fails it is taken in 2, 4, … equal parts under the same mean load, which keeps the impulse.
//!
//! Source: as the elastic one; the stresses are returned at the end of the step (backward Euler) and weighted as forces, so the
//! ledger closes without approximation with the mean of the stresses at both ends. Limits: second order for theta = 1/2 only.

use super::conditions::{check_state, ensure_points, subtract_springs};
use super::memory::Memory;
use super::motion::{close, inner_force};
use super::newton::{Failure, Newton, Problem};
use super::options::{NewtonOptions, Statistics};
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::integrator::{Loading, StepReport, TimeIntegrator, steps_of};
use crate::model::Model;
use crate::newmark::{check_dynamics, check_theta};
use crate::state::{State, StepAudit};
use crate::statics::{check_load, check_prescribed};

/// Parts that a window is split in at most.
const PARTS: u32 = 64;
/// As in the dynamics.
const INERTIA: f64 = 1e-3;

/// Steps an elastoplastic body through windows of one length.
pub struct PlasticWindowSolver {
    theta: f64,
    dt: f64,
    newton: Newton,
    next: State,
    rhs: Vec<f64>,
    fixed: Vec<f64>,
    inner: [Vec<f64>; 2],
    scratch: Vec<f64>,
}

impl PlasticWindowSolver {
    /// Windows of length `dt` [s], with `theta` from 1/2 (no numerical damping) to 1.
    ///
    /// # Errors
    /// theta or options out of range, a length that is not above 0, a material without density.
    pub fn new(
        model: &Model,
        theta: f64,
        dt: f64,
        options: NewtonOptions,
    ) -> Result<PlasticWindowSolver, SolveError> {
        check_theta(theta)?;
        check_dynamics(model, dt)?;
        let zeros = || vec![0.0; model.dof_count()];
        Ok(PlasticWindowSolver {
            theta,
            dt,
            newton: Newton::new(model, options)?,
            next: State { points: model.new_points(), ..State::new(model) },
            rhs: zeros(),
            fixed: vec![0.0; model.supports().fixed().len()],
            inner: [zeros(), zeros()],
            scratch: vec![0.0; 2 * model.dof_count()],
        })
    }

    /// The length of the window [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// The parameter theta [-].
    pub fn theta(&self) -> f64 {
        self.theta
    }

    /// Counts and times since the solver was made.
    pub fn statistics(&self) -> Statistics {
        self.newton.statistics
    }

    /// What the solver remembers beside the state, for a checkpoint.
    pub fn memory(&self) -> Memory {
        self.newton.memory(None)
    }

    /// Goes on with the memory of a solver of the same model and options.
    ///
    /// # Errors
    /// The elastic matrix cannot be factored.
    pub fn recall(&mut self, model: &Model, memory: &Memory) -> Result<(), SolveError> {
        self.newton.recall(model, memory, None)
    }

    /// How the last step, or the last part of it, converged.
    pub fn report(&self) -> &StepReport {
        &self.newton.report
    }

    /// One step under the mean load [N] of the window, shape `[3 * nodes]`, on supports that stay where they are.
    /// `state.a` becomes the mean acceleration of the window, or of its last part.
    ///
    /// # Errors
    /// A load or a result that is not finite, a state of another model, or [`SolveError::Diverged`] when a sixty-fourth of the
    /// window fails; the state is untouched then.
    pub fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
    ) -> Result<StepAudit, SolveError> {
        self.step_prescribed(model, state, mean_load, None)
    }

    /// As [`PlasticWindowSolver::step`], with the displacement [m] of each constrained dof at the end of the window, in the
    /// order of [`crate::supports::Supports::fixed`].
    ///
    /// # Errors
    /// As [`PlasticWindowSolver::step`].
    pub fn step_prescribed(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<StepAudit, SolveError> {
        check_load(model, mean_load, state.time + self.dt)?;
        check_prescribed(model, prescribed, state.time + self.dt)?;
        check_state(model, state)?;
        let mut parts = 1;
        loop {
            let mut trial = None;
            match self.parts(model, state, &mut trial, mean_load, prescribed, parts) {
                Ok(audit) => {
                    if let Some(trial) = trial {
                        *state = trial;
                    }
                    return Ok(audit);
                }
                Err(Failure::Stuck(stuck)) if parts >= PARTS => return Err(stuck.error(model, state.time)),
                Err(Failure::Stuck(_)) => {
                    parts *= 2;
                    self.newton.statistics.halvings += 1;
                }
                Err(Failure::Fatal(error)) => return Err(error),
            }
        }
    }

    /// The window in equal parts. One part goes straight into the state; several go into a copy.
    fn parts(
        &mut self,
        model: &Model,
        state: &mut State,
        trial: &mut Option<State>,
        mean_load: &[f64],
        prescribed: Option<&[f64]>,
        parts: u32,
    ) -> Result<StepAudit, Failure> {
        ensure_points(model, state);
        let (start, end) = (state.time, state.time + self.dt);
        let mut sum = StepAudit::default();
        let state = if parts == 1 { state } else { trial.insert(state.clone()) };
        for part in 1..=parts {
            let left = f64::from(parts - part + 1);
            for (i, &(dof, _)) in model.supports().fixed().iter().enumerate() {
                self.fixed[i] = prescribed.map_or(0.0, |p| (p[i] - state.u[dof as usize]) / left);
            }
            let share = f64::from(part) / f64::from(parts);
            let time = if part == parts { end } else { start + share * self.dt };
            let audit = self.part(model, state, mean_load, self.dt / f64::from(parts), time)?;
            sum.external_work += audit.external_work;
            sum.support_work += audit.support_work;
            sum.damping_dissipation += audit.damping_dissipation;
            sum.boundary_dissipation += audit.boundary_dissipation;
            sum.plastic_dissipation += audit.plastic_dissipation;
            sum.numerical_dissipation += audit.numerical_dissipation;
        }
        Ok(sum)
    }

    fn part(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
        dt: f64,
        time: f64,
    ) -> Result<StepAudit, Failure> {
        let (theta, c, n) = (self.theta, model.rayleigh(), state.u.len());
        let [start, force] = &mut self.inner;
        self.newton.force.of_states(model, &state.points);
        start.copy_from_slice(&self.newton.force.force);
        model.boundary_spring_times(&state.u, start);
        // 1. The equation over theta, with the increment as unknown.
        let square = 1.0 / (theta * theta * dt * dt);
        model.mass_times(&state.v, force);
        for d in 0..n {
            self.rhs[d] = (mean_load[d] - (1.0 - theta) * start[d]) / theta + dt * square * force[d];
        }
        subtract_springs(model, &state.u, &mut self.rhs);
        let linear = Combination {
            mass: square + c.alpha_m / (theta * dt),
            stiffness: c.beta_k / (theta * dt),
            dashpots: 1.0 / (theta * dt),
        };
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let forces = norm(mean_load).max(norm(start)).max(INERTIA * norm(&self.rhs));
        // 2. Iterate.
        let (old, forces, stop) = (&state.points, Some(forces), &|| false);
        let problem = Problem { old, rhs: &self.rhs, fixed: &self.fixed, linear, forces, stop };
        self.newton.solve(model, &problem)?;
        // 3. The motion at the end, and the ledger.
        let next = &mut self.next;
        for d in 0..n {
            let w = self.newton.w[d];
            let change = (w / dt - state.v[d]) / theta;
            next.u[d] = state.u[d] + w;
            next.v[d] = state.v[d] + change;
            next.a[d] = change / dt;
        }
        std::mem::swap(&mut next.points, &mut self.newton.force.points);
        next.time = time;
        let mut audit = StepAudit::default();
        for d in 0..n {
            audit.external_work += mean_load[d] * self.newton.w[d];
        }
        if self.fixed.iter().any(|f| *f != 0.0) {
            // theta times the residual of the iteration is what the supports must add.
            for d in model.supports().fixed().iter().map(|(dof, _)| *dof as usize) {
                audit.support_work -= theta * self.newton.residual[d] * self.newton.w[d];
            }
        }
        for d in 0..n {
            self.rhs[d] = self.newton.w[d] / dt;
        }
        let audit =
            close(model, &self.newton.force.table, [state, next], audit, &self.rhs, &mut self.scratch);
        std::mem::swap(state, next);
        self.newton.statistics.steps += 1;
        (self.newton.report.time, self.newton.report.dt) = (time, dt);
        Ok(audit)
    }

    /// Mean forces of the supports on the body during a window [N] that led from `before` to `after` in one part under the
    /// mean load, 0 at free dofs. Shape `[3 * nodes]`.
    pub fn mean_reactions(
        &mut self,
        model: &Model,
        before: &State,
        after: &State,
        mean_load: &[f64],
    ) -> Vec<f64> {
        let (n, dt, theta) = (before.u.len(), after.time - before.time, self.theta);
        // The inner force of the mean motion, its stresses being the weighted mean of those at both ends.
        let mean = |a: f64, b: f64| (1.0 - theta) * a + theta * b;
        let mut middle = after.clone();
        for d in 0..n {
            middle.u[d] = mean(before.u[d], after.u[d]);
            middle.v[d] = (after.u[d] - before.u[d]) / dt;
            middle.a[d] = (after.v[d] - before.v[d]) / dt;
        }
        for (p, q) in middle.points.iter_mut().zip(&before.points) {
            p.stress = std::array::from_fn(|k| mean(q.stress[k], p.stress[k]));
        }
        let mut force = vec![0.0; n];
        inner_force(model, &mut self.newton.force, &middle, &mut force, &mut self.scratch);
        let mut reactions = vec![0.0; n];
        for &(dof, _) in model.supports().fixed() {
            reactions[dof as usize] = force[dof as usize] - mean_load[dof as usize];
        }
        reactions
    }
}

impl TimeIntegrator for PlasticWindowSolver {
    /// Windows under the mean of the loads at both ends; `to` must lie a whole number of windows ahead.
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: &mut dyn FnMut(&State, &StepReport, Option<&StepAudit>),
    ) -> Result<(), SolveError> {
        for step in steps_of(model, state.time, to, self.dt)? {
            let (load, prescribed) = step.mean(loading);
            let audit = self.step_prescribed(model, state, &load, Some(&prescribed))?;
            // The end itself, where the sum of the steps would miss it by rounding.
            state.time = step.ends[1];
            self.newton.report.time = state.time;
            on_step(state, &self.newton.report, Some(&audit));
        }
        Ok(())
    }
}
