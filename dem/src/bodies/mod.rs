//! Bodies: input, constants, and per-block arrays.

pub(crate) mod block;
pub(crate) mod block_bodies;
pub(crate) mod block_slice;
pub(crate) mod input;
pub(crate) mod sums;
pub(crate) mod table;
