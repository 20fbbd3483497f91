//! Vectors, errors, energy totals, random numbers.

pub mod balance_terms;
pub mod capacity;
pub mod error;
pub mod failure;
pub mod force_tracking;
pub mod names;
pub mod random;
mod vector;

pub use vector::Vec3;
