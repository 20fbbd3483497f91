//! θ-method of a linear body.
//!
//! ```text
//! M (v1 - v0)/dt + C vt + K ut = F_mean
//! vt = (1 - theta) v0 + theta v1,   ut = u0 + theta dt vt,   u1 = u0 + dt vt
//! ```
//!
//! The window's impulse `F_mean dt` is applied exactly. The unknown is `w = vt - v0` with matrix
//! `M/(theta dt) + C + theta dt K`: errors are relative to the change.
//!
//! Energy, exactly: `work = change of (kinetic + strain) + dt vt·C vt + (theta - 1/2)(|dv|²_M + |du|²_K)`,
//! C = alpha_m M + beta_k K + D. theta = 1/2 conserves energy (Newmark 1/4, 1/2); theta = 1 is backward
//! Euler.
//!
//! Source: Simo and Tarnow (1992) (mid-point form and energy). Limits: second order for theta = 1/2 only;
//! moved supports have `vt = du/dt` and `v1 = v0 + (vt - v0)/theta`.

use super::{ThetaMethod, check_theta};
use crate::assembly::Combination;
use crate::energy::{at_supports, inner_force};
use crate::equations::system::{Added, IterationCounts, SystemSolver};
use crate::error::SolveError;
use crate::integrator::{Loading, OnStep, StepReport, TimeIntegrator};
use crate::model::Model;
use crate::newmark::check_dynamics;
use crate::state::{State, StepAudit};
use crate::statics::{check_finite, check_linear, check_load, check_prescribed};

/// Residual tolerance of predictions [-].
const TOLERANCE: f64 = 1e-8;

/// θ-method solver of one window length.
pub struct ThetaSolver {
    theta: f64,
    dt: f64,
    report: StepReport,
    system: Box<dyn SystemSolver>,
    next: State,
    work: Vec<f64>,
    product: Vec<f64>,
    inner: Vec<f64>,
    equations: Vec<f64>,
}

impl ThetaSolver {
    /// Factors the matrix of windows `dt` [s], `theta` from 1/2 (undamped) to 1.
    ///
    /// # Errors
    /// theta out of range, length not above 0, material without density or with plasticity.
    pub fn new(model: &Model, theta: f64, dt: f64) -> Result<ThetaSolver, SolveError> {
        check_theta(theta)?;
        check_linear(model)?;
        check_dynamics(model, dt)?;
        let c = model.rayleigh();
        // Scaled by theta dt: unit mass factor as in Newmark.
        let combination = Combination {
            stiffness: theta * dt * (theta * dt + c.beta_k),
            mass: 1.0 + theta * dt * c.alpha_m,
            dashpots: theta * dt,
        };
        let system = model.step_solver(combination)?;
        let n = model.dof_count();
        Ok(ThetaSolver {
            theta,
            dt,
            report: StepReport::linear(0.0, dt),
            system,
            next: State::new(model),
            work: vec![0.0; n],
            product: vec![0.0; n],
            inner: Vec::new(),
            equations: vec![0.0; model.free_dof_count()],
        })
    }

    /// CG counts, if selected.
    pub fn counts(&self) -> Option<IterationCounts> {
        self.system.counts()
    }

    /// Additional solver memory [bytes].
    pub fn solver_memory(&self) -> Option<usize> {
        self.system.memory()
    }

    /// Parameter theta [-].
    pub fn theta(&self) -> f64 {
        self.theta
    }

    /// Mean support reactions [N] of a window from `before` to `after`, 0 at free dofs. Shape `[3 * nodes]`.
    pub fn mean_reactions(
        &self,
        model: &Model,
        before: &State,
        after: &State,
        mean_load: &[f64],
    ) -> Vec<f64> {
        let n = model.dof_count();
        let du: Vec<f64> = after.u.iter().zip(&before.u).map(|(a, b)| a - b).collect();
        let (mut inner, mut scratch) = (vec![0.0; n], vec![0.0; 5 * n]);
        self.mean_inner_force(model, before, after, &du, &mut inner, &mut scratch);
        at_supports(model, &inner, mean_load)
    }

    /// `M dv/dt + C vt + K ut`; scratch: five nodal vectors.
    fn mean_inner_force(
        &self,
        model: &Model,
        old: &State,
        new: &State,
        du: &[f64],
        force: &mut [f64],
        scratch: &mut [f64],
    ) {
        let n = du.len();
        let (u, rest) = scratch.split_at_mut(n);
        let (v, rest) = rest.split_at_mut(n);
        let (a, rest) = rest.split_at_mut(n);
        for d in 0..n {
            u[d] = old.u[d] + self.theta * du[d];
            v[d] = du[d] / self.dt;
            a[d] = (new.v[d] - old.v[d]) / self.dt;
        }
        inner_force(model, [u, v, a], force, rest);
    }

