//! Integration in time.

pub(crate) mod kick;
pub(crate) mod leapfrog;
pub(crate) mod rigid_rotation;
pub mod rotation;
pub(crate) mod step_size;
