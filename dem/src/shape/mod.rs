//! Shapes of bodies.

pub mod clump;
pub mod cluster;
pub mod cuboid;
pub mod dilated;
pub mod plane;
pub mod polyhedron;
pub mod triangle;

use crate::base::Vec3;
use clump::Clump;
use dilated::{Core, Dilated};

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
    /// A rigid block, such as a sleeper. It touches spheres (of clumps too), planes (with its corners) and other blocks,
    /// but not triangles or external surfaces.
    Box {
        /// Half of each side [m].
        half: [f64; 3],
    },
    /// A dilated polyhedron or disk. It touches spheres (of clumps too), planes, walls, boxes and its like.
    Polyhedron(Box<Dilated>),
}

impl Shape {
    /// Half sides of a box about the centre of mass, along the axes of the shape, that holds a shape which is not made of
    /// spheres [m].
    pub(crate) fn bounding_half(&self, scale: f64) -> Vec3 {
        match self {
            Shape::Polyhedron(it) => it.half_extents() * scale,
            _ => self.half_sides(scale),
        }
    }

    /// Radius that a shape with faces is rounded with [m]; zero for others.
    pub(crate) fn rounding(&self, scale: f64) -> f64 {
        if let Shape::Polyhedron(it) = self { it.radius * scale } else { 0.0 }
    }

    /// Whether it is a dilated polyhedron or disk.
    pub(crate) fn dilated(&self) -> bool {
        matches!(self, Shape::Polyhedron(_))
    }

    /// Faces, edges and corners; none of shapes without faces.
    pub(crate) fn core(&self) -> Core {
        match self {
            Shape::Sphere { .. } | Shape::Clump(_) => Core::default(),
            Shape::Polyhedron(it) => it.core.clone(),
            Shape::Box { half } => {
                let corners: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::from(*half), k)).collect();
                // A box too flat for a core touches nothing that needs one.
                Core::new(&corners).unwrap_or_default()
            }
        }
    }

    /// Number of corners of a shape with flat faces that touch planes by themselves.
    pub(crate) fn corners(&self) -> u32 {
        match self {
            Shape::Sphere { .. } | Shape::Clump(_) | Shape::Polyhedron(_) => 0,
            Shape::Box { .. } => 8,
        }
    }

    /// A corner of a shape with flat faces, in its own frame, and the size of the body that laws take for a radius [m].
    pub(crate) fn corner(&self, k: usize, scale: f64) -> (Vec3, f64) {
        let half = self.half_sides(scale);
        (cuboid::corner(&half, k), half.min())
    }

    /// Half sides of a box, scaled [m]; zero for others.
    pub(crate) fn half_sides(&self, scale: f64) -> Vec3 {
        match self {
            Shape::Box { half } => Vec3::from(*half) * scale,
            _ => Vec3::zeros(),
        }
    }
}
