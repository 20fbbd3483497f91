//! The coupled step: one window of the grains' steps and one step of the solid, in the order that a
//! [scheme](crate::scheme) tells.
//!
//! One window of length Δt = m·dt, as scheme B has it:
//!
//! 1. the surface nodes take position and velocity of the solid at the start of the window and go on with that
//!    velocity;
//! 2. m steps of the grains, each with contact on the curved faces where they are in the middle of the step; each contact
//!    force becomes nodal forces at its mapped point, and their sums are audited;
//! 3. the nodal impulses, divided by Δt, load the solid for one implicit step with the window's mean force (see
//!    [`trackbed_fem::theta`]), so that the momentum given by the grains is the momentum received by the solid.
//!
//! A window begins where the solid is, not where the window before left the surface. Normal springs follow from positions;
//! tangential springs, sums of velocities, are displaced by this correction in the first step of the grains. Without it they follow
//! the surface late by θ Δt, a dashpot of −θ Δt Kₜ.
//!
//! Why the middle: the leapfrog's velocities are those of half a step before its places, and the window begins where they are. A
//! surface taken at the start of each grain step would answer half a step late, and gain ½ dt ∫ K v² dt at a contact K.
//!
//! The two-mass study behind the choice (`docs/theory/coupling.md`, section 5.5) finds this order stable up to
//! W = Δt √(Kₙ/m) of about 1 with damping and nearly neutral without (0.02 W⁴ per window), where the reverse order (solid first, with
//! the last window's force) gains energy at every step size.

mod account;
mod interface_check;
mod model;
mod rest;
mod solver;
mod state;
mod stiffened;
mod window;

pub use account::{spent, spent_by_grains, stored};
pub use interface_check::{InterfaceCheck, check_interface};
pub use model::Model;
pub use rest::resting_load;
pub use solver::StepError;
pub use state::{State, Work};
pub use window::{exchange, step};
