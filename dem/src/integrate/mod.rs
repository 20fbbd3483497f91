//! Integration in time.

pub(crate) mod kick;
pub(crate) mod leapfrog;
pub mod rotation;
pub(crate) mod step_size;
pub(crate) mod turning;
