//! Time steps on a device, bitwise identical to the engine's.
//!
//! The engine's own formulas are recorded (`tape.rs`) and written as C and CUDA source (`text`). The CPU
//! computes the rest of a step (`cpu_forces.rs`), re-sorts bodies and repeats failed steps. Unsupported
//! features are rejected ([`check`]).

mod arrays;
mod back_end;
mod block_totals;
mod bodies;
mod cpu_forces;
#[cfg(feature = "cuda")]
mod cuda;
mod layout;
mod machine;
mod search;
mod sizes;
mod supported;
mod tape;
mod text;
mod walls;

#[cfg(feature = "cuda")]
pub use cuda::Cuda;

pub use back_end::{Device, source};
pub use layout::Arguments;
pub use machine::{Call, Machine, kernels};
pub use supported::{Unsupported, check};
