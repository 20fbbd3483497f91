//! Bodies: input, constants, and per-block arrays.

pub(crate) mod block;
pub(crate) mod input;
pub(crate) mod members;
pub(crate) mod part;
pub(crate) mod sums;
pub(crate) mod table;
