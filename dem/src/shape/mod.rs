//! Shapes of bodies.

pub mod clump;
pub mod cluster;
pub mod cuboid;
pub mod polyhedron;
pub mod triangle;

use clump::Clump;

/// Shape of a body, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// A rigid union of spheres.
    Clump(Clump),
    /// A rigid block, such as a sleeper. It touches spheres (of clumps too) and planes (with its corners), but not
    /// other blocks, triangles or external surfaces.
    Box {
        /// Half of each side [m].
        half: [f64; 3],
    },
}
