//! The skin of a finite-element mesh as a surface of triangles: faces of one element only.
//!
//! Corners of faces are joined by straight edges: mid-side nodes of curved faces are left out, so neighbours agree.

use std::path::Path;

use super::error::ReadError;
use super::read_mesh_file;
use super::surface::Surface;

/// Reads a mesh and takes its skin.
///
/// # Errors
/// As [`read_mesh_file`].
pub fn read_skin(file: &Path) -> Result<Surface, ReadError> {
    let mesh = read_mesh_file(file)?.mesh;
    let mut surface = Surface { vertices: mesh.coordinates.clone(), triangles: Vec::new() };
    for face in mesh.boundary_faces() {
        let corners = face.corners();
        for pair in corners[1..].windows(2) {
            surface.triangles.push([corners[0], pair[0], pair[1]]);
        }
    }
    Ok(surface.without_loose_vertices())
}
