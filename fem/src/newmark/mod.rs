//! Newmark's implicit time integration (acceleration form) and HHT-α.
//!
//! ```text
//! u1 = u0 + dt v0 + dt² ((1/2 - beta) a0 + beta a1)
//! v1 = v0 + dt ((1 - gamma) a0 + gamma a1)
//! M a1 + C vw + K uw = Fw,  C = alpha_m M + beta_k K + D,  xw = (1 + a) x1 - a x0 for x = u, v, F
//! ```
//!
//! HHT-α has a in [-1/3, 0], beta = (1 - a)²/4, gamma = 1/2 - a. System matrix:
//! `(1 + w gamma dt alpha_m) M + w (beta dt² + gamma dt beta_k) K + w gamma dt D`, w = 1 + a.
//!
//! Source: Newmark (1959); Hughes (1987), sections 9.1 and 9.3 (loads); Hilber, Hughes and Taylor (1977).
//! Unconditionally stable for gamma >= 1/2 and beta >= (gamma + 1/2)²/4. 1/4, 1/2 conserves energy. Limits:
//! for gamma = 1/2, jumps of prescribed displacement leave oscillating accelerations.
//!
//! Theory manual: equation (4.6) of `docs/theory/solid.md`.

mod method;
mod start;

use crate::assembly::Combination;
use crate::energy::inner_force;
use crate::equations::system::{IterationCounts, SystemSolver};
pub use crate::error::NewmarkError;
use crate::error::SolveError;
use crate::integrator::{Conditions, Loading, OnStep, StepReport, TimeIntegrator, steps_of};
use crate::model::Model;
use crate::state::State;
pub use crate::state::StepAudit;
use crate::statics::{check_finite, check_linear, check_load, check_prescribed};
pub use method::Newmark;
pub(crate) use start::accelerate;
pub use start::{initial_acceleration, initial_acceleration_prescribed};

/// Loads and prescribed motion of one step.
#[derive(Clone, Copy, Debug)]
pub struct StepLoads<'a> {
    /// Initial load [N], shape `[3 * nodes]`; required by HHT-α only.
    pub load_start: Option<&'a [f64]>,
    /// Final load [N], shape `[3 * nodes]`.
    pub load_end: &'a [f64],
    /// Final displacements [m] ordered as [`crate::supports::Supports::fixed`]; `None`: unchanged.
    pub prescribed: Option<&'a [f64]>,
}

/// Newmark solver with the factor of one step size.
pub struct NewmarkSolver {
    method: Newmark,
    hht: f64,
    dt: f64,
    system: Box<dyn SystemSolver>,
    next: State,
    work: Vec<f64>,
    product: Vec<f64>,
    /// For moved supports only.
    inner: Vec<f64>,
    equations: Vec<f64>,
    conditions: Conditions,
}

impl NewmarkSolver {
    /// Factors the matrix of the step `dt` [s].
    ///
    /// # Errors
    /// Conditionally stable method, step not above 0, or material without density.
    pub fn new(model: &Model, method: Newmark, dt: f64) -> Result<NewmarkSolver, SolveError> {
        method.check()?;
        NewmarkSolver::conditionally_stable(model, method, dt)
    }

    /// Like [`NewmarkSolver::new`], also for conditionally stable methods.
    ///
    /// # Errors
    /// Parameters below 0, step not above 0, material without density or with plasticity.
    pub fn conditionally_stable(
        model: &Model,
        method: Newmark,
        dt: f64,
    ) -> Result<NewmarkSolver, SolveError> {
        method.check_range()?;
        NewmarkSolver::build(model, method, 0.0, dt)
    }

    /// HHT-α with `alpha` in [-1/3, 0]; use [`NewmarkSolver::advance`] with loads at both ends.
    ///
    /// # Errors
    /// Parameter out of range, step not above 0, material without density or with plasticity.
    pub fn hht(model: &Model, alpha: f64, dt: f64) -> Result<NewmarkSolver, SolveError> {
        NewmarkSolver::build(model, Newmark::of_hht_in_range(alpha)?, alpha, dt)
    }

    fn build(model: &Model, method: Newmark, hht: f64, dt: f64) -> Result<NewmarkSolver, SolveError> {
        check_linear(model)?;
        check_dynamics(model, dt)?;
        let (c, w) = (model.rayleigh(), 1.0 + hht);
        let combination = Combination {
            stiffness: w * (method.beta * dt * dt + method.gamma * dt * c.beta_k),
            mass: 1.0 + w * method.gamma * dt * c.alpha_m,
            dashpots: w * method.gamma * dt,
        };
        let n = model.dof_count();
        Ok(NewmarkSolver {
            method,
            hht,
            dt,
            system: model.step_solver(combination)?,
            next: State::new(model),
            work: vec![0.0; n],
            product: vec![0.0; n],
            inner: Vec::new(),
            equations: vec![0.0; model.free_dof_count()],
            conditions: Conditions::default(),
        })
    }

