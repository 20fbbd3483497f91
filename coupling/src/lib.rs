//! DEM–FEM coupling: contact on moving solid surfaces, load transfer, coupled stepping, stability.
//!
//! Units are SI. Nodal arrays have the shape `[3·nodes]`.

mod disc_quadrature;
pub mod distributed_transfer;
pub mod energy_balance;
pub mod face;
pub mod interface_stability;
pub mod inverse_map;
mod iqn_ils;
pub mod scheme;
pub mod stability;
pub mod step;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod transfer;
