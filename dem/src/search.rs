//! Neighbour search: cells find the candidates, the near list keeps those about to touch.

pub mod bvh;
pub(crate) mod candidates;
pub(crate) mod cells;
pub(crate) mod near;
pub(crate) mod patches;
