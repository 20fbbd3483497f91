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
mod natural_shape;
mod properties;
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
pub use kind::MAX_NODES;
pub use natural_shape::NaturalShape;
pub use properties::{Locking, Properties};
pub use table::{IntegrationPoint, mass_points, stiffness_points};

use serde::{Deserialize, Serialize};

// The order numbers the kinds in files.
kind::elements! { $
    /// 20-node serendipity hexahedron.
    Hex20 = hex20;
    /// 15-node wedge.
    Wedge15 = wedge15;
    /// 13-node pyramid.
    Pyramid13 = pyramid13;
    /// 10-node tetrahedron.
    Tet10 = tet10;
    /// 8-node hexahedron.
    Hex8 = hex8;
    /// 6-node wedge.
    Wedge6 = wedge6;
    /// 5-node pyramid.
    Pyramid5 = pyramid5;
    /// 4-node tetrahedron.
    Tet4 = tet4;
}
