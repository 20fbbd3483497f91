//! Skin of a finite-element mesh as triangles.

use std::path::Path;

use super::error::ReadError;
use super::read_mesh_file;
use super::surface::Surface;

/// Reads the skin of a mesh.
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
