//! Writer of legacy VTK (`.vtk`), text, version 3.0, with the arrays of `vtu::write_mesh_file`.

use std::fmt::Write;
use std::path::Path;

use crate::read::MeshFile;
use crate::read::foreign_elements::foreign;

use super::atomic;
use super::error::WriteError;
use super::vtu::{cell_sets, constraint_arrays, membership};

pub(super) fn write_vtk(path: &Path, file: &MeshFile) -> Result<(), WriteError> {
    let text = text(file).map_err(|e| WriteError::format(path, e))?;
    atomic::write(path, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(path)))
}

/// Blanks become `%20`.
fn encode(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_graphic() && b != b'%' && b != b'"';
    name.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

fn text(file: &MeshFile) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let (nodes, cells) = (mesh.node_count(), mesh.element_count());
    let mut out = String::from("# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\n");
    writeln!(out, "POINTS {nodes} double")?;
    for [x, y, z] in &mesh.coordinates {
        writeln!(out, "{x:?} {y:?} {z:?}")?;
    }
    writeln!(out, "CELLS {cells} {}", cells + mesh.connectivity.nodes().len())?;
    for nodes in mesh.connectivity.iter() {
        let row: String = nodes.iter().map(|n| format!(" {n}")).collect();
        writeln!(out, "{}{row}", nodes.len())?;
    }
    writeln!(out, "CELL_TYPES {cells}")?;
    for kind in mesh.connectivity.kinds() {
        writeln!(out, "{}", foreign(*kind).vtk.0)?;
    }
    let (mask, values) = constraint_arrays(file);
    writeln!(out, "POINT_DATA {nodes}\nFIELD points {}", 3 + file.node_sets.len())?;
    column(&mut out, "node_id", "unsigned_int", &mesh.node_ids)?;
    column(&mut out, "constraint", "unsigned_int", &mask)?;
    writeln!(out, "constraint_value 3 {nodes} double")?;
    for [x, y, z] in &values {
        writeln!(out, "{x:?} {y:?} {z:?}")?;
    }
    for (name, members) in &file.node_sets {
        let name = encode(&format!("node_set:{name}"));
        column(&mut out, &name, "unsigned_char", &membership(members, nodes))?;
    }
    let sets = cell_sets(file);
    writeln!(out, "CELL_DATA {cells}\nFIELD cells {}", 2 + sets.len())?;
    column(&mut out, "material", "unsigned_int", &mesh.materials)?;
    column(&mut out, "element_id", "unsigned_int", &mesh.element_ids)?;
    for (name, values) in &sets {
        column(&mut out, &encode(name), "unsigned_char", values)?;
    }
    Ok(out)
}

fn column(out: &mut String, name: &str, kind: &str, values: &[u32]) -> std::fmt::Result {
    writeln!(out, "{name} 1 {} {kind}", values.len())?;
    values.iter().try_for_each(|value| writeln!(out, "{value}"))
}
