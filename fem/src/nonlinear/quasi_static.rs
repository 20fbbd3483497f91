//! Quasi-static loading in steps of time or pseudo-time, with automatic step lengths.
//!
//! Forces and prescribed displacements are functions of time. The residual of a step is that of the whole equilibrium, so
//! what one step leaves within the tolerance is taken up by the next and does not add up. Limits: no path following: beyond
//! a limit load only prescribed displacements go on.

use super::memory::Memory;
use super::newton::{Failure, Newton, NewtonOptions, Problem, Statistics, StepReport};
use super::step_control::{StepControl, StepLength};
use crate::assembly::Combination;
use crate::model::Model;
use crate::solver::SolveError;
use crate::state::State;
use crate::statics::{check_finite, check_held, check_load};
use crate::supports::name;

/// Loads and prescribed displacements as functions of time.
///
/// A closure `|time, load|` is a loading that leaves the supports at the values of the model.
pub trait Loading {
    /// Adds the nodal forces [N] at `time` to `load`, which comes in as zeros. Shape `[3 * nodes]`.
    fn load(&mut self, time: f64, load: &mut [f64]);

    /// Sets the displacements [m] of the constrained dofs at `time`, in the order of
    /// [`Supports::fixed`](crate::supports::Supports::fixed); they come in with the values of the model.
    fn prescribed(&mut self, _time: f64, _values: &mut [f64]) {}
}

impl<F: FnMut(f64, &mut [f64])> Loading for F {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        self(time, load);
    }
}

/// A loading of two closures.
pub struct Driven<L, P> {
    /// As [`Loading::load`].
    pub load: L,
    /// As [`Loading::prescribed`].
    pub prescribed: P,
}

impl<L: FnMut(f64, &mut [f64]), P: FnMut(f64, &mut [f64])> Loading for Driven<L, P> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        (self.load)(time, load);
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        (self.prescribed)(time, values);
    }
}

/// Steps a model through a loading.
pub struct QuasiStatic {
    newton: Newton,
    length: StepLength,
    load: Vec<f64>,
    fixed: Vec<f64>,
    reactions: Vec<f64>,
}

impl QuasiStatic {
    /// Checks that the body is held, and makes the buffers.
    ///
    /// # Errors
    /// A body that is not held; options out of range.
    pub fn new(
        model: &Model,
        options: NewtonOptions,
        control: StepControl,
    ) -> Result<QuasiStatic, SolveError> {
        control.check()?;
        check_held(model)?;
        Ok(QuasiStatic {
            newton: Newton::new(model, options)?,
            length: StepLength::new(control),
            load: vec![0.0; model.dof_count()],
            fixed: vec![0.0; model.supports().fixed().len()],
            reactions: vec![0.0; model.dof_count()],
        })
    }

    /// Counts and times since the solver was made.
    pub fn statistics(&self) -> Statistics {
        self.newton.statistics
    }

    /// What the solver remembers beside the state, for a checkpoint.
    pub fn memory(&self) -> Memory {
        self.newton.memory(Some(self.length))
    }

    /// Goes on with the memory of a solver of the same model and options.
    ///
    /// # Errors
    /// The elastic matrix cannot be factored.
    pub fn recall(&mut self, model: &Model, memory: &Memory) -> Result<(), SolveError> {
        self.newton.recall(model, memory, Some(&mut self.length))
    }

