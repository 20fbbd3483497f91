//! Walls of triangles.

pub mod triangulated;
