//! Newmark's implicit time integration, acceleration form.
//!
//! ```text
//! u1 = u0 + dt v0 + dt² ((1/2 - alpha) a0 + alpha a1)
//! v1 = v0 + dt ((1 - delta) a0 + delta a1)
//! M a1 + C v1 + K u1 = F1,  C = alpha_m M + beta_k K
//! ```
//!
//! One solve per step with `(1 + delta dt alpha_m) M + (alpha dt² + delta dt beta_k) K`, factored once per step size.
//!
//! Source: Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94; Hughes, The Finite Element Method (1987), section 9.1, whose
//! beta is alpha here and whose gamma is delta. Unconditionally stable for delta >= 1/2 and
//! alpha >= (delta + 1/2)²/4. The pair 1/4, 1/2 conserves the energy of a free linear body exactly and lengthens a period
//! by the fraction (w dt)²/12; larger delta damps the modes that the step cannot follow, and loses one order. Limits:
//! supports keep their prescribed values.

use crate::model::Model;
use crate::solver::cholesky::Cholesky;
use crate::solver::conjugate_gradient::solve_mass;
use crate::solver::{LinearSolver, SolveError};
use crate::state::State;
pub use crate::state::StepAudit;
use crate::statics::{check_finite, check_linear, check_load};
use thiserror::Error;

/// The two parameters of Newmark's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    /// Weight of the new acceleration in the displacement (beta of Hughes) [-].
    pub alpha: f64,
    /// Weight of the new acceleration in the velocity (gamma of Hughes) [-].
    pub delta: f64,
}

/// Parameters that are refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NewmarkError {
    /// Not unconditionally stable.
    #[error(
        "Newmark with alpha = {alpha}, delta = {delta} is not unconditionally stable: it needs delta >= 0.5 and \
         alpha >= 0.25 (0.5 + delta)^2 = {least_alpha}"
    )]
    Unstable {
        /// The alpha given.
        alpha: f64,
        /// The delta given.
        delta: f64,
        /// The least alpha for this delta.
        least_alpha: f64,
    },
    /// Negative, or not a finite number.
    #[error("Newmark's alpha = {alpha} and delta = {delta} must be finite numbers, 0 or above")]
    Range {
        /// The alpha given.
        alpha: f64,
        /// The delta given.
        delta: f64,
    },
}

impl Newmark {
    /// alpha = 1/4, delta = 1/2: second order, conserves energy.
    pub const AVERAGE_ACCELERATION: Newmark = Newmark { alpha: 0.25, delta: 0.5 };

    /// Checks that the method is stable for every step size.
    ///
    /// # Errors
    /// [`NewmarkError`], with the alpha that would be enough.
    pub fn check(self) -> Result<(), NewmarkError> {
        let Newmark { alpha, delta } = self;
        self.check_range()?;
        let least_alpha = 0.25 * (0.5 + delta) * (0.5 + delta);
        // A last digit lost in a scene file must not refuse 0.3025 for 0.6.
        if delta >= 0.5 && alpha >= least_alpha * (1.0 - 1e-12) {
            Ok(())
        } else {
            Err(NewmarkError::Unstable { alpha, delta, least_alpha })
        }
    }

    /// Checks only that both parameters are finite and 0 or above; the method may be stable for small steps alone.
    ///
    /// # Errors
    /// [`NewmarkError::Range`].
    pub fn check_range(self) -> Result<(), NewmarkError> {
        let Newmark { alpha, delta } = self;
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        if usable(alpha) && usable(delta) { Ok(()) } else { Err(NewmarkError::Range { alpha, delta }) }
    }
}

/// Holds the factor for one step size, and scratch.
pub struct NewmarkSolver {
    method: Newmark,
    dt: f64,
    factor: Cholesky,
    next: State,
    work: Vec<f64>,
    product: Vec<f64>,
    equations: Vec<f64>,
}

impl NewmarkSolver {
    /// Factors the matrix of the step `dt` [s].
    ///
    /// # Errors
    /// A method that is not unconditionally stable, a step that is not above 0, a material without density.
    pub fn new(model: &Model, method: Newmark, dt: f64) -> Result<NewmarkSolver, SolveError> {
        method.check()?;
        NewmarkSolver::conditionally_stable(model, method, dt)
    }

    /// As [`NewmarkSolver::new`], but accepts methods that are stable for small steps only; the caller answers for `dt`.
    ///
    /// # Errors
    /// Parameters below 0, a step that is not above 0, a material without density or with plasticity.
    pub fn conditionally_stable(
        model: &Model,
        method: Newmark,
        dt: f64,
    ) -> Result<NewmarkSolver, SolveError> {
        method.check_range()?;
        check_linear(model)?;
        check_dynamics(model, dt)?;
        let c = model.rayleigh();
        let stiffness = method.alpha * dt * dt + method.delta * dt * c.beta_k;
        let mass = 1.0 + method.delta * dt * c.alpha_m;
        let factor = factor(model, stiffness, mass)?;
        let n = model.dof_count();
        Ok(NewmarkSolver {
            method,
            dt,
            factor,
            next: State::new(model),
            work: vec![0.0; n],
            product: vec![0.0; n],
            equations: vec![0.0; model.free_dof_count()],
        })
    }

