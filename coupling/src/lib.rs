//! Exchange of force and motion between the grains and the solid: the only crate that sees both sides.
//!
//! [`face`] finds the closest point on a curved face of any kind, [`surface`] shows the solid's moving faces to the
//! grains, [`transfer`] turns contact forces into nodal loads, [`spread`] takes them to discs, [`step`] is the coupled
//! step in the order that [`scheme`] tells, [`stability`] says how long its windows may be, [`interface`] checks it for the contacts of a moment, and [`ledger`] keeps
//! the energy of the whole system. [`track`] holds rails, trains and load cycles on sleepers. [`inverse_map`] is the three-dimensional map of a point into an element.

mod accelerate;
mod discs;
pub mod face;
pub mod interface;
pub mod inverse_map;
pub mod ledger;
pub mod scheme;
pub mod spread;
pub mod stability;
pub mod step;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod track;
pub mod transfer;
