//! Integration in time.

pub(crate) mod leapfrog;
pub(crate) mod pace;
pub mod rotation;