    /// The step [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// One step, from `state` to `state.time + dt`, under the load [N] at the *end* of the step, shape `[3 * nodes]`.
    ///
    /// The audit's work is that of the mean of the loads at both ends (the load at the start follows from the equations
    /// of motion there); with 1/4, 1/2 the numerical dissipation is then zero to rounding.
    ///
    /// # Errors
    /// A load or a result that is not finite; the state is untouched then.
    pub fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        load_end: &[f64],
    ) -> Result<StepAudit, SolveError> {
        check_load(model, load_end, state.time + self.dt)?;
        let (Newmark { alpha, delta }, dt, c) = (self.method, self.dt, model.rayleigh());
        let free = model.supports().free();
        let next = &mut self.next;
        // 1. Predict: the part of u1 and v1 that does not depend on a1.
        for d in 0..state.u.len() {
            next.u[d] = state.u[d] + dt * state.v[d] + dt * dt * (0.5 - alpha) * state.a[d];
            next.v[d] = state.v[d] + dt * (1.0 - delta) * state.a[d];
        }
        // 2. Residual of the prediction, with C v = alpha_m M v + beta_k K v folded into one product each.
        for d in 0..state.u.len() {
            self.work[d] = next.u[d] + c.beta_k * next.v[d];
        }
        model.stiffness_times(&self.work, &mut self.product);
        for (slot, &d) in self.equations.iter_mut().zip(free) {
            *slot = load_end[d as usize] - self.product[d as usize];
        }
        if c.alpha_m > 0.0 {
            model.mass_times(&next.v, &mut self.product);
            for (slot, &d) in self.equations.iter_mut().zip(free) {
                *slot -= c.alpha_m * self.product[d as usize];
            }
        }
        // 3. Solve for a1 and correct.
        self.factor.solve_in_place(&mut self.equations);
        next.a.fill(0.0);
        model.supports().scatter(&self.equations, &mut next.a);
        for d in 0..state.u.len() {
            next.u[d] += dt * dt * alpha * next.a[d];
            next.v[d] += dt * delta * next.a[d];
        }
        next.time = state.time + dt;
        check_finite(model, "the displacement", &next.u, next.time)?;
        let audit = audit(model, state, next, load_end, &mut self.work, &mut self.product);
        std::mem::swap(state, next);
        Ok(audit)
    }
}

/// Sets `state.a` from the equations of motion at the start: `M a = F - C v - K u` on the free dofs.
///
/// # Errors
/// A load of the wrong length or not finite, a material without density, or a mass matrix that cannot be solved.
pub fn initial_acceleration(model: &Model, state: &mut State, load: &[f64]) -> Result<(), SolveError> {
    check_load(model, load, state.time)?;
    check_linear(model)?;
    check_density(model)?;
    let c = model.rayleigh();
    let n = model.dof_count();
    let (mut force, mut product) = (load.to_vec(), vec![0.0; n]);
    let strained: Vec<f64> = state.u.iter().zip(&state.v).map(|(u, v)| u + c.beta_k * v).collect();
    model.stiffness_times(&strained, &mut product);
    force.iter_mut().zip(&product).for_each(|(f, p)| *f -= p);
    model.mass_times(&state.v, &mut product);
    force.iter_mut().zip(&product).for_each(|(f, p)| *f -= c.alpha_m * p);
    solve_mass(model.matrices(), model.supports(), &force, &mut state.a)
}

/// Energy that entered and left between two states under the mean of their loads.
fn audit(
    model: &Model,
    old: &State,
    new: &State,
    load_end: &[f64],
    work: &mut [f64],
    product: &mut [f64],
) -> StepAudit {
    let c = model.rayleigh();
    let n = old.u.len();
    let dot = |a: &dyn Fn(usize) -> f64, p: &[f64]| (0..n).map(|d| a(d) * p[d]).sum::<f64>();
    let mean_v = |d: usize| 0.5 * (old.v[d] + new.v[d]);
    // K du and M du serve every term, because the matrices are symmetric.
    for d in 0..n {
        work[d] = new.u[d] - old.u[d];
    }
    let work_end = dot(&|d| load_end[d], work);
    model.stiffness_times(work, product);
    let strain = dot(&|d| 0.5 * (old.u[d] + new.u[d]), product);
    let mut damping = c.beta_k * dot(&mean_v, product);
    let mut work_start = dot(&|d| old.u[d] + c.beta_k * old.v[d], product);
    model.mass_times(work, product);
    damping += c.alpha_m * dot(&mean_v, product);
    work_start += dot(&|d| old.a[d] + c.alpha_m * old.v[d], product);
    for d in 0..n {
        work[d] = new.v[d] - old.v[d];
    }
    model.mass_times(work, product);
    let kinetic = dot(&mean_v, product);
    let external_work = 0.5 * (work_start + work_end);
    StepAudit {
        external_work,
        damping_dissipation: damping,
        numerical_dissipation: external_work - damping - kinetic - strain,
    }
}

pub(crate) fn factor(model: &Model, stiffness: f64, mass: f64) -> Result<Cholesky, SolveError> {
    Cholesky::factor(model.analysis()?, model.mesh(), model.matrices(), model.supports(), stiffness, mass)
}

pub(crate) fn check_dynamics(model: &Model, dt: f64) -> Result<(), SolveError> {
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(SolveError::TimeStep { dt });
    }
    check_density(model)
}

fn check_density(model: &Model) -> Result<(), SolveError> {
    let used = |m: &u32| model.mesh().materials.contains(m);
    match model.materials().iter().find(|(m, constants)| constants.elastic.density <= 0.0 && used(m)) {
        Some((&material, _)) => Err(SolveError::NoMass { material }),
        None => Ok(()),
    }
}
