//! θ-method in the basis of a reduced body.
//!
//! ```text
//! u = rest + V q,   w = V (q'_mean - q')
//! (1 + θ dt α + θ dt (θ dt + β) s_k) w_k + θ dt (D w)_k
//!     = θ dt (Vᵀ F - Vᵀ K rest - s_k (q + θ dt q')_k - (α + β s_k) q'_k - (D q')_k)
//! ```
//!
//! s_k squared frequencies, α and β Rayleigh coefficients, D dashpots. Steps read and write only the contact
//! surface and other loaded dofs; the rest of the solid follows on demand.

use super::{Stored, ThetaMethod, check_theta};
use crate::error::SolveError;
use crate::integrator::{Loading, OnStep, StepReport, TimeIntegrator};
use crate::model::Model;
use crate::newmark::check_dynamics;
use crate::reduction::{OutOfBalance, ReducedModel};
use crate::solver::kernels::{subtract_product, subtract_transposed};
use crate::state::{Coordinates, State, StepAudit};
use crate::statics::{check_linear, check_load};
use crate::supports::{CONSTRAINED, name};
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
    /// Load that always acts [N] and its part in the basis.
    dead_load: Vec<f64>,
    dead: Vec<f64>,
    /// Vᵀ K rest; empty before the first step.
    held: Vec<f64>,
    /// Strain energy and work of the dead load of that displacement [J].
    of_rest: [f64; 2],
    /// Dofs that steps read and write, and V on them.
    rows: Rows,
    velocity: DVector<f64>,
    mean: DVector<f64>,
    right: DVector<f64>,
    next: Coordinates,
    /// −q, −q', −q'' of each shape, at the end and in the mean of the step.
    negative: [Vec<f64>; 2],
    /// Whether there was a step.
    stepped: bool,
}

/// Dofs with their rows of V.
#[derive(Default)]
struct Rows {
    /// Ascending.
    dofs: Vec<u32>,
    listed: Vec<bool>,
    /// Shape `[shapes][dofs]`.
    shape: Vec<f64>,
    load: Vec<f64>,
    /// u − rest, v, a of each dof.
    motion: Vec<f64>,
}

impl Rows {
    fn new(reduced: &ReducedModel, mut dofs: Vec<u32>, all: usize) -> Rows {
        dofs.sort_unstable();
        let mut listed = vec![false; all];
        dofs.iter().for_each(|&d| listed[d as usize] = true);
        let shape =
            reduced.shape.chunks_exact(all).flat_map(|v| dofs.iter().map(|&d| v[d as usize])).collect();
        Rows { listed, shape, load: vec![0.0; dofs.len()], motion: vec![0.0; 3 * dofs.len()], dofs }
    }

    /// Writes the motion of the coordinates, given with opposite sign.
    fn follow(&mut self, negative: &[f64]) {
        self.motion.fill(0.0);
        subtract_product::<3>(&self.shape, self.dofs.len(), negative, &mut self.motion);
    }

    fn copy_to(&self, state: &mut State) {
        for (&[u, v, a], &d) in self.motion.as_chunks::<3>().0.iter().zip(&self.dofs) {
            let d = d as usize;
            state.u[d] = state.reduced.rest[d] + u;
            (state.v[d], state.a[d]) = (v, a);
        }
    }
}

