//! Reads result files of a run.

pub mod grains;
pub mod lines;
pub mod section;
pub mod series;
pub mod solid;
pub mod tables;
