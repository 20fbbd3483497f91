//! trackbed: coupled DEM–FEM solver for ballasted railway track.
//!
//! Data flows one way: a scene file ([`scene`]) is resolved into models, the run loop ([`run`]) steps them,
//! and writers ([`mod@write`]) put the results on disk.

pub mod mesh_tools;
pub mod read;
pub mod write;
