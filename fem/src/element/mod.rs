//! Elements: shape functions of the 20-node hexahedron and of its 8-node face, and the Gauss rules.
#[cfg(test)]
mod checks;
pub mod hex20;
pub mod hex8;
pub mod pyramid13;
pub mod pyramid5;
pub mod quad4;
pub mod quad8;
pub mod quadrature;
pub mod tet10;
pub mod tet4;
pub mod tri3;
pub mod tri6;
pub mod wedge15;
pub mod wedge6;
