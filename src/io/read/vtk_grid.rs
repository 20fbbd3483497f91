//! VTK unstructured grid as a mesh.
//!
//! | array | meaning |
//! |---|---|
//! | points: `node_id` | node ids; else 1, 2, … |
//! | points: `constraint`, `constraint_value` | 1 for x, plus 2 for y, plus 4 for z; three values, else 0 |
//! | points: `node_set:NAME`, cells: `element_set:NAME` | members where not 0 |
//! | cells: `face_set:NAME` | bits of member faces: 1 for the first of the kind, plus 2 for the second, … |
//! | cells: `element_id` | element ids; else 1, 2, … |
//! | cells: `material` (or MaterialIds, MaterialID, gmsh:physical, CellEntityIds) | material ids; else 1 |
//!
//! VTK up to 9.0 documented wedges with reversed triangles; inverted wedges are reversed with a warning.
//!
//! Source: VTK's classes vtkQuadraticHexahedron and so on; checked with VTK 9.7 (`tests/vtk_check.py`).

use trackbed_fem::ElementKind;

use super::error::ReadError;
use super::foreign_elements::{FOREIGN, listed};
use super::mesh_file::{Builder, MeshFile};

#[derive(Clone, Debug, Default)]
pub(super) struct Array {
    pub name: String,
    pub components: usize,
    pub values: Vec<f64>,
}

#[derive(Default)]
pub(super) struct Grid {
    pub points: Vec<f64>,
    pub connectivity: Vec<f64>,
    /// End of each cell in `connectivity`.
    pub ends: Vec<f64>,
    pub types: Vec<f64>,
    pub point_data: Vec<Array>,
    pub cell_data: Vec<Array>,
}

const LOWER: [u8; 18] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 28, 30, 34, 35, 36];
const VOXEL: u8 = 11;

const MATERIALS: [&str; 5] = ["material", "MaterialIds", "MaterialID", "gmsh:physical", "CellEntityIds"];

pub(super) fn mesh(mut builder: Builder, grid: Grid) -> Result<MeshFile, ReadError> {
    let (nodes, cells) = (grid.points.len() / 3, grid.types.len());
    if !grid.points.len().is_multiple_of(3) {
        let found = format!("{} numbers", grid.points.len());
        return Err(builder.fault(0, "points", found, "three numbers per point"));
    }
    if grid.ends.len() != cells {
        return Err(builder.fault(0, "cells", format!("{} ends", grid.ends.len()), format!("{cells}")));
    }
    for (what, data, count) in [("point", &grid.point_data, nodes), ("cell", &grid.cell_data, cells)] {
        let wrong = data.iter().find(|a| a.values.len() != count.saturating_mul(a.components));
        if let Some(array) = wrong {
            let found = format!("{} numbers", array.values.len());
            let expected = format!("{count} x {}", array.components);
            return Err(builder.fault(0, format!("{what} array {}", array.name), found, expected));
        }
    }
    let ids = Ids::of(&grid.point_data, &["node_id"], 1);
    let node_ids = (0..nodes).map(|at| ids.get(&builder, at)).collect::<Result<Vec<u32>, _>>()?;
    for (id, x) in node_ids.iter().zip(grid.points.chunks_exact(3)) {
        builder.node(0, *id, [x[0], x[1], x[2]])?;
    }
    let kept = elements(&mut builder, &grid, &node_ids)?;
    constraints(&mut builder, &grid)?;
    for array in grid.point_data.iter().filter(|a| a.components == 1) {
        if let Some(name) = array.name.strip_prefix("node_set:") {
            let set = array.values.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(i, _)| i as u32);
            builder.node_set(name, set);
        }
    }
    for array in grid.cell_data.iter().filter(|a| a.components == 1) {
        if let Some(name) = array.name.strip_prefix("face_set:") {
            face_set(&mut builder, name, &kept, array)?;
        }
        if let Some(name) = array.name.strip_prefix("element_set:") {
            let set = kept.iter().enumerate().filter(|(_, cell)| array.values[**cell] != 0.0);
            builder.element_set(name, set.map(|(index, _)| index as u32));
        }
    }
    builder.finish()
}

/// Ids: the first named array present, else `first`, `first + step`…
struct Ids<'a> {
    array: Option<&'a Array>,
    step: u32,
}

impl Ids<'_> {
    fn of<'a>(data: &'a [Array], names: &[&str], step: u32) -> Ids<'a> {
        let array = names.iter().find_map(|name| data.iter().find(|a| a.name == *name && a.components == 1));
        Ids { array, step }
    }

    /// Id of a point or cell; skipped cells need none.
    fn get(&self, builder: &Builder, at: usize) -> Result<u32, ReadError> {
        let Some(array) = self.array else { return Ok(1 + at as u32 * self.step) };
        let value = array.values[at];
        let fits = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
        fits.then_some(value as u32).ok_or_else(|| {
            builder.fault(0, format!("array {}", array.name), value.to_string(), "whole numbers of 0 or more")
        })
    }
}

