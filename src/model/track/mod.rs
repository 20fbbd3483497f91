//! Rails and what rolls on them.

pub mod band;
pub mod beam;
pub mod plan;
pub mod pulse;
pub mod rail;
pub mod sleeper;
pub mod trains;
