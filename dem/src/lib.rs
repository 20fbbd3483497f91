//! Explicit discrete elements for ballasted track: spheres, rigid clumps, walls.

pub mod shape;
