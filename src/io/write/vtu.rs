//! Solid and meshes as VTK unstructured grid (`.vtu`).
//!
//! Node order is unchanged: VTK_QUADRATIC_HEXAHEDRON as SOLID186, and VTK_WEDGE, unlike in old documentation,
//! with the first triangle seen from inside.

use std::path::Path;

use crate::read::MeshFile;
use crate::read::foreign_elements::foreign;
use trackbed_fem::mesh::Mesh;

use super::choice::Choice;
use super::error::WriteError;
use super::frame::{NodalValues, SolidFrame};
use super::vtk::{self, Array, Fields, Section};

/// Writes the solid: point and cell data.
///
/// # Errors
/// Wrong field length, non-finite values; I/O errors.
pub fn write_solid(file: &Path, frame: &SolidFrame, choice: Choice<'_>) -> Result<(), WriteError> {
    let mut fields = Fields::of_points(file, frame.mesh.node_count()).only(choice);
    for (name, values) in &frame.fields {
        match values {
            NodalValues::Numbers(values) => fields.scalar(name, values)?,
            NodalValues::Vectors(values) => fields.vector(name, values)?,
            NodalValues::Tensors(values) => fields.tensor(name, values)?,
        }
    }
    fields.ids("node_id", &frame.mesh.node_ids)?;
    write_grid(file, frame.mesh, fields, &[])
}

/// Writes a natural mode: point data `displacement` (largest component 1) and `node_id`.
///
/// # Errors
/// As [`write_solid`].
pub fn write_mode(file: &Path, mesh: &Mesh, shape: &[f64]) -> Result<(), WriteError> {
    let mut fields = Fields::of_points(file, mesh.node_count());
    fields.vector("displacement", shape)?;
    fields.ids("node_id", &mesh.node_ids)?;
    write_grid(file, mesh, fields, &[])
}

/// Writes a mesh with ids, constraints and sets.
///
/// # Errors
/// As [`write_solid`].
pub fn write_mesh_file(file: &Path, content: &MeshFile) -> Result<(), WriteError> {
    let mesh = &content.mesh;
    let (mask, values) = constraint_arrays(content);
    let mut fields = Fields::of_points(file, mesh.node_count());
    fields.ids("node_id", &mesh.node_ids)?;
    fields.ids("constraint", &mask)?;
    fields.vector("constraint_value", values.as_flattened())?;
    for (name, members) in &content.node_sets {
        fields.ids(&format!("node_set:{name}"), &membership(members, mesh.node_count()))?;
    }
    write_grid(file, mesh, fields, &cell_sets(content))
}

/// Direction bits and values per node.
pub(super) fn constraint_arrays(content: &MeshFile) -> (Vec<u32>, Vec<[f64; 3]>) {
    let nodes = content.mesh.node_count();
    let (mut mask, mut values) = (vec![0_u32; nodes], vec![[0.0; 3]; nodes]);
    for c in &content.constraints {
        mask[c.node as usize] |= 1 << c.direction;
        values[c.node as usize][c.direction as usize] = c.value;
    }
    (mask, values)
}

pub(super) fn cell_sets(content: &MeshFile) -> Vec<(String, Vec<u32>)> {
    let elements = content.mesh.element_count();
    let of_elements = content.element_sets.iter();
    let of_elements = of_elements.map(|(n, m)| (format!("element_set:{n}"), membership(m, elements)));
    let of_faces = content.face_sets.iter();
    let of_faces = of_faces.map(|(n, m)| (format!("face_set:{n}"), face_bits(m, elements)));
    of_elements.chain(of_faces).collect()
}

fn face_bits(members: &[[u32; 2]], elements: usize) -> Vec<u32> {
    let mut bits = vec![0; elements];
    for [element, side] in members {
        bits[*element as usize] |= 1 << side;
    }
    bits
}

pub(super) fn membership(members: &[u32], count: usize) -> Vec<u32> {
    let mut flags = vec![0; count];
    for member in members {
        flags[*member as usize] = 1;
    }
    flags
}

