//! Shapes of bodies.

pub mod clump;
pub mod cluster;
pub mod cuboid;
pub mod plane;
pub mod polyhedron;
pub mod triangle;

use crate::base::Vec3;
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

impl Shape {
    /// Half sides of a box, scaled [m]; zero for others.
    pub(crate) fn half_sides(&self, scale: f64) -> Vec3 {
        match self {
            Shape::Box { half } => Vec3::from(*half) * scale,
            _ => Vec3::zeros(),
        }
    }
}
