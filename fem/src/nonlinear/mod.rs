//! Elastoplastic bodies: internal force, tangent, Newton iteration and drivers.
//!
//! Source: Simo and Hughes (1998), chapters 1 and 4; de Souza Neto, Peric and Owen (2008), chapter 4.
//! Limits: small strain and rotation.
pub(crate) mod conditions;
pub mod dynamics;
pub mod energy;
pub mod initial_stress;
mod internal_force;
mod linear_system;
pub(crate) mod motion;
pub(crate) mod newton;
mod options;
mod points;
mod quasi_static;
mod step_halving;
pub mod strength_reduction;
mod tangent;

pub use crate::integrator::{LoadFunctions, Loading, SolverState, Statistics, StepControl, StepReport};
pub use dynamics::NonlinearNewmark;
pub use options::{LinearMethod, NewtonOptions, Variant};
pub use quasi_static::QuasiStatic;
