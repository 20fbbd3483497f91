//! Faces of volume elements.

use super::quadrature::{FACE2, FACE3, FacePoint, TRIANGLE3, TRIANGLE7};
use super::{quad4, quad8, tri3, tri6};

/// Largest number of nodes of a face.
pub const MAX_FACE_NODES: usize = 8;

/// Kind of face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaceShape {
    /// 8-node quadrilateral.
    Quad8,
    /// 6-node triangle.
    Tri6,
    /// 4-node quadrilateral.
    Quad4,
    /// 3-node triangle.
    Tri3,
}

impl FaceShape {
    /// Face shape with `count` nodes.
    pub const fn with_nodes(count: usize) -> FaceShape {
        match count {
            8 => FaceShape::Quad8,
            6 => FaceShape::Tri6,
            4 => FaceShape::Quad4,
            _ => FaceShape::Tri3,
        }
    }

    /// Node count.
    #[inline]
    pub const fn node_count(self) -> usize {
        match self {
            FaceShape::Quad8 => 8,
            FaceShape::Tri6 => 6,
            FaceShape::Quad4 => 4,
            FaceShape::Tri3 => 3,
        }
    }

    /// Number of corners.
    #[inline]
    pub const fn corner_count(self) -> usize {
        match self {
            FaceShape::Quad8 | FaceShape::Quad4 => 4,
            FaceShape::Tri6 | FaceShape::Tri3 => 3,
        }
    }

    /// Centre of the natural shape.
    pub const fn natural_centre(self) -> [f64; 2] {
        match self {
            FaceShape::Quad8 | FaceShape::Quad4 => [0.0; 2],
            FaceShape::Tri6 | FaceShape::Tri3 => [1.0 / 3.0; 2],
        }
    }

    /// Shape functions, padded with zeros.
    pub fn shape_functions(self, xi: [f64; 2]) -> [f64; MAX_FACE_NODES] {
        match self {
            FaceShape::Quad8 => quad8::shape_functions(xi),
            FaceShape::Tri6 => padded(tri6::shape_functions(xi)),
            FaceShape::Quad4 => padded(quad4::shape_functions(xi)),
            FaceShape::Tri3 => padded(tri3::shape_functions(xi)),
        }
    }

    /// Derivatives by (xi, eta), padded with zeros.
    pub fn gradients(self, xi: [f64; 2]) -> [[f64; 2]; MAX_FACE_NODES] {
        match self {
            FaceShape::Quad8 => quad8::gradients(xi),
            FaceShape::Tri6 => padded(tri6::gradients(xi)),
            FaceShape::Quad4 => padded(quad4::gradients(xi)),
            FaceShape::Tri3 => padded(tri3::gradients(xi)),
        }
    }

    /// Integration rule for face loads: exact for products of two shape functions on flat faces with straight
    /// sides.
    pub fn points(self) -> &'static [FacePoint] {
        match self {
            FaceShape::Quad8 => &FACE3,
            FaceShape::Tri6 => &TRIANGLE7,
            FaceShape::Quad4 => &FACE2,
            FaceShape::Tri3 => &TRIANGLE3,
        }
    }
}

fn padded<T: Copy + Default, const N: usize>(values: [T; N]) -> [T; MAX_FACE_NODES] {
    let mut all = [T::default(); MAX_FACE_NODES];
    all[..N].copy_from_slice(&values);
    all
}
