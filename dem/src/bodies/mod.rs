//! Bodies: what a user gives, constants of all, and the arrays of a block of neighbours that every step reads and writes.

pub(crate) mod block;
pub(crate) mod input;
pub(crate) mod members;
pub(crate) mod part;
pub(crate) mod sums;
pub(crate) mod table;