    /// CG counts, if selected.
    pub fn counts(&self) -> Option<IterationCounts> {
        self.system.counts()
    }

    /// Step [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Parameter pair, for HHT-α from [`Newmark::of_hht`].
    pub fn method(&self) -> Newmark {
        self.method
    }

    /// HHT α; 0 for Newmark.
    pub fn hht_alpha(&self) -> f64 {
        self.hht
    }

    /// Advances `state` by `dt` under the final load [N], shape `[3 * nodes]`, with fixed supports.
    ///
    /// # Errors
    /// Load or result not finite (state unchanged); HHT-α needs [`NewmarkSolver::advance`].
    pub fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        load_end: &[f64],
    ) -> Result<StepAudit, SolveError> {
        self.advance(model, state, StepLoads { load_start: None, load_end, prescribed: None })
    }

    /// Advances `state` by `dt` under loads and prescribed motion; the audit uses mean forces.
    ///
    /// # Errors
    /// Values not finite, missing initial load (HHT-α), or prescribed motion for beta = 0; state unchanged.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        drive: StepLoads<'_>,
    ) -> Result<StepAudit, SolveError> {
        self.check(model, state, &drive)?;
        let (Newmark { beta, gamma }, dt, c) = (self.method, self.dt, model.rayleigh());
        let (new, old) = (1.0 + self.hht, -self.hht);
        let (supports, free) = (model.supports(), model.supports().free());
        let next = &mut self.next;
        // Predictor: terms without a1.
        for d in 0..state.u.len() {
            next.u[d] = state.u[d] + dt * state.v[d] + dt * dt * (0.5 - beta) * state.a[d];
            next.v[d] = state.v[d] + dt * (1.0 - gamma) * state.a[d];
        }
        // At supports, a1 follows from the final displacement.
        next.a.fill(0.0);
        let mut accelerated = false;
        for (i, &(dof, _)) in supports.fixed().iter().enumerate() {
            let d = dof as usize;
            let end = drive.prescribed.map_or(state.u[d], |p| p[i]);
            let gap = end - next.u[d];
            if gap != 0.0 && beta > 0.0 {
                next.a[d] = gap / (dt * dt * beta);
                next.u[d] = end;
                next.v[d] += dt * gamma * next.a[d];
                accelerated = true;
            }
        }
        for d in 0..state.u.len() {
            let (u, v) = (new * next.u[d] + old * state.u[d], new * next.v[d] + old * state.v[d]);
            self.work[d] = u + c.beta_k * v;
        }
        model.stiffness_times(&self.work, &mut self.product);
        let load_start = drive.load_start.unwrap_or(drive.load_end);
        for (slot, &d) in self.equations.iter_mut().zip(free) {
            let d = d as usize;
            *slot = new * drive.load_end[d] + old * load_start[d] - self.product[d];
        }
        if c.alpha_m > 0.0 || accelerated {
            for d in 0..state.u.len() {
                self.work[d] = next.a[d] + c.alpha_m * (new * next.v[d] + old * state.v[d]);
            }
            model.mass_times(&self.work, &mut self.product);
            subtract(&mut self.equations, &self.product, free);
        }
        if !model.matrices().dashpots().is_empty() {
            for d in 0..state.u.len() {
                self.work[d] = new * next.v[d] + old * state.v[d];
            }
            self.product.fill(0.0);
            model.dashpot_times(&self.work, &mut self.product);
            subtract(&mut self.equations, &self.product, free);
        }
        self.system.solve(supports, &mut self.equations, &|d| state.a[d])?;
        for (&a, &d) in self.equations.iter().zip(free) {
            let d = d as usize;
            next.a[d] = a;
            next.u[d] += dt * dt * beta * a;
            next.v[d] += dt * gamma * a;
        }
        next.time = state.time + dt;
        check_finite(model, "the displacement", &next.u, next.time)?;
        let audit = self.audit(model, state, &drive);
        std::mem::swap(state, &mut self.next);
        Ok(audit)
    }

    fn check(&self, model: &Model, state: &State, drive: &StepLoads<'_>) -> Result<(), SolveError> {
        let end = state.time + self.dt;
        check_load(model, drive.load_end, end)?;
        if let Some(load) = drive.load_start {
            check_load(model, load, state.time)?;
        } else if self.hht != 0.0 {
            return Err(NewmarkError::LoadAtStart.into());
        }
        check_prescribed(model, drive.prescribed, end)?;
        if drive.prescribed.is_some() && self.method.beta == 0.0 {
            return Err(NewmarkError::Prescribed.into());
        }
        Ok(())
    }

    /// Energy terms with mean forces.
    fn audit(&mut self, model: &Model, old: &State, drive: &StepLoads<'_>) -> StepAudit {
        let (new, c, n) = (&self.next, model.rayleigh(), old.u.len());
        let (work, product) = (&mut self.work, &mut self.product);
        let dot = |a: &dyn Fn(usize) -> f64, p: &[f64]| (0..n).map(|d| a(d) * p[d]).sum::<f64>();
        let mean_v = |d: usize| 0.5 * (old.v[d] + new.v[d]);
        for d in 0..n {
            work[d] = new.u[d] - old.u[d];
        }
        let work_end = dot(&|d| drive.load_end[d], work);
        model.stiffness_times(work, product);
        let strain = dot(&|d| 0.5 * (old.u[d] + new.u[d]), product);
        let mut damping = c.beta_k * dot(&mean_v, product);
        let mut work_start = dot(&|d| old.u[d] + c.beta_k * old.v[d], product);
        model.mass_times(work, product);
        damping += c.alpha_m * dot(&mean_v, product);
        work_start += dot(&|d| old.a[d] + c.alpha_m * old.v[d], product);
        let mut boundary = 0.0;
        if !model.matrices().dashpots().is_empty() {
            product.fill(0.0);
            model.dashpot_times(work, product);
            work_start += dot(&|d| old.v[d], product);
            (0..n).for_each(|d| product[d] = mean_v(d));
            boundary = self.dt * model.matrices().dashpots().form(product);
        }
        for d in 0..n {
            work[d] = new.v[d] - old.v[d];
        }
        model.mass_times(work, product);
        let kinetic = dot(&mean_v, product);

        let fixed = model.supports().fixed();
        let moved = |&(dof, _): &(u32, f64)| new.u[dof as usize] != old.u[dof as usize];
        let mut support_work = 0.0;
        if fixed.iter().any(moved) {
            self.inner.resize(4 * n, 0.0);
            let (start, rest) = self.inner.split_at_mut(n);
            let (end, scratch) = rest.split_at_mut(n);
            inner_force(model, [&old.u, &old.v, &old.a], start, scratch);
            inner_force(model, [&new.u, &new.v, &new.a], end, scratch);
            for d in fixed.iter().map(|&(dof, _)| dof as usize) {
                let (du, load_end) = (new.u[d] - old.u[d], drive.load_end[d]);
                let load_start = drive.load_start.map_or(load_end, |f| f[d]);
                support_work += 0.5 * du * (start[d] + end[d] - load_start - load_end);
                work_start += du * (load_start - start[d]);
            }
        }
        if let Some(load) = drive.load_start {
            work_start = dot(&|d| new.u[d] - old.u[d], load);
        }
        let external_work = 0.5 * (work_start + work_end);
        StepAudit {
            external_work,
            support_work,
            damping_dissipation: damping,
            boundary_dissipation: boundary,
            plastic_dissipation: 0.0,
            numerical_dissipation: external_work + support_work - damping - boundary - kinetic - strain,
        }
    }
}

