//! Body shapes.

pub mod body_shape;
pub mod clump;
pub mod cluster;
pub mod cuboid;
pub mod dilated;
pub mod plane;
pub mod polyhedron;
pub mod sphere;
pub mod triangle;

use crate::base::Vec3;
use body_shape::BodyShape;
use clump::Clump;
use cuboid::Cuboid;
use dilated::{Core, Dilated};
use sphere::Sphere;

/// Body shape in the body frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Sphere.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// Rigid union of spheres.
    Clump(Clump),
    /// Rigid block, such as a sleeper. Contacts: spheres, planes (by corners) and blocks; no triangles or
    /// external surfaces.
    Box {
        /// Half lengths [m].
        half: [f64; 3],
    },
    /// Dilated polyhedron or disk. Contacts: spheres, planes, walls, boxes and polyhedra.
    Polyhedron(Box<Dilated>),
}

impl Shape {
    /// Queries the shape: the only match over all kinds.
    pub fn query<T>(&self, query: impl FnOnce(&dyn BodyShape) -> T) -> T {
        match self {
            Shape::Sphere { radius } => query(&Sphere { radius: *radius }),
            Shape::Clump(clump) => query(clump),
            Shape::Box { half } => query(&Cuboid { half: *half }),
            Shape::Polyhedron(it) => query(&**it),
        }
    }

    /// Half lengths of the bounding box about the centre of mass, for shapes not made of spheres [m].
    pub fn bounding_half(&self, scale: f64) -> Vec3 {
        match self {
            Shape::Polyhedron(it) => it.half_extents() * scale,
            Shape::Box { .. } => self.half_sides(scale),
            Shape::Sphere { .. } | Shape::Clump(_) => Vec3::zeros(),
        }
    }

    /// Rounding radius of a shape with faces [m]; else zero.
    pub fn rounding(&self, scale: f64) -> f64 {
        if let Shape::Polyhedron(it) = self { it.radius * scale } else { 0.0 }
    }

    #[doc(hidden)]
    pub fn dilated(&self) -> bool {
        matches!(self, Shape::Polyhedron(_))
    }

    /// Empty for shapes without faces.
    pub fn core(&self) -> Core {
        match self {
            Shape::Polyhedron(it) => it.core.clone(),
            Shape::Box { half } => {
                let corners: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::from(*half), k)).collect();
                // A degenerate box needs no core.
                Core::new(&corners).unwrap_or_default()
            }
            _ => Core::default(),
        }
    }

    /// Corners in direct contact with planes.
    pub fn corners(&self) -> u32 {
        if let Shape::Box { .. } = self { 8 } else { 0 }
    }

    /// Corner in the body frame and body size used as contact radius [m].
    pub fn corner(&self, k: usize, scale: f64) -> (Vec3, f64) {
        let half = self.half_sides(scale);
        (cuboid::corner(&half, k), half.min())
    }

    /// Scaled half lengths of a box [m]; else zero.
    pub fn half_sides(&self, scale: f64) -> Vec3 {
        match self {
            Shape::Box { half } => Vec3::from(*half) * scale,
            _ => Vec3::zeros(),
        }
    }
}
