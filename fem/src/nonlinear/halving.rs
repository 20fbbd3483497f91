//! The march of the methods that choose the length of their steps: halved where the iteration does not converge.

use super::conditions::{check_state, ensure_points};
use super::newton::{Failure, Newton};
use crate::error::SolveError;
use crate::integrator::{Loading, Memory, OnStep, StepLength, TimeIntegrator};
use crate::model::Model;
use crate::state::{State, StepAudit};

/// A method with Newton's iteration and a length of step of its own.
pub(crate) trait Halving: Send + Sync {
    /// The iteration, and the length of the next step.
    fn parts(&self) -> (&Newton, &StepLength);

    /// The same, to be changed.
    fn parts_mut(&mut self) -> (&mut Newton, &mut StepLength);

    /// One step of length `dt` to `time` [s], with its energies where they are balanced. The state is as it was where it fails.
    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        time: f64,
        dt: f64,
        loading: &mut dyn Loading,
    ) -> Result<Option<StepAudit>, Failure>;

    /// As [`TimeIntegrator::reactions`].
    fn reactions(&self) -> Option<&[f64]> {
        None
    }
}

impl<M: Halving> TimeIntegrator for M {
    /// # Errors
    /// [`SolveError::Diverged`] when a step of the smallest length fails; `state` is then that of the last accepted step, bit for
    /// bit. A load or displacement that is not finite; a state of another model; a matrix that cannot be factored.
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: OnStep<'_>,
    ) -> Result<(), SolveError> {
        check_state(model, state)?;
        if !to.is_finite() {
            return Err(SolveError::Option { what: "the end time", value: to, expected: "a finite number" });
        }
        ensure_points(model, state);
        while state.time < to {
            let (dt, time) = self.parts().1.next(state.time, to);
            let outcome = self.step(model, state, time, dt, loading);
            let (newton, length) = self.parts_mut();
            match outcome {
                Ok(audit) => {
                    length.accept(dt, newton.report.iterations);
                    on_step(state, &newton.report, audit.as_ref());
                }
                Err(Failure::Stuck(stuck)) => {
                    if !length.halve(dt) {
                        return Err(stuck.error(model, state.time));
                    }
                    newton.statistics.halvings += 1;
                }
                Err(Failure::Fatal(error)) => return Err(error),
            }
        }
        Ok(())
    }

    fn memory(&self) -> Option<Memory> {
        let (newton, length) = self.parts();
        Some(newton.memory(Some(*length)))
    }

    fn recall(&mut self, model: &Model, memory: &Memory) -> Result<(), SolveError> {
        let (newton, length) = self.parts_mut();
        newton.recall(model, memory, Some(length))
    }

    fn reactions(&self) -> Option<&[f64]> {
        Halving::reactions(self)
    }
}
