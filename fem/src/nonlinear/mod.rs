//! Elastoplastic bodies: internal force, tangent, Newton's iteration, and the drivers on top of it.
//!
//! Stress and history live at the Gauss points of [`State::points`](crate::State::points); a step starts from the committed
//! ones, so that a step given up leaves no trace. Source of the structure: Simo and Hughes, Computational Inelasticity (1998),
//! chapters 1 and 4; de Souza Neto, Peric and Owen, Computational Methods for Plasticity (2008), chapter 4. Limits: small strain
//! and rotation.
mod conditions;
pub mod dynamics;
pub mod energy;
pub mod initial_stress;
mod internal_force;
mod linear_system;
mod memory;
pub(crate) mod motion;
mod newton;
mod options;
mod points;
mod quasi_static;
mod step_control;
pub mod strength_reduction;
mod tangent;
mod window;

pub use crate::integrator::{Driven, Loading, StepReport};
pub use dynamics::Dynamics;
pub use memory::Memory;
pub use options::{LinearMethod, NewtonOptions, Statistics, Variant};
pub use quasi_static::QuasiStatic;
pub use step_control::StepControl;
pub use window::PlasticWindowSolver;
