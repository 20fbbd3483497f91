//! Explicit discrete elements for ballasted track: spheres, rigid clumps, walls.

pub mod insert;
pub mod shape;