    /// Steps `state` to the time `to`. After every accepted step `on_step` sees the state and how the step converged.
    ///
    /// # Errors
    /// [`SolveError::Diverged`] when a step of the smallest length fails; `state` is then that of the last accepted step, bit for
    /// bit. A load or displacement that is not finite; a state of another model; an elastic matrix that cannot be factored.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut impl Loading,
        mut on_step: impl FnMut(&State, &StepReport),
    ) -> Result<(), SolveError> {
        check_state(model, state)?;
        if !to.is_finite() {
            return Err(SolveError::Option { what: "the end time", value: to, expected: "a finite number" });
        }
        ensure_points(model, state);
        while state.time < to {
            let dt = self.length.next(state.time, to);
            // The sum of the steps must end at `to` exactly.
            let time = if dt >= to - state.time { to } else { state.time + dt };
            self.conditions(model, state, time, loading)?;
            let problem = Problem {
                old: &state.points,
                rhs: &self.load,
                fixed: &self.fixed,
                linear: Combination::default(),
                forces: None,
            };
            match self.newton.solve(model, &problem) {
                Ok(()) => {
                    self.length.accept(dt, self.newton.report.iterations);
                    for &(dof, _) in model.supports().fixed() {
                        self.reactions[dof as usize] = -self.newton.residual[dof as usize];
                    }
                    self.newton.commit(state, time, dt);
                    on_step(state, &self.newton.report);
                }
                Err(Failure::Stuck(stuck)) => {
                    if !self.length.halve(dt) {
                        return Err(stuck.error(model, state.time));
                    }
                    self.newton.statistics.halvings += 1;
                }
                Err(Failure::Fatal(error)) => return Err(error),
            }
        }
        Ok(())
    }

    /// Forces of the supports on the body [N] after the last accepted step; 0 at free dofs. Shape `[3 * nodes]`.
    pub fn reactions(&self) -> &[f64] {
        &self.reactions
    }

    /// Forces [N] that the stresses of a state and the boundary springs carry. Shape `[3 * nodes]`.
    pub(super) fn carried(&mut self, model: &Model, state: &State) -> Vec<f64> {
        self.newton.force.of_states(model, &state.points);
        let mut carried = self.newton.force.force.clone();
        model.boundary_spring_times(&state.u, &mut carried);
        carried
    }

    /// Loads and prescribed increments of the step from `state` to `time`.
    fn conditions(
        &mut self,
        model: &Model,
        state: &State,
        time: f64,
        loading: &mut impl Loading,
    ) -> Result<(), SolveError> {
        self.load.fill(0.0);
        loading.load(time, &mut self.load);
        check_load(model, &self.load, time)?;
        subtract_springs(model, &state.u, &mut self.load);
        prescribe(model, state, time, loading, &mut self.fixed)
    }
}

impl Newton {
    /// Takes the solved step over into the state.
    pub(super) fn commit(&mut self, state: &mut State, time: f64, dt: f64) {
        state.u.iter_mut().zip(&self.w).for_each(|(u, w)| *u += w);
        std::mem::swap(&mut state.points, &mut self.force.points);
        state.time = time;
        self.statistics.steps += 1;
        self.report.time = time;
        self.report.dt = dt;
    }
}

/// Takes the forces of the boundary springs at the displacement `u` from the right-hand side.
pub(super) fn subtract_springs(model: &Model, u: &[f64], rhs: &mut [f64]) {
    if !model.matrices().springs().is_empty() {
        rhs.iter_mut().for_each(|r| *r = -*r);
        model.boundary_spring_times(u, rhs);
        rhs.iter_mut().for_each(|r| *r = -*r);
    }
}

/// Prescribed increments from `state` to `time`, in the order of the constrained dofs.
pub(super) fn prescribe(
    model: &Model,
    state: &State,
    time: f64,
    loading: &mut impl Loading,
    increments: &mut [f64],
) -> Result<(), SolveError> {
    let fixed = model.supports().fixed();
    increments.iter_mut().zip(fixed).for_each(|(i, (_, value))| *i = *value);
    loading.prescribed(time, increments);
    for (increment, &(dof, _)) in increments.iter_mut().zip(fixed) {
        if !increment.is_finite() {
            let (node, direction) = name(model.mesh(), dof as usize);
            let what = "the prescribed displacement";
            return Err(SolveError::NotFinite { what, node, direction, time });
        }
        *increment -= state.u[dof as usize];
    }
    Ok(())
}

/// Refuses a state of another model or with numbers that are not finite.
pub(super) fn check_state(model: &Model, state: &State) -> Result<(), SolveError> {
    let n = model.dof_count();
    for (what, found) in [
        ("displacement of the state", state.u.len()),
        ("velocity of the state", state.v.len()),
        ("acceleration of the state", state.a.len()),
    ] {
        if found != n {
            return Err(SolveError::Length { what, found, expected: n });
        }
    }
    let (found, expected) = (state.points.len(), model.point_count());
    if found != expected && !(found == 0 && model.is_linear()) {
        return Err(SolveError::Length { what: "list of Gauss points of the state", found, expected });
    }
    check_finite(model, "the displacement", &state.u, state.time)
}

/// Gives a linear model without point states those of its displacement.
pub(super) fn ensure_points(model: &Model, state: &mut State) {
    if state.points.is_empty() {
        let mut points = model.new_points();
        for e in 0..model.mesh().element_count() {
            let stresses = crate::stress::gauss(model, &state.u, e);
            for (point, stress) in points[model.point_start(e)..].iter_mut().zip(stresses) {
                point.stress = stress;
            }
        }
        state.points = points;
    }
}
