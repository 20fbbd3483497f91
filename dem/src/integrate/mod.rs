//! Integration in time.

pub(crate) mod kick;
pub(crate) mod leapfrog;
pub(crate) mod pace;
pub mod rotation;
pub(crate) mod turning;
