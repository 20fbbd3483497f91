//! Coupled step: DEM sub-steps and one FEM time step per window, in the order of the [scheme](crate::scheme).
//!
//! A window begins at the computed surface. Tangential springs integrate velocities, so the position
//! correction displaces them in the first sub-step.
//!
//! The surface is evaluated at mid-sub-step, because leapfrog velocities trail positions by half a step.
//! Evaluated at its start, each contact K would gain ½ dt ∫ K v² dt.
//!
//! Theory manual, sections 5.4 and 5.5; the FEM step is [`trackbed_fem::theta`].

mod energy;
mod initial_equilibrium;
mod interface_check;
mod model;
mod solver;
mod state;
mod stiffened;
mod window;

pub use energy::{grain_work_and_dissipation, stored_energy, work_and_dissipation};
pub use initial_equilibrium::initial_contact_load;
pub use interface_check::{InterfaceCheck, check_interface};
pub use model::Model;
pub use solver::StepError;
pub use state::{State, Work};
pub use window::{exchange, step};
