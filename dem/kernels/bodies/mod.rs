//! Bodies: input, constants, and per-block arrays.

pub mod block;
pub mod block_bodies;
pub mod block_slice;
pub mod input;
pub mod sums;
pub mod table;
