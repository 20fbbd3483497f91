//! Compute back ends (CPU, GPU).
//!
//! A back end uploads a [`State`], advances it and downloads it; results are bitwise identical to [`Work`].
//! Time, steps, balance terms and surface contacts are current after each step.

use super::input::AppliedForce;
use super::model::Model;
use super::state::State;
use super::step;
use super::work::Work;
use crate::base::error::StepError;
use crate::spatial::surface::{Surface, SurfaceContact};

/// Compute back end for states of one model.
pub trait BackEnd {
    /// Uploads a state of the same model, also after external changes.
    ///
    /// # Errors
    /// Device failure or insufficient memory.
    fn upload(&mut self, model: &Model, state: &State) -> Result<(), StepError>;

    /// Advances by one step of [`State::dt`]; see [`step()`](super::step::step).
    ///
    /// # Errors
    /// [`StepError`]; the state is then invalid.
    fn step<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError>;

    /// Completes `state` with current motion and contact history.
    ///
    /// # Errors
    /// Device failure.
    fn download(&mut self, model: &Model, state: &mut State) -> Result<(), StepError>;

    /// Contacts with the external surface in the last step.
    fn surface_contacts(&self) -> &[SurfaceContact];
}

impl BackEnd for Work {
    fn upload(&mut self, model: &Model, state: &State) -> Result<(), StepError> {
        self.follow(model, state);
        Ok(())
    }

    fn step<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        step::step(model, state, self, surface, applied)
    }

    fn download(&mut self, _: &Model, _: &mut State) -> Result<(), StepError> {
        Ok(())
    }

    fn surface_contacts(&self) -> &[SurfaceContact] {
        Work::surface_contacts(self)
    }
}
