//! DEM–FEM coupling: contact on moving solid surfaces, load transfer, coupled stepping, stability, track.
//!
//! Units are SI. Nodal arrays have the shape `[3·nodes]`.

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
