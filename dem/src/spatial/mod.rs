//! Search and contact geometry.

pub mod bvh;
pub(crate) mod cells;
pub mod detect;
pub mod distance;
pub(crate) mod facet;
pub(crate) mod patchwork;
pub(crate) mod periodic;
pub(crate) mod round;
pub(crate) mod separation;
pub mod sheet;
pub(crate) mod shell;
pub mod surface;
