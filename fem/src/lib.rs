//! Implicit finite elements for ballasted track: 20-node hexahedra, statics and Newmark dynamics.
pub mod mesh;