impl ReducedTheta {
    /// Builds a solver for windows `dt` [s], `theta` from 1/2 (undamped) to 1, with a load that always acts [N],
    /// shape `[3 * nodes]`.
    ///
    /// # Errors
    /// theta out of range, length not above 0, plastic material, another model.
    pub fn new(
        model: &Model,
        reduced: Arc<ReducedModel>,
        theta: f64,
        dt: f64,
        dead_load: &[f64],
    ) -> Result<ReducedTheta, SolveError> {
        check_theta(theta)?;
        check_linear(model)?;
        check_dynamics(model, dt)?;
        check_load(model, dead_load, 0.0)?;
        let (n, c, h) = (model.dof_count(), model.rayleigh(), theta * dt);
        let count = reduced.count();
        if reduced.shape.len() != n * count {
            let (what, found) = ("reduction of another model", reduced.shape.len());
            return Err(SolveError::Length { what, found, expected: n * count });
        }
        let diagonal: Vec<f64> =
            reduced.square.iter().map(|s| 1.0 + h * c.alpha_m + h * (h + c.beta_k) * s).collect();
        let factor = reduced.dashpots.as_ref().map(|d| {
            let matrix = DMatrix::from_diagonal(&DVector::from_column_slice(&diagonal)) + d * h;
            // Positive definite: diagonal above 1, dissipative damping.
            linalg::Cholesky::new(matrix).expect("a damped body at rest")
        });
        Ok(ReducedTheta {
            theta,
            dt,
            report: StepReport::linear(0.0, dt),
            diagonal,
            factor,
            dead_load: dead_load.to_vec(),
            dead: reduced.project(dead_load),
            held: Vec::new(),
            of_rest: [0.0; 2],
            rows: Rows::new(&reduced, reduced.surface.clone(), n),
            velocity: DVector::zeros(count),
            mean: DVector::zeros(count),
            right: DVector::zeros(count),
            next: Coordinates::at_rest(Vec::new(), count),
            negative: [vec![0.0; 3 * count], vec![0.0; 3 * count]],
            stepped: false,
            reduced,
        })
    }

    /// Velocity outside the basis is lost.
    fn begin(&mut self, model: &Model, state: &mut State) {
        if state.reduced.position.len() != self.reduced.count() {
            state.reduced = self.reduced.coordinates(model, state);
            self.held.clear();
        }
        if self.held.is_empty() {
            let rest = &state.reduced.rest;
            let mut force = vec![0.0; rest.len()];
            model.stiffness_times(rest, &mut force);
            self.held = self.reduced.project(&force);
            self.of_rest = [0.5 * dot(rest, &force), dot(rest, &self.dead_load)];
        }
    }

    /// Adds dofs to those that steps read and write.
    fn list(&mut self, model: &Model, state: &mut State, acts: impl Fn(usize) -> bool) {
        let free = model.supports().free_index();
        let mut missing = Vec::new();
        for d in 0..state.u.len() {
            if acts(d) && !self.rows.listed[d] && free[d] != CONSTRAINED {
                missing.push(d as u32);
            }
        }
        if missing.is_empty() {
            return;
        }
        let dofs = self.rows.dofs.iter().copied().chain(missing).collect();
        self.rows = Rows::new(&self.reduced, dofs, state.u.len());
        if !state.reduced.position.is_empty() {
            state.reduced.negate_into(&mut self.negative[0]);
            self.rows.follow(&self.negative[0]);
            self.rows.copy_to(state);
        }
    }

    /// Solves for the change of the mean velocity, in `right`.
    fn solve(&mut self, model: &Model, q: &Coordinates) {
        let (c, h) = (model.rayleigh(), self.theta * self.dt);
        let r = &*self.reduced;
        self.velocity.as_mut_slice().copy_from_slice(&q.velocity);
        let right = self.right.as_mut_slice();
        right.fill(0.0);
        subtract_transposed::<1>(&self.rows.shape, self.rows.dofs.len(), right, &self.rows.load);
        for k in 0..r.count() {
            let (s, v) = (r.square[k], q.velocity[k]);
            let inner = self.held[k] + s * (q.position[k] + h * v) + (c.alpha_m + c.beta_k * s) * v;
            right[k] = self.dead[k] - right[k] - inner;
        }
        if let Some(dashpots) = &r.dashpots {
            self.right.gemv(-1.0, dashpots, &self.velocity, 1.0);
        }
        self.right *= h;
        match &self.factor {
            Some(factor) => factor.solve_mut(&mut self.right),
            None => self.right.iter_mut().zip(&self.diagonal).for_each(|(x, d)| *x /= d),
        }
    }

