//! Elastoplastic bodies: internal force, tangent, Newton's iteration, and the drivers on top of it.
//!
//! Stress and history live at the Gauss points of [`State::points`](crate::State::points); a step starts from the committed
//! ones, so that a step given up leaves no trace. Source of the structure: Simo and Hughes, Computational Inelasticity (1998),
//! chapters 1 and 4; de Souza Neto, Peric and Owen, Computational Methods for Plasticity (2008), chapter 4. Limits: small strain
//! and rotation.
pub(crate) mod conditions;
pub mod dynamics;
pub mod energy;
mod halving;
pub mod initial_stress;
mod internal_force;
mod linear_system;
pub(crate) mod motion;
pub(crate) mod newton;
mod options;
mod points;
mod quasi_static;
pub mod strength_reduction;
mod tangent;

pub use crate::integrator::{Driven, Loading, Memory, Statistics, StepControl, StepReport};
pub use dynamics::Dynamics;
pub use options::{LinearMethod, NewtonOptions, Variant};
pub use quasi_static::QuasiStatic;