/// Adds volume cells; returns their indices.
fn elements(builder: &mut Builder, grid: &Grid, node_ids: &[u32]) -> Result<Vec<usize>, ReadError> {
    let cells = grid.types.len();
    let element_ids = Ids::of(&grid.cell_data, &["element_id"], 1);
    let materials = Ids::of(&grid.cell_data, &MATERIALS, 0);
    let (mut start, mut turned, mut kept) = (0, 0, Vec::with_capacity(cells));
    for cell in 0..cells {
        let (type_number, end) = (grid.types[cell], grid.ends[cell]);
        let in_order = end >= start as f64 && end <= grid.connectivity.len() as f64;
        let key = || format!("cell {cell}");
        if !in_order {
            let expected = format!("an end from {start} to {}", grid.connectivity.len());
            return Err(builder.fault(0, key(), format!("end {end}"), expected));
        }
        let places = &grid.connectivity[start..end as usize];
        start = end as usize;
        let number = if (0.0..=255.0).contains(&type_number) { type_number as u8 } else { u8::MAX };
        if LOWER.contains(&number) {
            builder.leave_out(&format!("VTK {number}"));
            continue;
        }
        let mut of_cell = Vec::with_capacity(places.len());
        for place in places {
            match node_ids.get(*place as usize).filter(|_| *place >= 0.0) {
                Some(id) => of_cell.push(*id),
                None => {
                    let expected = format!("a point from 0 to {}", node_ids.len().saturating_sub(1));
                    return Err(builder.fault(0, key(), format!("point {place}"), expected));
                }
            }
        }
        let (kind, name) = match FOREIGN.iter().find(|row| row.vtk.0 == number) {
            Some(row) => (row.kind, row.vtk.1),
            None if number == VOXEL && of_cell.len() == 8 => {
                of_cell.swap(2, 3);
                of_cell.swap(6, 7);
                (ElementKind::Hex8, "VTK_VOXEL")
            }
            None => {
                let expected = format!("{} or VTK_VOXEL", listed(|row| row.vtk.1));
                return Err(builder.fault(0, key(), format!("VTK type {type_number}"), expected));
            }
        };
        let (id, material) = (element_ids.get(builder, cell)?, materials.get(builder, cell)?);
        builder.element(0, id, material, (kind, &format!("{name} {}", kind.name())), &of_cell)?;
        let index = builder.made.mesh.element_count() - 1;
        if kind.linear() == ElementKind::Wedge6 && builder.made.mesh.element_volume(index) < 0.0 {
            turn(&mut builder.made.mesh.connectivity[index]);
            turned += 1;
        }
        kept.push(cell);
    }
    if turned > 0 {
        builder.warn(format!("{turned} wedges reordered (first triangle seen from outside)"));
    }
    Ok(kept)
}

/// Bit k of a cell value selects face k, from 0.
fn face_set(builder: &mut Builder, name: &str, kept: &[usize], array: &Array) -> Result<(), ReadError> {
    let mut faces = Vec::new();
    for (element, cell) in kept.iter().enumerate() {
        let (bits, sides) = (array.values[*cell], builder.made.mesh.connectivity.kind(element).faces().len());
        if bits.fract() != 0.0 || !(0.0..f64::from(1_u32 << sides)).contains(&bits) {
            let expected = format!("0 to {}: a bit for each of {sides} faces", (1 << sides) - 1);
            return Err(builder.fault(
                0,
                format!("array {} of cell {cell}", array.name),
                bits.to_string(),
                expected,
            ));
        }
        let of_cell = (0..sides as u32).filter(|side| bits as u32 & (1 << side) != 0);
        faces.extend(of_cell.map(|side| [element as u32, side]));
    }
    builder.face_set(name, faces);
    Ok(())
}

fn turn(nodes: &mut [u32]) {
    nodes.swap(1, 2);
    nodes.swap(4, 5);
    if nodes.len() == 15 {
        nodes.swap(6, 8);
        nodes.swap(9, 11);
        nodes.swap(13, 14);
    }
}

fn constraints(builder: &mut Builder, grid: &Grid) -> Result<(), ReadError> {
    let array = |name: &str, components| {
        grid.point_data.iter().find(|a| a.name == name && a.components == components)
    };
    let Some(mask) = array("constraint", 1) else {
        builder.made.no_constraints = true;
        return Ok(());
    };
    let values = array("constraint_value", 3);
    for (node, bits) in mask.values.iter().enumerate() {
        if bits.fract() != 0.0 || !(0.0..=7.0).contains(bits) {
            let key = format!("constraint of point {node}");
            return Err(builder.fault(0, key, bits.to_string(), "0 to 7"));
        }
        for direction in 0..3_u8 {
            if *bits as u8 & (1 << direction) != 0 {
                let value = values.map_or(0.0, |v| v.values[3 * node + direction as usize]);
                builder.constrain(0, node as u32, direction, value)?;
            }
        }
    }
    Ok(())
}
