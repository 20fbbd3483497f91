//! Results of a run as they lie on disk: the list of frames, grains, force chains, walls, the solid. Whoever shows results reads
//! them here.

pub mod grains;
pub mod lines;
pub mod section;
pub mod series;
pub mod solid;
pub mod tables;
