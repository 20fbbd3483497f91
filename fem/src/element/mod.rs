//! Elements: shape functions, faces and integration rules.
//!
//! Shape function arrays have the size of the largest kind, padded with zeros, so element loops need no
//! allocation.

#[cfg(test)]
mod checks;
mod face_shape;
pub mod hex20;
pub mod hex8;
mod kind;
pub mod pyramid13;
pub mod pyramid5;
pub mod quad4;
pub mod quad8;
pub mod quadrature;
mod table;
pub mod tet10;
pub mod tet4;
pub mod tri3;
pub mod tri6;
pub mod wedge15;
pub mod wedge6;

pub use face_shape::{FaceShape, MAX_FACE_NODES};
pub use kind::{ElementKind, MAX_NODES};
pub use table::{IntegrationPoint, mass_points, stiffness_points};
