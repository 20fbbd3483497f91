//! Exchange of force and motion between the grains and the solid: the only crate that sees both sides.
//!
//! [`face`] finds the closest point on a curved 8-node face, [`surface`] shows the solid's moving faces to the
//! grains, [`transfer`] turns contact forces into nodal loads, [`step`] is the coupled step, and [`ledger`] keeps
//! the energy of the whole system. [`inverse_map`] is the three-dimensional map of a point into an element.

pub mod face;
pub mod inverse_map;
pub mod ledger;
pub mod step;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod transfer;