fn write_grid(
    file: &Path,
    mesh: &Mesh,
    point_fields: Fields,
    sets: &[(String, Vec<u32>)],
) -> Result<(), WriteError> {
    let elements = mesh.element_count();
    let mut cell_fields = Fields::of_cells(file, elements);
    cell_fields.ids("material", &mesh.materials)?;
    cell_fields.ids("element_id", &mesh.element_ids)?;
    for (name, values) in sets {
        cell_fields.ids(name, values)?;
    }
    let (nodes, kinds) = (mesh.connectivity.nodes(), mesh.connectivity.kinds());
    let ends = kinds.iter().scan(0, |end, kind| {
        *end += kind.node_count() as u64;
        Some(*end)
    });
    let cells = Section::cells("Cells", nodes.iter().map(|n| u64::from(*n)), ends);
    let types = kinds.iter().map(|kind| foreign(*kind).vtk.0).collect();
    vtk::write(
        file,
        "UnstructuredGrid",
        &[("NumberOfPoints", mesh.node_count()), ("NumberOfCells", elements)],
        &[
            point_fields.finish(),
            cell_fields.finish(),
            Section::points(file, &mesh.coordinates)?,
            cells.with(Array::bytes("types", types)),
        ],
    )
}

#[cfg(test)]
mod tests {
    use trackbed_fem::mesh::Constraint;
    use vtkio::model::{CellType, DataSet};

    use super::*;
    use crate::write::sample;

    #[test]
    fn rejects_nonfinite_field() {
        let dir = sample::folder("vtu_nan");
        let file = dir.join("solid.vtu");
        let mesh = sample::block([2, 1, 1]);
        let n = mesh.node_count();
        let (u, stress, scalar) = (vec![0.0; 3 * n], vec![[0.0; 6]; n], vec![0.0; n]);
        let good = sample::solid(&mesh, &u, &stress, &scalar);
        let with = |name, values| {
            write_solid(&file, &sample::with(&good, name, values), Choice::default()).unwrap_err()
        };
        let mut bad = stress.clone();
        bad[5][4] = f64::NAN;
        let error = with("stress", NodalValues::Tensors(bad.into()));
        assert_eq!(error.to_string(), format!("{}: stress at index 5 is NaN: not written", file.display()));
        let mut bad = u.clone();
        bad[3 * 7 + 1] = f64::INFINITY;
        let error = with("velocity", NodalValues::Vectors(bad.into()));
        assert!(error.to_string().contains("velocity at index 7 is inf"), "{error}");
        let error = with("von_mises", NodalValues::Numbers((&scalar[1..]).into()));
        assert!(error.to_string().contains(&format!("von_mises has {} values", n - 1)), "{error}");
        assert!(!file.exists());
        write_solid(&file, &good, Choice::default()).unwrap();
        assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 1);
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn file_reads_back_exactly() {
        let dir = sample::folder("vtu_back");
        let file = dir.join("mesh.vtu");
        let mesh = sample::block([3, 2, 2]);
        let constraints =
            [(0, 0), (0, 2), (4, 1)].map(|(node, direction)| Constraint { node, direction, value: 0.0 });
        let content =
            MeshFile { mesh: mesh.clone(), constraints: constraints.to_vec(), ..Default::default() };
        write_mesh_file(&file, &content).unwrap();
        let vtk = vtkio::Vtk::import(&file).unwrap();
        let DataSet::UnstructuredGrid { mut pieces, .. } = vtk.data else { panic!("not a grid") };
        let piece = pieces.remove(0).into_loaded_piece_data(None).unwrap();
        assert_eq!(piece.points.into_vec::<f64>().unwrap(), mesh.coordinates.as_flattened());
        assert!(piece.cells.types.iter().all(|t| *t == CellType::QuadraticHexahedron));
        let (connectivity, _) = piece.cells.cell_verts.into_xml();
        assert!(
            connectivity.iter().eq(mesh
                .connectivity
                .iter()
                .flatten()
                .map(|n| u64::from(*n))
                .collect::<Vec<_>>()
                .iter())
        );
        let mask = piece.data.point.iter().find_map(|a| match a {
            vtkio::model::Attribute::DataArray(a) if a.name == "constraint" => a.data.cast_into::<u32>(),
            _ => None,
        });
        let mask = mask.unwrap();
        assert_eq!((mask[0], mask[1], mask[4]), (5, 0, 2));
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