    /// Expects du in `work`.
    fn audit(&mut self, model: &Model, old: &State, mean_load: &[f64]) -> StepAudit {
        let (dt, c, matrices) = (self.dt, model.rayleigh(), model.matrices());
        let excess = self.theta - 0.5;
        let external_work = mean_load.iter().zip(&self.work).map(|(f, du)| f * du).sum();
        let mut audit = StepAudit { external_work, ..StepAudit::default() };
        let fixed = model.supports().fixed();
        if fixed.iter().any(|&(dof, _)| self.work[dof as usize] != 0.0) {
            let mut inner = std::mem::take(&mut self.inner);
            inner.resize(5 * old.u.len(), 0.0);
            let mut force = std::mem::take(&mut self.product);
            self.mean_inner_force(model, old, &self.next, &self.work, &mut force, &mut inner);
            for d in fixed.iter().map(|&(dof, _)| dof as usize) {
                audit.support_work += (force[d] - mean_load[d]) * self.work[d];
            }
            (self.inner, self.product) = (inner, force);
        }
        if c.beta_k > 0.0 || excess > 0.0 {
            let strain = matrices.stiffness_form(&self.work);
            audit.damping_dissipation += c.beta_k * strain / dt;
            audit.numerical_dissipation += excess * strain;
        }
        if c.alpha_m > 0.0 {
            audit.damping_dissipation += c.alpha_m * matrices.mass_form(&self.work) / dt;
        }
        if !matrices.dashpots().is_empty() {
            audit.boundary_dissipation = matrices.dashpots().form(&self.work) / dt;
        }
        if excess > 0.0 {
            for d in 0..old.v.len() {
                self.work[d] = self.next.v[d] - old.v[d];
            }
            audit.numerical_dissipation += excess * matrices.mass_form(&self.work);
        }
        audit
    }
}

impl ThetaMethod for ThetaSolver {
    fn dt(&self) -> f64 {
        self.dt
    }

    fn report(&mut self) -> &mut StepReport {
        &mut self.report
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
        let (theta, dt, c) = (self.theta, self.dt, model.rayleigh());
        let (n, supports) = (state.u.len(), model.supports());
        let next = &mut self.next;
        next.a.fill(0.0);
        let mut accelerated = false;
        for (i, &(dof, _)) in supports.fixed().iter().enumerate() {
            let d = dof as usize;
            let end = prescribed.map_or(state.u[d], |p| p[i]);
            next.a[d] = (end - state.u[d]) / dt - state.v[d];
            accelerated |= next.a[d] != 0.0;
        }
        for d in 0..n {
            self.work[d] = state.u[d] + (theta * dt + c.beta_k) * (state.v[d] + next.a[d]);
        }
        model.stiffness_times(&self.work, &mut self.product);
        for (slot, &d) in self.equations.iter_mut().zip(supports.free()) {
            *slot = theta * dt * (mean_load[d as usize] - self.product[d as usize]);
        }
        if c.alpha_m > 0.0 || accelerated {
            for d in 0..n {
                self.work[d] = next.a[d] + theta * dt * c.alpha_m * (state.v[d] + next.a[d]);
            }
            model.mass_times(&self.work, &mut self.product);
            for (slot, &d) in self.equations.iter_mut().zip(supports.free()) {
                *slot -= self.product[d as usize];
            }
        }
        if !model.matrices().dashpots().is_empty() {
            for d in 0..n {
                self.work[d] = state.v[d] + next.a[d];
            }
            self.product.fill(0.0);
            model.dashpot_times(&self.work, &mut self.product);
            for (slot, &d) in self.equations.iter_mut().zip(supports.free()) {
                *slot -= theta * dt * self.product[d as usize];
            }
        }
        // The last window's w is the guess.
        self.system.solve(supports, &mut self.equations, &|d| theta * dt * state.a[d])?;
        supports.scatter(&self.equations, &mut next.a);
        for d in 0..n {
            let change = next.a[d] / theta;
            self.work[d] = dt * (state.v[d] + next.a[d]);
            next.u[d] = state.u[d] + self.work[d];
            next.v[d] = state.v[d] + change;
            next.a[d] = change / dt;
        }
        // Exact end value, without rounding of the sum.
        if let Some(values) = prescribed {
            for (&(dof, _), &value) in supports.fixed().iter().zip(values) {
                next.u[dof as usize] = value;
            }
        }
        next.time = state.time + dt;
        check_finite(model, "the displacement", &next.u, next.time)?;
        let audit = self.audit(model, state, mean_load);
        std::mem::swap(state, &mut self.next);
        Ok(audit)
    }

    fn solve_with_contact_stiffness(
        &mut self,
        model: &Model,
        state: &State,
        mean_load: &[f64],
        contacts: &mut dyn FnMut(&[f64], &mut [f64]),
        rate: &mut [f64],
    ) -> Result<u32, SolveError> {
        check_load(model, mean_load, state.time + self.dt)?;
        let (theta, dt, c) = (self.theta, self.dt, model.rayleigh());
        let (n, supports) = (state.u.len(), model.supports());
        for d in 0..n {
            self.work[d] = state.u[d] + (theta * dt + c.beta_k) * state.v[d];
        }
        model.stiffness_times(&self.work, &mut self.product);
        let mut force: Vec<f64> = (0..n).map(|d| mean_load[d] - self.product[d]).collect();
        if c.alpha_m > 0.0 {
            model.mass_times(&state.v, &mut self.product);
            (0..n).for_each(|d| force[d] -= c.alpha_m * self.product[d]);
        }
        if !model.matrices().dashpots().is_empty() {
            self.product.fill(0.0);
            model.dashpot_times(&state.v, &mut self.product);
            (0..n).for_each(|d| force[d] -= self.product[d]);
        }
        for (slot, &d) in self.equations.iter_mut().zip(supports.free()) {
            *slot = theta * dt * force[d as usize];
        }
        let scratch = [&mut self.work[..], &mut self.product];
        let added = Added { factor: theta * dt, times: contacts, scratch };
        let iterations = self.system.solve_with(supports, &mut self.equations, added, TOLERANCE)?;
        rate.copy_from_slice(&state.v);
        for (x, &d) in self.equations.iter().zip(supports.free()) {
            rate[d as usize] += x;
        }
        check_finite(model, "the velocity", rate, state.time + dt)?;
        Ok(iterations)
    }
}

impl TimeIntegrator for ThetaSolver {
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
}
