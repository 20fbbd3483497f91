//! Vectors, errors, energy totals, random numbers.

pub mod error;
pub(crate) mod failure;
pub(crate) mod held;
pub mod ledger;
pub mod random;
mod vector;

pub use vector::Vec3;
