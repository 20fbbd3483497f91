//! Readers of meshes made by other programs.
//!
//! Every reader returns the mesh with node numbers mapped to indices in file order, and refuses what it does
//! not understand with one sentence that names file, line, field, what stands there and what belongs there.

pub mod ansys_lists;
mod element_list;
mod error;
mod number;
mod table;

pub use ansys_lists::{ElementColumns, ListLayout, Lists, read_lists};
pub use error::ReadError;
