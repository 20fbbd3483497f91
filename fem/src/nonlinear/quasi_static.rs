//! Quasi-static loading in steps of time or pseudo-time, with automatic step lengths.
//!
//! Forces and prescribed displacements are functions of time. The residual of a step is that of the whole equilibrium, so
//! what one step leaves within the tolerance is taken up by the next and does not add up. Limits: no path following: beyond
//! a limit load only prescribed displacements go on.

use super::conditions::{check_state, ensure_points, prescribe, subtract_springs};
use super::memory::Memory;
use super::newton::{Failure, Newton, Problem};
use super::options::{NewtonOptions, Statistics};
use super::step_control::{StepControl, StepLength};
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::integrator::{Loading, StepReport, TimeIntegrator};
use crate::model::Model;
use crate::state::{State, StepAudit};
use crate::statics::{check_held, check_load};

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
    pub fn advance<L: Loading + ?Sized>(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut L,
        mut on_step: impl FnMut(&State, &StepReport),
    ) -> Result<(), SolveError> {
        check_state(model, state)?;
        if !to.is_finite() {
            return Err(SolveError::Option { what: "the end time", value: to, expected: "a finite number" });
        }
        ensure_points(model, state);
        while state.time < to {
            let (dt, time) = self.length.next(state.time, to);
            self.conditions(model, state, time, loading)?;
            let stop = || loading.stopped();
            let problem = Problem {
                old: &state.points,
                rhs: &self.load,
                fixed: &self.fixed,
                linear: Combination::default(),
                forces: None,
                stop: &stop,
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
    fn conditions<L: Loading + ?Sized>(
        &mut self,
        model: &Model,
        state: &State,
        time: f64,
        loading: &mut L,
    ) -> Result<(), SolveError> {
        self.load.fill(0.0);
        loading.load(time, &mut self.load);
        check_load(model, &self.load, time)?;
        subtract_springs(model, &state.u, &mut self.load);
        prescribe(model, state, time, loading, &mut self.fixed)
    }
}

impl TimeIntegrator for QuasiStatic {
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: &mut dyn FnMut(&State, &StepReport, Option<&StepAudit>),
    ) -> Result<(), SolveError> {
        self.advance(model, state, to, loading, |state, report| on_step(state, report, None))
    }
}
