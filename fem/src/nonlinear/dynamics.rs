//! Elastoplastic dynamics: Newmark and HHT-α with Newton iteration.
//!
//! ```text
//! M a1 + (1 + h) (f(s1) + S u1 + C v1 - F1) - h (f(s0) + S u0 + C v0 - F0) = 0
//! C = alpha_m M + beta_k K + D
//! ```
//!
//! Source: Newmark (1959); Hilber, Hughes and Taylor (1977); Simo and Hughes (1998), section 1.6
//! (plasticity).
//!
//! Theory manual: equation (4.6) of `docs/theory/solid.md`.

use super::conditions::{check_state, ensure_points, prescribe, subtract_springs};
use super::internal_force::InternalForce;
use super::motion::{close, inner_force};
use super::newton::{Failure, INERTIA, Newton, Problem};
use super::options::NewtonOptions;
use super::step_halving::StepHalving;
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::integrator::{Loading, Statistics, StepControl, StepLength};
use crate::model::Model;
use crate::newmark::{Newmark, accelerate, check_dynamics};
use crate::state::{State, StepAudit};
use crate::statics::check_load;

/// Elastoplastic dynamics solver; requires an initial acceleration ([`initial_acceleration`]).
pub struct NonlinearNewmark {
    method: Newmark,
    hht: f64,
    newton: Newton,
    length: StepLength,
    next: State,
    load: [Vec<f64>; 2],
    rhs: Vec<f64>,
    fixed: Vec<f64>,
    inner: [Vec<f64>; 2],
    scratch: Vec<f64>,
}

impl NonlinearNewmark {
    /// Newmark with unconditionally stable parameters.
    ///
    /// # Errors
    /// Parameters, options or step lengths out of range; material without density.
    pub fn newmark(
        model: &Model,
        method: Newmark,
        options: NewtonOptions,
        control: StepControl,
    ) -> Result<NonlinearNewmark, SolveError> {
        method.check()?;
        NonlinearNewmark::build(model, method, 0.0, options, control)
    }

    /// HHT-α with parameter in [-1/3, 0].
    ///
    /// # Errors
    /// As [`NonlinearNewmark::newmark`].
    pub fn hht(
        model: &Model,
        alpha: f64,
        options: NewtonOptions,
        control: StepControl,
    ) -> Result<NonlinearNewmark, SolveError> {
        NonlinearNewmark::build(model, Newmark::of_hht_in_range(alpha)?, alpha, options, control)
    }

    fn build(
        model: &Model,
        method: Newmark,
        hht: f64,
        options: NewtonOptions,
        control: StepControl,
    ) -> Result<NonlinearNewmark, SolveError> {
        control.check()?;
        check_dynamics(model, control.initial)?;
        let zeros = || vec![0.0; model.dof_count()];
        Ok(NonlinearNewmark {
            method,
            hht,
            newton: Newton::new(model, options)?,
            length: StepLength::new(control),
            next: State { points: model.new_points(), ..State::new(model) },
            load: [zeros(), zeros()],
            rhs: zeros(),
            fixed: vec![0.0; model.supports().fixed().len()],
            inner: [zeros(), zeros()],
            scratch: vec![0.0; 2 * model.dof_count()],
        })
    }

    /// Counts and times.
    pub fn statistics(&self) -> Statistics {
        self.newton.statistics
    }
}

impl StepHalving for NonlinearNewmark {
    fn parts(&self) -> (&Newton, &StepLength) {
        (&self.newton, &self.length)
    }

    fn parts_mut(&mut self) -> (&mut Newton, &mut StepLength) {
        (&mut self.newton, &mut self.length)
    }

    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        time: f64,
        dt: f64,
        loading: &mut dyn Loading,
    ) -> Result<Option<StepAudit>, Failure> {
        for (load, at) in self.load.iter_mut().zip([state.time, time]) {
            load.fill(0.0);
            loading.load(at, load);
            check_load(model, load, at).map_err(Failure::Fatal)?;
        }
        prescribe(model, state, time, loading, &mut self.fixed).map_err(Failure::Fatal)?;
        let (Newmark { beta, gamma }, c) = (self.method, model.rayleigh());
        let by_square = 1.0 / (beta * dt * dt);
        let velocity = gamma / (beta * dt);
        self.predict(model, state, dt);
        self.right_hand_side(model, state);
        let linear = Combination {
            mass: by_square / (1.0 + self.hht) + c.alpha_m * velocity,
            stiffness: c.beta_k * velocity,
            dashpots: velocity,
        };
        let product = &mut self.scratch[state.u.len()..];
        model.mass_times(&state.a, product);
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let forces = norm(&self.load[1]).max(norm(product)).max(INERTIA * norm(&self.rhs));
        let stop = || loading.stopped();
        let (old, forces) = (&state.points, Some(forces));
        let (rhs, fixed, step) = (&self.rhs, &self.fixed, [state.time, dt]);
        let problem = Problem { old, rhs, fixed, linear, step, forces, stop: &stop };
        self.newton.solve(model, &problem)?;
        let next = &mut self.next;
        for d in 0..state.u.len() {
            let w = self.newton.du[d];
            next.u[d] = state.u[d] + w;
            next.v[d] += velocity * w;
            next.a[d] += by_square * w;
        }
        std::mem::swap(&mut next.points, &mut self.newton.force.points);
        next.time = time;
        let audit = self.audit(model, state);
        std::mem::swap(state, &mut self.next);
        self.newton.statistics.steps += 1;
        (self.newton.report.time, self.newton.report.dt) = (time, dt);
        Ok(Some(audit))
    }
}

