//! Time marching with steps halved after divergence.

use super::conditions::{check_state, ensure_points};
use super::newton::{Failure, Newton};
use crate::error::SolveError;
use crate::integrator::{Loading, OnStep, SolverState, StepLength, TimeIntegrator};
use crate::model::Model;
use crate::state::{State, StepAudit};

/// Newton method with adaptive steps.
pub(crate) trait StepHalving: Send + Sync {
    fn parts(&self) -> (&Newton, &StepLength);

    fn parts_mut(&mut self) -> (&mut Newton, &mut StepLength);

    /// Steps by `dt` to `time` [s]; failed steps leave the state unchanged.
    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        time: f64,
        dt: f64,
        loading: &mut dyn Loading,
    ) -> Result<Option<StepAudit>, Failure>;

    fn reactions(&self) -> Option<&[f64]> {
        None
    }
}

impl<M: StepHalving> TimeIntegrator for M {
    /// # Errors
    /// [`SolveError::Diverged`] if the smallest step fails (state of the last accepted step); values not
    /// finite; foreign state; failed factorisation.
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
                Err(Failure::NotConverged(stuck)) => {
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

    fn solver_state(&self) -> Option<SolverState> {
        let (newton, length) = self.parts();
        Some(newton.solver_state(Some(*length)))
    }

    fn restore(&mut self, model: &Model, memory: &SolverState) -> Result<(), SolveError> {
        let (newton, length) = self.parts_mut();
        newton.restore(model, memory, Some(length))
    }

    fn reactions(&self) -> Option<&[f64]> {
        StepHalving::reactions(self)
    }
}
