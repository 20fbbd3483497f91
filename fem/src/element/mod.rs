//! Elements: shape functions of the 20-node hexahedron and of its 8-node face, and the Gauss rules.
pub mod hex20;
pub mod quad8;
pub mod quadrature;
