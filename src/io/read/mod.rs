//! Readers of meshes and surfaces of other programs.
//!
//! Node ids become indices in file order.

mod abaqus;
mod abaqus_data;
pub(crate) mod abaqus_faces;
mod abaqus_lines;
mod abaqus_sets;
pub mod ansys_lists;
mod asc;
mod cdb;
mod cdb_blocks;
mod cdb_elements;
pub(crate) mod degenerate;
mod element_list;
mod error;
pub(crate) mod faces;
pub(crate) mod foreign_elements;
mod geotiff;
pub(crate) mod gmsh;
mod gmsh4;
mod grid;
mod header;
mod mesh_file;
pub mod number;
mod nwrite;
mod obj;
mod skin;
pub mod source;
mod stl;
pub mod surface;
mod table;
mod tokens;
pub mod unit;
pub mod vtk_arrays;
pub(crate) mod vtk_grid;
mod vtk_legacy;
mod vtu;
mod vtu_data;
pub(crate) mod xml;

use std::path::{Path, PathBuf};

pub use abaqus::read_inp;
pub use ansys_lists::{ElementColumns, ListLayout, Lists, read_lists};
pub use cdb::read_cdb;
pub use error::{Problem, ReadError};
pub use gmsh::read_gmsh;
pub use mesh_file::FARTHEST;
pub use mesh_file::{FileMaterial, MeshFile};
pub use obj::read_obj;
pub use stl::read_stl;
pub use surface::{SURFACE_ENDINGS, Surface, read_surface, surface_unit};
pub use vtk_legacy::read_vtk;
pub use vtu::read_vtu;

/// File extensions of meshes.
pub const MESH_ENDINGS: [&str; 5] = ["cdb", "msh", "inp", "vtu", "vtk"];

/// Lists the files read by [`read_mesh_file`].
pub fn mesh_files(path: &Path) -> Vec<PathBuf> {
    if path.is_dir() {
        return folder_files(path);
    }
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("inp") => abaqus_lines::files(path),
        _ => vec![path.to_path_buf()],
    }
}

/// Lists the files of a directory.
pub fn folder_files(folder: &Path) -> Vec<PathBuf> {
    [NODES, ELEMENTS, CONSTRAINTS].map(|name| folder.join(name)).to_vec()
}

const NODES: &str = "NODECOORD.DAT";
const ELEMENTS: &str = "ELEMENTNUM.DAT";
const CONSTRAINTS: &str = "DOF.DAT";

/// Reads a mesh, with its format given by the extension: `.cdb` (ANSYS archive), `.msh` (Gmsh), `.inp`
/// (Abaqus, CalculiX), `.vtu`, `.vtk`; a directory holds `NODECOORD.DAT`, `ELEMENTNUM.DAT` and optionally
/// `DOF.DAT`.
///
/// # Errors
/// Unknown extensions and errors of the format's reader.
pub fn read_mesh_file(path: &Path) -> Result<MeshFile, ReadError> {
    if path.is_dir() {
        let constraints = path.join(CONSTRAINTS);
        let constraints = constraints.exists().then_some(constraints);
        let nodes = path.join(NODES);
        let lists = read_lists(&nodes, &path.join(ELEMENTS), constraints.as_deref(), &ListLayout::default())?;
        return Ok(lists.into());
    }
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "cdb" => read_cdb(path),
        "msh" => read_gmsh(path),
        "inp" => read_inp(path),
        "vtu" => read_vtu(path),
        "vtk" => read_vtk(path),
        _ => {
            let found =
                if ending.is_empty() { "no file extension".to_string() } else { format!("\".{ending}\"") };
            let expected = ".cdb, .msh, .inp, .vtu, .vtk, or a directory with the three ANSYS lists";
            Err(ReadError::whole(path, "file extension", found, expected))
        }
    }
}