impl NonlinearNewmark {
    fn predict(&mut self, model: &Model, state: &State, dt: f64) {
        let Newmark { beta, gamma } = self.method;
        inner_force(model, &mut self.newton.force, state, &mut self.inner[0], &mut self.scratch);
        let by_square = 1.0 / (beta * dt * dt);
        for d in 0..state.u.len() {
            let a = -by_square * (dt * state.v[d] + dt * dt * (0.5 - beta) * state.a[d]);
            self.next.a[d] = a;
            self.next.v[d] = state.v[d] + dt * ((1.0 - gamma) * state.a[d] + gamma * a);
        }
    }

    /// `F1 - S u0 - M a_p/(1 + h) - C v_p`, for HHT plus the initial imbalance.
    fn right_hand_side(&mut self, model: &Model, state: &State) {
        let (c, n, new) = (model.rayleigh(), state.u.len(), 1.0 + self.hht);
        let old = -self.hht / new;
        let [load_start, load_end] = &self.load;
        let (mixed, product) = self.scratch.split_at_mut(n);
        self.rhs.copy_from_slice(load_end);
        subtract_springs(model, &state.u, &mut self.rhs);
        for d in 0..n {
            mixed[d] = self.next.a[d] / new + c.alpha_m * self.next.v[d] - old * state.a[d];
        }
        model.mass_times(mixed, product);
        self.rhs.iter_mut().zip(&*product).for_each(|(r, p)| *r -= p);
        if c.beta_k > 0.0 {
            for d in 0..n {
                mixed[d] = c.beta_k * self.next.v[d];
            }
            model.stiffness_times(mixed, product);
            self.rhs.iter_mut().zip(&*product).for_each(|(r, p)| *r -= p);
        }
        if !model.matrices().dashpots().is_empty() {
            product.fill(0.0);
            model.dashpot_times(&self.next.v, product);
            self.rhs.iter_mut().zip(&*product).for_each(|(r, p)| *r -= p);
        }
        if old != 0.0 {
            for d in 0..n {
                self.rhs[d] += old * (load_start[d] - self.inner[0][d]);
            }
        }
    }

    /// Energy terms with mean forces.
    fn audit(&mut self, model: &Model, state: &State) -> StepAudit {
        let ([load_start, load_end], [start, end]) = (&self.load, &mut self.inner);
        let (next, n) = (&self.next, state.u.len());
        let mut audit = StepAudit::default();
        for d in 0..n {
            audit.external_work += 0.5 * (load_start[d] + load_end[d]) * self.newton.du[d];
        }
        if self.fixed.iter().any(|f| *f != 0.0) {
            inner_force(model, &mut self.newton.force, next, end, &mut self.scratch);
            for d in model.supports().fixed().iter().map(|(dof, _)| *dof as usize) {
                let reactions = start[d] + end[d] - load_start[d] - load_end[d];
                audit.support_work += 0.5 * reactions * self.newton.du[d];
            }
        }
        for d in 0..n {
            self.rhs[d] = 0.5 * (state.v[d] + next.v[d]);
        }
        close(model, &self.newton.force.table, [state, next], audit, &self.rhs, &mut self.scratch)
    }
}

/// Sets `state.a`: `M a = F - C v - f - S u` on the free dofs, 0 on the others.
///
/// # Errors
/// Invalid load or state, material without density, or failed mass solution.
pub fn initial_acceleration(model: &Model, state: &mut State, load: &[f64]) -> Result<(), SolveError> {
    check_load(model, load, state.time)?;
    check_state(model, state)?;
    check_dynamics(model, 1.0)?;
    ensure_points(model, state);
    state.a.fill(0.0);
    let n = model.dof_count();
    let (mut force, mut scratch) = (vec![0.0; n], vec![0.0; 2 * n]);
    inner_force(model, &mut InternalForce::new(model), state, &mut force, &mut scratch);
    force.iter_mut().zip(load).for_each(|(f, l)| *f = l - *f);
    accelerate(model, &force, state)
}