    /// Dissipation of the step; work of the dead load.
    fn audit(&mut self, model: &Model) -> StepAudit {
        let (dt, c, excess) = (self.dt, model.rayleigh(), self.theta - 0.5);
        let r = &*self.reduced;
        let mut audit = StepAudit::default();
        for k in 0..r.count() {
            let (mean, step) = (self.mean[k], self.right[k] / self.theta);
            audit.external_work += self.dead[k] * dt * mean;
            audit.damping_dissipation += dt * (c.alpha_m + c.beta_k * r.square[k]) * mean * mean;
            audit.numerical_dissipation += excess * (step * step + dt * dt * r.square[k] * mean * mean);
        }
        if let Some(dashpots) = &r.dashpots {
            self.velocity.gemv(1.0, dashpots, &self.mean, 0.0);
            audit.boundary_dissipation = dt * self.mean.dot(&self.velocity);
        }
        audit
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl ThetaMethod for ReducedTheta {
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
        if let Some(values) = prescribed {
            let (what, expected) = ("the number of moved supports of a reduced body", "0");
            return Err(SolveError::Option { what, value: values.len() as f64, expected });
        }
        check_load(model, mean_load, state.time + self.dt)?;
        self.begin(model, state);
        let dead_load = std::mem::take(&mut self.dead_load);
        self.list(model, state, |d| mean_load[d] != dead_load[d]);
        for (f, &d) in self.rows.load.iter_mut().zip(&self.rows.dofs) {
            *f = mean_load[d as usize] - dead_load[d as usize];
        }
        self.dead_load = dead_load;
        let (theta, dt) = (self.theta, self.dt);
        let h = theta * dt;
        let q = &state.reduced;
        self.solve(model, q);
        for k in 0..self.reduced.count() {
            let w = self.right[k];
            let mean = q.velocity[k] + w;
            self.mean[k] = mean;
            self.next.position[k] = q.position[k] + dt * mean;
            self.next.velocity[k] = q.velocity[k] + w / theta;
            self.next.acceleration[k] = w / h;
            self.negative[1][3 * k..3 * k + 3].copy_from_slice(&[-(q.position[k] + h * mean), -mean, -w / h]);
        }
        self.next.negate_into(&mut self.negative[0]);
        self.rows.follow(&self.negative[0]);
        let time = state.time + dt;
        if let Some(i) = self.rows.motion.iter().position(|x| !x.is_finite()) {
            let (node, direction) = name(model.mesh(), self.rows.dofs[i / 3] as usize);
            return Err(SolveError::NotFinite { what: "the displacement", node, direction, time });
        }
        let mut audit = self.audit(model);
        for ((&[u, ..], &f), &d) in
            self.rows.motion.as_chunks::<3>().0.iter().zip(&self.rows.load).zip(&self.rows.dofs)
        {
            audit.external_work += f * (q.rest[d as usize] + u - state.u[d as usize]);
        }
        self.next.swap_motion(&mut state.reduced);
        state.time = time;
        self.rows.copy_to(state);
        self.stepped = true;
        Ok(audit)
    }

    fn keep_current(&mut self, model: &Model, state: &mut State, load: &[f64]) {
        self.list(model, state, |d| load[d] != 0.0);
    }

    fn recover(&self, state: &mut State) {
        self.reduced.recover(state, &self.rows.listed);
    }

    fn stored(&self, state: &State) -> Option<Stored> {
        let q = &state.reduced;
        let begun = q.position.len() == self.held.len() && !self.held.is_empty();
        let elastic: f64 = q.position.iter().zip(&self.reduced.square).map(|(q, s)| s * q * q).sum();
        begun.then(|| Stored {
            kinetic: 0.5 * dot(&q.velocity, &q.velocity),
            strain: self.of_rest[0] + dot(&self.held, &q.position) + 0.5 * elastic,
            dead_load_work: self.of_rest[1] + dot(&self.dead, &q.position),
        })
    }

    fn out_of_balance(&self, model: &Model, state: &State, mean_load: &[f64]) -> Option<OutOfBalance> {
        self.stepped.then(|| self.reduced.out_of_balance(model, state, mean_load, &self.negative[1]))
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
