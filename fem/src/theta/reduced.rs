//! θ-method in the basis of a reduced body.
//!
//! ```text
//! w = V q'
//! (1 + θ dt α + θ dt (θ dt + β) s_k) q'_k + θ dt (D q')_k
//!     = θ dt (Vᵀ F - Vᵀ K (u0 + θ dt v0) - (α + β s_k) p_k - (D p)_k)
//! ```
//!
//! s_k squared frequencies, p = Vᵀ M v0, α and β Rayleigh coefficients, D dashpots.

use super::{ThetaMethod, check_theta};
use crate::error::SolveError;
use crate::integrator::{Loading, OnStep, StepReport, TimeIntegrator};
use crate::model::Model;
use crate::newmark::check_dynamics;
use crate::reduction::ReducedModel;
use crate::state::{State, StepAudit};
use crate::statics::{check_finite, check_linear, check_load};
use nalgebra::{DMatrix, DVector, Dyn, linalg};
use std::sync::Arc;

/// Reduced θ-method of one window length.
pub struct ReducedTheta {
    theta: f64,
    dt: f64,
    report: StepReport,
    reduced: Arc<ReducedModel>,
    diagonal: Vec<f64>,
    factor: Option<linalg::Cholesky<f64, Dyn>>,
    next: State,
    velocity: DVector<f64>,
    mean: DVector<f64>,
    right: DVector<f64>,
}

impl ReducedTheta {
    /// Builds a solver for windows `dt` [s], `theta` from 1/2 (undamped) to 1.
    ///
    /// # Errors
    /// theta out of range, length not above 0, plastic material.
    pub fn new(
        model: &Model,
        reduced: Arc<ReducedModel>,
        theta: f64,
        dt: f64,
    ) -> Result<ReducedTheta, SolveError> {
        check_theta(theta)?;
        check_linear(model)?;
        check_dynamics(model, dt)?;
        let (n, c, h) = (model.dof_count(), model.rayleigh(), theta * dt);
        if reduced.shape.len() != n * reduced.count() {
            let (what, found) = ("reduction of another model", reduced.shape.len());
            return Err(SolveError::Length { what, found, expected: n * reduced.count() });
        }
        let diagonal: Vec<f64> =
            reduced.square.iter().map(|s| 1.0 + h * c.alpha_m + h * (h + c.beta_k) * s).collect();
        let factor = reduced.dashpots.as_ref().map(|d| {
            let matrix = DMatrix::from_diagonal(&DVector::from_column_slice(&diagonal)) + d * h;
            // Positive definite: diagonal above 1, dissipative damping.
            linalg::Cholesky::new(matrix).expect("a damped body at rest")
        });
        let count = reduced.count();
        Ok(ReducedTheta {
            theta,
            dt,
            report: StepReport::linear(0.0, dt),
            reduced,
            diagonal,
            factor,
            next: State::new(model),
            velocity: DVector::zeros(count),
            mean: DVector::zeros(count),
            right: DVector::zeros(count),
        })
    }
}

impl ThetaMethod for ReducedTheta {
    fn dt(&self) -> f64 {
        self.dt
    }

    fn report(&mut self) -> &mut StepReport {
        &mut self.report
    }

    /// Velocity outside the basis is lost.
    fn step_prescribed(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<StepAudit, SolveError> {
        if let Some(values) = prescribed {
            let (what, expected) = ("the number of moved supports of a reduced body", "0");
            return Err(SolveError::Option { what, value: values.len() as f64, expected });
        }
        check_load(model, mean_load, state.time + self.dt)?;
        let (theta, dt, c) = (self.theta, self.dt, model.rayleigh());
        let h = theta * dt;
        let r = &*self.reduced;
        let count = r.count();
        let (velocity, right) = (self.velocity.as_mut_slice(), self.right.as_mut_slice());
        velocity.fill(0.0);
        right.fill(0.0);
        let rows = r.shape.chunks_exact(count).zip(r.force.chunks_exact(count));
        for (d, ((v, kv), mv)) in rows.zip(r.momentum.chunks_exact(count)).enumerate() {
            let (f, x, speed) = (mean_load[d], state.u[d] + h * state.v[d], state.v[d]);
            for k in 0..count {
                right[k] += f * v[k] - x * kv[k];
                velocity[k] += speed * mv[k];
            }
        }
        for k in 0..count {
            right[k] -= (c.alpha_m + c.beta_k * r.square[k]) * velocity[k];
        }
        if let Some(dashpots) = &r.dashpots {
            self.right.gemv(-1.0, dashpots, &self.velocity, 1.0);
        }
        self.right *= h;
        match &self.factor {
            Some(factor) => factor.solve_mut(&mut self.right),
            None => self.right.iter_mut().zip(&self.diagonal).for_each(|(x, d)| *x /= d),
        }
        let (velocity, change) = (self.velocity.as_slice(), self.right.as_slice());
        let next = &mut self.next;
        let mut external_work = 0.0;
        for (d, v) in r.shape.chunks_exact(count).enumerate() {
            let (mut before, mut w) = (0.0, 0.0);
            for k in 0..count {
                before += v[k] * velocity[k];
                w += v[k] * change[k];
            }
            let du = dt * (before + w);
            next.u[d] = state.u[d] + du;
            next.v[d] = before + w / theta;
            next.a[d] = w / h;
            external_work += mean_load[d] * du;
        }
        next.time = state.time + dt;
        check_finite(model, "the displacement", &next.u, next.time)?;
        let excess = theta - 0.5;
        let mut audit = StepAudit { external_work, ..StepAudit::default() };
        for k in 0..count {
            let (mean, step) = (velocity[k] + change[k], change[k] / theta);
            self.mean[k] = mean;
            audit.damping_dissipation += dt * (c.alpha_m + c.beta_k * r.square[k]) * mean * mean;
            audit.numerical_dissipation += excess * (step * step + dt * dt * r.square[k] * mean * mean);
        }
        if let Some(dashpots) = &r.dashpots {
            self.velocity.gemv(1.0, dashpots, &self.mean, 0.0);
            audit.boundary_dissipation = dt * self.mean.dot(&self.velocity);
        }
        std::mem::swap(state, &mut self.next);
        Ok(audit)
    }
}

impl TimeIntegrator for ReducedTheta {
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
