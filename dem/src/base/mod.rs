//! What every layer uses: vectors, errors, the ledger.

pub mod error;
pub(crate) mod failure;
pub(crate) mod held;
pub mod ledger;
mod vector;

pub use vector::Vec3;
