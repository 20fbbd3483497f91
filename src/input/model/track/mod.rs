//! `[track]` resolved: sleepers, rail, load, trains.

pub mod plan;
pub mod sleeper;
pub mod trains;
pub mod vehicles;
