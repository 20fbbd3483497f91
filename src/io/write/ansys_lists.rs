//! Writer of the ANSYS lists.

use std::path::Path;

use trackbed_fem::mesh::{Constraint, Mesh};

use super::atomic;
use super::error::{WriteError, check_field};
use crate::read::degenerate::to_brick;

/// Writes `NODECOORD.DAT`, `ELEMENTNUM.DAT` and `DOF.DAT` into `dir`. Other kinds are bricks with repeated
/// nodes; linear kinds have mid-side nodes 0.
///
/// # Errors
/// Non-finite coordinates or values; I/O errors.
pub fn write_lists(mesh: &Mesh, constraints: &[Constraint], dir: &Path) -> Result<(), WriteError> {
    let nodes = dir.join("NODECOORD.DAT");
    check_field(&nodes, "coordinates", mesh.coordinates.as_flattened(), 3, mesh.node_count())?;
    atomic::write(&nodes, |out| {
        for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.coordinates) {
            writeln!(out, "{id:8} {x:24.16e} {y:24.16e} {z:24.16e}").map_err(WriteError::io(&nodes))?;
        }
        Ok(())
    })?;

    let elements = dir.join("ELEMENTNUM.DAT");
    atomic::write(&elements, |out| {
        for (e, row) in mesh.connectivity.iter().enumerate() {
            let mut line = format!("{:8} {:4}", mesh.element_ids[e], mesh.materials[e]);
            let ids: Vec<u32> = row.iter().map(|node| mesh.node_ids[*node as usize]).collect();
            let mut brick = to_brick(mesh.connectivity.kind(e), &ids);
            brick.resize(20, 0);
            for node in brick {
                line += &format!(" {node:7}");
            }
            writeln!(out, "{line}").map_err(WriteError::io(&elements))?;
        }
        Ok(())
    })?;

    let dof = dir.join("DOF.DAT");
    let values: Vec<f64> = constraints.iter().map(|c| c.value).collect();
    check_field(&dof, "value", &values, 1, constraints.len())?;
    atomic::write(&dof, |out| {
        for c in constraints {
            let (id, direction, value) = (mesh.node_ids[c.node as usize], c.direction + 1, c.value);
            writeln!(out, "{id:8} {direction} {value:24.16e}").map_err(WriteError::io(&dof))?;
        }
        Ok(())
    })
}
