//! Shapes of bodies.

pub mod clump;
