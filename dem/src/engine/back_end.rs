//! Where steps are computed: the seam for processors other than the one that the rest of the program runs on.
//!
//! A back end takes a [`State`] over, advances it step by step, and gives it back. In between it may keep the arrays of motion
//! and the memory of contacts where it likes; they are flat arrays per block (`bodies/block.rs`, `pairs`), made to be copied
//! as they are. What every step changes anyway and whoever drives the steps reads, time, count and length of steps, the
//! ledger and the contacts with an external surface, is up to date after each. All of them give the bits of the first, [`Work`],
//! which computes on the state itself, so that taking it over and giving it back cost nothing.

use super::input::AppliedForce;
use super::model::Model;
use super::state::State;
use super::step;
use super::work::Work;
use crate::base::error::StepError;
use crate::spatial::surface::{Surface, SurfaceContact};

/// What computes the steps of one model's states.
pub trait BackEnd {
    /// Takes over another state of the same model, or this one after something else has changed it.
    ///
    /// # Errors
    /// A device does not respond, or has no memory left.
    fn upload(&mut self, model: &Model, state: &State) -> Result<(), StepError>;

    /// Advances the state by one step of [`State::dt`]; see [`step()`](super::step::step).
    ///
    /// # Errors
    /// [`StepError`]; the state is then not fit to go on from.
    fn step<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError>;

    /// Makes `state` whole: motion and memory of contacts as they are now. Before it is measured, written, looked at for the
    /// length of steps, or changed.
    ///
    /// # Errors
    /// A device does not respond.
    fn download(&mut self, model: &Model, state: &mut State) -> Result<(), StepError>;

    /// Contacts with the external surface in the last step, by block, then sphere, then patch.
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
