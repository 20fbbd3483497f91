//! Steps on a device: the same arrays and the same order of sums as the engine's, and formulas that are the engine's own,
//! recorded (`tape.rs`) and written out as text (`text`, a file a kind of force or motion) that a C compiler takes as well as CUDA's.
//!
//! Contacts of spheres with each other and with planes are searched there too, all others by the processor (`search.rs`); a step that fails
//! there or that puts the bodies in a new order is made by the engine itself. Contacts of spheres with a surface that another crate moves,
//! contacts of bodies that are not made of spheres, and the motion of these are the processor's part of each step (`handed.rs`).
//! Whatever the device cannot compute is refused by name ([`check`]).

mod arrays;
mod back_end;
mod bodies;
mod books;
#[cfg(feature = "cuda")]
mod cuda;
mod handed;
mod layout;
mod machine;
mod scope;
mod search;
mod sizes;
mod tape;
mod text;
mod walls;

#[cfg(feature = "cuda")]
pub use cuda::Cuda;

pub use back_end::{Device, source};
pub use layout::Arguments;
pub use machine::{Call, Machine, kernels};
pub use scope::{Unsupported, check};
