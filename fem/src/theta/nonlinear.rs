//! θ-method of an elastoplastic body.
//!
//! ```text
//! M (v1 - v0)/dt + C vt + (1 - theta) (f(s0) + S u0) + theta (f(s1) + S u1) = F_mean
//! vt = (u1 - u0)/dt = (1 - theta) v0 + theta v1
//! ```
//!
//! After divergence, the window is split into 2, 4, … parts under the same mean load, which keeps the
//! impulse.
//!
//! Source: as the linear method; backward Euler stresses. Limits: second order for theta = 1/2 only.

use super::{ThetaMethod, check_theta};
use crate::assembly::Combination;
use crate::energy::at_supports;
use crate::error::SolveError;
use crate::integrator::{Loading, OnStep, SolverState, Statistics, StepReport, TimeIntegrator};
use crate::model::Model;
use crate::newmark::check_dynamics;
use crate::nonlinear::NewtonOptions;
use crate::nonlinear::conditions::{check_state, ensure_points, subtract_springs};
use crate::nonlinear::motion::{close, inner_force};
use crate::nonlinear::newton::{Failure, INERTIA, Newton, Problem};
use crate::state::{State, StepAudit};
use crate::statics::{check_load, check_prescribed};

/// Largest number of parts of a window.
const PARTS: u32 = 64;

/// Elastoplastic θ-method; if a sixty-fourth of a window fails, [`SolveError::Diverged`].
pub struct NonlinearTheta {
    theta: f64,
    dt: f64,
    newton: Newton,
    next: State,
    rhs: Vec<f64>,
    fixed: Vec<f64>,
    inner: [Vec<f64>; 2],
    scratch: Vec<f64>,
}

impl NonlinearTheta {
    /// Builds a solver for windows `dt` [s], `theta` from 1/2 (undamped) to 1.
    ///
    /// # Errors
    /// theta or options out of range, length not above 0, material without density.
    pub fn new(
        model: &Model,
        theta: f64,
        dt: f64,
        options: NewtonOptions,
    ) -> Result<NonlinearTheta, SolveError> {
        check_theta(theta)?;
        check_dynamics(model, dt)?;
        let zeros = || vec![0.0; model.dof_count()];
        Ok(NonlinearTheta {
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

    /// Parameter theta [-].
    pub fn theta(&self) -> f64 {
        self.theta
    }

    /// Counts and times.
    pub fn statistics(&self) -> Statistics {
        self.newton.statistics
    }

    /// Several parts use a copy of the state.
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
            sum += self.part(model, state, mean_load, self.dt / f64::from(parts), time)?;
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
        // Equation over theta, for the increment.
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
        let (old, forces, stop) = (&state.points, Some(forces), &|| false);
        let (rhs, fixed, step) = (&self.rhs, &self.fixed, [state.time, dt]);
        let problem = Problem { old, rhs, fixed, linear, step, forces, stop };
        self.newton.solve(model, &problem)?;
        let next = &mut self.next;
        for d in 0..n {
            let w = self.newton.du[d];
            let change = (w / dt - state.v[d]) / theta;
            next.u[d] = state.u[d] + w;
            next.v[d] = state.v[d] + change;
            next.a[d] = change / dt;
        }
        std::mem::swap(&mut next.points, &mut self.newton.force.points);
        next.time = time;
        let mut audit = StepAudit::default();
        for d in 0..n {
            audit.external_work += mean_load[d] * self.newton.du[d];
        }
        if self.fixed.iter().any(|f| *f != 0.0) {
            // Supports supply theta times the residual.
            for d in model.supports().fixed().iter().map(|(dof, _)| *dof as usize) {
                audit.support_work -= theta * self.newton.residual[d] * self.newton.du[d];
            }
        }
        for d in 0..n {
            self.rhs[d] = self.newton.du[d] / dt;
        }
        let audit =
            close(model, &self.newton.force.table, [state, next], audit, &self.rhs, &mut self.scratch);
        std::mem::swap(state, next);
        self.newton.statistics.steps += 1;
        (self.newton.report.time, self.newton.report.dt) = (time, dt);
        Ok(audit)
    }

    /// Mean support reactions [N] of an undivided window, 0 at free dofs. Shape `[3 * nodes]`.
    pub fn mean_reactions(
        &mut self,
        model: &Model,
        before: &State,
        after: &State,
        mean_load: &[f64],
    ) -> Vec<f64> {
        let (n, dt, theta) = (before.u.len(), after.time - before.time, self.theta);
        // Weighted mean stresses.
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
        at_supports(model, &force, mean_load)
    }
}

impl ThetaMethod for NonlinearTheta {
    fn dt(&self) -> f64 {
        self.dt
    }

    fn report(&mut self) -> &mut StepReport {
        &mut self.newton.report
    }

    fn step_prescribed(
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
                Err(Failure::NotConverged(stuck)) if parts >= PARTS => {
                    return Err(stuck.error(model, state.time));
                }
                Err(Failure::NotConverged(_)) => {
                    parts *= 2;
                    self.newton.statistics.halvings += 1;
                }
                Err(Failure::Fatal(error)) => return Err(error),
            }
        }
    }
}

impl TimeIntegrator for NonlinearTheta {
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: OnStep<'_>,
    ) -> Result<(), SolveError> {
        super::integrate(self, model, state, to, loading, on_step)
    }

    fn solver_state(&self) -> Option<SolverState> {
        Some(self.newton.solver_state(None))
    }

    fn restore(&mut self, model: &Model, memory: &SolverState) -> Result<(), SolveError> {
        self.newton.restore(model, memory, None)
    }
}
