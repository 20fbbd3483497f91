//! Search and contact geometry.

pub mod bvh;
pub mod cells;
pub mod detect;
pub mod distance;
pub mod facet;
pub mod patchwork;
pub mod periodic;
pub mod round;
pub mod separation;
pub mod sheet;
pub mod shell;
pub mod surface;
