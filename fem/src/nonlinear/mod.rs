//! Elastoplastic bodies: internal force, tangent, Newton iteration and drivers.
//!
//! Steps start from committed Gauss point states, so failed steps leave no trace. Source: Simo and Hughes
//! (1998), chapters 1 and 4; de Souza Neto, Peric and Owen (2008), chapter 4. Limits: small strain and
//! rotation.
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
