//! Result files and meshes, one writer per file.
//!
//! Every file appears whole or not at all ([`atomic`]), except the history ([`csv`]), which grows by whole
//! rows. No writer writes a number that is not finite: it names the field and the index instead.

mod abaqus;
pub mod ansys_lists;
pub mod atomic;
mod cdb;
pub mod csv;
pub mod error;
mod gmsh;
mod mesh_file;
pub mod pvd;
#[cfg(test)]
pub(crate) mod sample;
pub mod stl;
pub mod svg;
pub mod tecplot;
mod vtk;
mod vtk_legacy;
#[cfg(test)]
mod vtk_oracle;
pub mod vtp;
pub mod vtu;

pub use error::WriteError;
pub use mesh_file::{MeshOptions, write_mesh_file};
pub use vtp::{ChainFrame, GrainFrame, WallFrame};
pub use vtu::SolidFrame;