impl TimeIntegrator for NewmarkSolver {
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: OnStep<'_>,
    ) -> Result<(), SolveError> {
        for ends in steps_of(state.time, to, self.dt)? {
            let mut conditions = std::mem::take(&mut self.conditions);
            conditions.evaluate(model, state, ends, loading);
            let [start, end] = &conditions.loads;
            let prescribed = conditions.prescribed();
            let drive = StepLoads { load_start: Some(start), load_end: end, prescribed };
            let audit = self.advance(model, state, drive);
            self.conditions = conditions;
            let audit = audit?;
            state.time = ends[1];
            on_step(state, &StepReport::linear(state.time, self.dt), Some(&audit));
        }
        Ok(())
    }
}

fn subtract(equations: &mut [f64], nodal: &[f64], free: &[u32]) {
    for (slot, &d) in equations.iter_mut().zip(free) {
        *slot -= nodal[d as usize];
    }
}

pub(crate) fn check_dynamics(model: &Model, dt: f64) -> Result<(), SolveError> {
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(SolveError::TimeStep { dt });
    }
    check_density(model)
}

pub(crate) fn check_density(model: &Model) -> Result<(), SolveError> {
    let used = |m: &u32| model.mesh().materials.contains(m);
    match model.materials().iter().find(|(m, constants)| constants.elastic.density <= 0.0 && used(m)) {
        Some((&material, _)) => Err(SolveError::NoMass { material }),
        None => Ok(()),
    }
}
