//! Contact laws, composed of parts (`composed.rs`, `table.rs`) per material pair.
//!
//! Laws are generic over [`Real`](crate::lanes::Real): [`ContactLaw::evaluate`] in SIMD lanes and
//! [`ContactLaw::evaluate_one`] are bitwise identical.

pub mod adhesion;
mod any_law;
pub mod check;
pub mod composed;
pub mod conical_damage;
mod constants;
mod contact;
mod contact_law;
pub mod damping;
pub mod formula;
pub mod formula_check;
mod formula_law;
pub mod half_step_damping;
pub mod hertz;
#[doc(hidden)]
mod laws;
mod line_contact;
pub mod linear;
pub mod material;
pub mod mindlin;
pub mod normal;
pub mod parameter;
pub mod restitution;
#[doc(hidden)]
pub mod rolling_twisting;
pub mod rough;
pub mod rough_mindlin;
pub mod scarring;
#[doc(hidden)]
pub mod slider;
pub mod spring;
pub mod table;
pub mod tangential;
pub mod walton_braun;

#[cfg(test)]
mod conformance;

pub use crate::spatial::detect::ContactGeometry;
pub use constants::Constants;
pub use contact::{ContactForce, History, HistoryLanes, LawInput, LawOutput, Linearised, NO_CONTACT};
pub use contact_law::ContactLaw;
pub use laws::{LawTable, Laws, with_law};
pub use laws::{PairTable, sources};
