//! Integration in time.

pub(crate) mod leapfrog;
pub mod rotation;
