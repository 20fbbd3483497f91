//! One implicit step under the mean load of a time window: the solid's part of a coupled step.
//!
//! ```text
//! M (v1 - v0)/dt + C vt + K ut = F_mean
//! vt = (1 - theta) v0 + theta v1,   ut = u0 + theta dt vt,   u1 = u0 + dt vt
//! ```
//!
//! Only the impulse `F_mean dt` of the window enters, so the impulse that the other side felt is handed over exactly.
//! One solve with `M/(theta dt) + C + theta dt K` for `w = vt - v0`, so rounding stays relative to the change.
//!
//! Energy: multiplying by `du = dt vt` gives, without approximation,
//! `work = change of (kinetic + strain) + dt vt·C vt + (theta - 1/2)(|dv|²_M + |du|²_K)`.
//! theta = 1/2 is Newmark's 1/4, 1/2 for a load that is constant over the step, and conserves energy; larger theta
//! damps what the step cannot follow, theta = 1 is backward Euler.
//!
//! Source: Simo and Tarnow, Z. angew. Math. Phys. 43 (1992) 757-792 (mid-point form and its energy); the terms in
//! (theta - 1/2) follow from `(1 - theta) v0 + theta v1 = (v0 + v1)/2 + (theta - 1/2)(v1 - v0)` and the same for u.
//! Limits: second order for theta = 1/2 only; supports keep their prescribed values.

use crate::model::Model;
use crate::newmark::{check_dynamics, factor};
use crate::solver::cholesky::Cholesky;
use crate::solver::{LinearSolver, SolveError};
use crate::state::{State, StepAudit};
use crate::statics::{check_finite, check_linear, check_load};

/// Holds the factor for one window length, and scratch.
pub struct WindowSolver {
    theta: f64,
    dt: f64,
    factor: Cholesky,
    next: State,
    work: Vec<f64>,
    product: Vec<f64>,
    equations: Vec<f64>,
}

impl WindowSolver {
    /// Factors the matrix of windows of length `dt` [s], with `theta` from 1/2 (no numerical damping) to 1.
    ///
    /// # Errors
    /// theta out of range, a length that is not above 0, a material without density or with plasticity.
    pub fn new(model: &Model, theta: f64, dt: f64) -> Result<WindowSolver, SolveError> {
        if !(0.5..=1.0).contains(&theta) {
            return Err(SolveError::Theta { theta });
        }
        check_linear(model)?;
        check_dynamics(model, dt)?;
        let c = model.rayleigh();
        // The equation is multiplied by theta dt, so that the mass has the factor 1 as in Newmark's method.
        let stiffness = theta * dt * (theta * dt + c.beta_k);
        let factor = factor(model, stiffness, 1.0 + theta * dt * c.alpha_m)?;
        let n = model.dof_count();
        Ok(WindowSolver {
            theta,
            dt,
            factor,
            next: State::new(model),
            work: vec![0.0; n],
            product: vec![0.0; n],
            equations: vec![0.0; model.free_dof_count()],
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

    /// One step under the mean load [N] of the window, shape `[3 * nodes]`. `state.a` becomes the mean acceleration.
    ///
    /// # Errors
    /// A load or a result that is not finite; the state is untouched then.
    pub fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
    ) -> Result<StepAudit, SolveError> {
        check_load(model, mean_load, state.time + self.dt)?;
        let (theta, dt, c) = (self.theta, self.dt, model.rayleigh());
        let n = state.u.len();
        // 1. Residual with vt = v0.
        for d in 0..n {
            self.work[d] = state.u[d] + (theta * dt + c.beta_k) * state.v[d];
        }
        model.stiffness_times(&self.work, &mut self.product);
        for (slot, &d) in self.equations.iter_mut().zip(model.supports().free()) {
            *slot = theta * dt * (mean_load[d as usize] - self.product[d as usize]);
        }
        if c.alpha_m > 0.0 {
            model.mass_times(&state.v, &mut self.product);
            for (slot, &d) in self.equations.iter_mut().zip(model.supports().free()) {
                *slot -= theta * dt * c.alpha_m * self.product[d as usize];
            }
        }
        // 2. Solve for w = vt - v0 = theta (v1 - v0), and advance.
        self.factor.solve_in_place(&mut self.equations);
        let next = &mut self.next;
        next.a.fill(0.0);
        model.supports().scatter(&self.equations, &mut next.a);
        for d in 0..n {
            let change = next.a[d] / theta;
            self.work[d] = dt * (state.v[d] + next.a[d]);
            next.u[d] = state.u[d] + self.work[d];
            next.v[d] = state.v[d] + change;
            next.a[d] = change / dt;
        }
        next.time = state.time + dt;
        check_finite(model, "the displacement", &next.u, next.time)?;
        let audit = self.audit(model, state, mean_load);
        std::mem::swap(state, &mut self.next);
        Ok(audit)
    }

    /// Work, damping and numerical dissipation; expects du in `work`. Forms that a term does not need are left out.
    fn audit(&mut self, model: &Model, old: &State, mean_load: &[f64]) -> StepAudit {
        let (dt, c, matrices) = (self.dt, model.rayleigh(), model.matrices());
        let excess = self.theta - 0.5;
        let external_work = mean_load.iter().zip(&self.work).map(|(f, du)| f * du).sum();
        let mut audit = StepAudit { external_work, ..StepAudit::default() };
        if c.beta_k > 0.0 || excess > 0.0 {
            let strain = matrices.stiffness_form(&self.work);
            audit.damping_dissipation += c.beta_k * strain / dt;
            audit.numerical_dissipation += excess * strain;
        }
        if c.alpha_m > 0.0 {
            audit.damping_dissipation += c.alpha_m * matrices.mass_form(&self.work) / dt;
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
