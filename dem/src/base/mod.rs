//! Vectors, errors, energy totals, random numbers.

pub mod balance_terms;
pub(crate) mod capacity;
pub mod error;
pub(crate) mod failure;
pub mod force_tracking;
pub mod names;
pub mod random;
mod vector;

pub use vector::Vec3;
