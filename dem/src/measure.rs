//! What can be read off a state: energies, momentum, contacts, stress. None of it changes the state.
//!
//! Energies and momentum are those of the last half step, t − dt/2, where the velocities of the leapfrog live:
//! bodies are moved back by half a step for it, springs likewise. So energy plus ledger closes to second order in
//! dt at every step, and momentum plus ledger to rounding. Contacts are those of the present positions, with the
//! forces that the next step will find.

mod contacts;
mod energy;
mod stress;

pub use contacts::{ContactRecord, contact_forces, contacts, coordination};
pub use energy::{Energies, energies, momentum};
pub use stress::mean_stress;
