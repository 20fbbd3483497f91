//! Writers of result files and meshes.
//!
//! Files are replaced atomically ([`atomic`]), except histories ([`csv`]), which grow by rows.

mod abaqus;
pub mod ansys_lists;
pub mod asc;
pub mod atomic;
mod body_fields;
mod cdb;
mod choice;
pub mod csv;
pub mod depth_map;
pub mod error;
mod fields;
mod frame;
mod gmsh;
pub mod hdf5;
mod mesh_file;
pub mod pvd;
#[cfg(test)]
pub(crate) mod sample;
mod solid_fields;
pub mod stl;
pub mod tecplot;
mod vtk;
mod vtk_frames;
mod vtk_legacy;
#[cfg(test)]
mod vtk_oracle;
mod vtkhdf;
pub mod vtp;
pub mod vtu;
pub mod writer;

pub use body_fields::{BODY_FIELDS, MADE_FIELDS, STONE_BODY, STONE_CENTRE, body_field};
pub use choice::Choice;
pub use error::WriteError;
pub use fields::{FrameField, Needs, Written};
pub use frame::{
    ChainFrame, Frame, GrainFrame, NO_BODY, NodalValues, SolidFrame, Values, WallFrame, WallKind,
};
pub use mesh_file::{MeshOptions, write_mesh_file};
pub use solid_fields::{SOLID_FIELDS, SOLID_PARTS, solid_label};
pub use writer::{Format, Mark, Part, Writers};

/// Frame formats, in order of writing.
pub const FORMATS: [&Format; 3] = [&vtk_frames::FORMAT, &tecplot::FORMAT, &vtkhdf::FORMAT];
