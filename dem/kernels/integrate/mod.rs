//! Integration in time.

#[doc(hidden)]
pub mod kick;
#[doc(hidden)]
pub mod leapfrog;
#[doc(hidden)]
pub mod rigid_rotation;
pub mod rotation;
#[doc(hidden)]
pub mod step_size;
