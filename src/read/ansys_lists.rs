//! The three ANSYS lists: `NODECOORD.DAT`, `ELEMENTNUM.DAT` and `DOF.DAT`.
//!
//! Our layout, written by the macros of `inputs/ansys`, one row per item:
//!
//! | list | columns |
//! |---|---|
//! | nodes | `id x y z` [m] |
//! | elements | `id mat n1 … n20`, SOLID186 order I…P, Q…T, U…X, Y…B |
//! | constraints | `node dir value`: dir 1, 2, 3, UX, UY, UZ or ALL; value [m], absent means 0 |
//!
//! Also read: elements without number or without material or without both, of several lines each, and
//! listings of the commands NLIST, ELIST and DLIST. How numbers, separators, comments and headers may be
//! written is said in the `number` and `table` modules beside this one.
//!
//! Limits: full 20-node hexahedra only; nodes in rotated coordinate systems are refused, since constraints
//! would be in rotated directions.

use std::collections::HashMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::{Constraint, HEX20_NODES, Mesh};

use super::element_list::{self, Columns, Record};
use super::error::ReadError;
use super::number;
use super::table::{self, Row, Table};

/// What the columns of the element list are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementColumns {
    /// Recognised by their count; of 21 columns the first is a material where its values repeat.
    #[default]
    Auto,
    /// `id mat n1…n20`.
    IdMaterialNodes,
    /// `id n1…n20`.
    IdNodes,
    /// `mat n1…n20`.
    MaterialNodes,
    /// `n1…n20`.
    Nodes,
}

/// What a scene tells about the lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ListLayout {
    /// Columns of the element list. Default: recognised.
    pub columns: ElementColumns,
    /// Material number of elements in a list without a material column. Default 1.
    pub material: u32,
}

impl Default for ListLayout {
    fn default() -> Self {
        ListLayout { columns: ElementColumns::Auto, material: 1 }
    }
}

/// What the lists hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// The mesh; nodes and elements in file order, without nodes that belong to no element.
    pub mesh: Mesh,
    /// Constraints in file order, one per node and direction.
    pub constraints: Vec<Constraint>,
    /// What was guessed or looks like a mistake, one sentence each.
    pub warnings: Vec<String>,
}

/// Reads the lists; without a constraint list there are no constraints.
///
/// # Errors
/// The first fault: a missing or empty file, wrong columns, an unreadable or non-finite number, a number
/// given twice, an absent or repeated node in an element, a constraint on an absent node, in an unknown
/// direction, or with two values.
pub fn read_lists(
    nodes: &Path,
    elements: &Path,
    constraints: Option<&Path>,
    layout: &ListLayout,
) -> Result<Lists, ReadError> {
    let mut lists = Lists::default();
    let index = read_nodes(nodes, &mut lists)?;
    read_elements(elements, layout, &index, &mut lists)?;
    if let Some(file) = constraints {
        read_constraints(file, &index, &mut lists)?;
    }
    drop_unused_nodes(nodes, &mut lists);
    Ok(lists)
}

/// Index of each node number.
type NodeIndex = HashMap<u32, u32>;

fn read_nodes(file: &Path, lists: &mut Lists) -> Result<NodeIndex, ReadError> {
    let table = Table::read(file, "node list")?;
    lists.warnings.extend(table.warnings.iter().cloned());
    if table.rows.is_empty() {
        return Err(ReadError::whole(file, "nodes", "none", "at least 20 rows of id x y z"));
    }
    let mut index = NodeIndex::with_capacity(table.rows.len());
    for (i, row) in table.rows.iter().enumerate() {
        // NLIST adds the three angles of the nodal coordinate system.
        if row.width() != 4 && row.width() != 7 {
            let found = row.width().to_string();
            return Err(ReadError::at(file, row.line, "columns of a node", found, "4 (id x y z)"));
        }
        let id = table.whole(row, 0, "node number")?;
        let mut point = [0.0; 3];
        for (axis, name) in ["coordinate x", "coordinate y", "coordinate z"].iter().enumerate() {
            point[axis] = table.real(row, axis + 1, name)?;
        }
        for column in 4..row.width() {
            if table.real(row, column, "nodal rotation")? != 0.0 {
                let found = table.field(row, column);
                return Err(ReadError::at(file, row.line, "nodal rotation", found, "0 (global directions)"));
            }
        }
        if let Some(first) = index.insert(id, i as u32) {
            return Err(named_twice(&table, "node", id, table.rows[first as usize].line, row.line));
        }
        lists.mesh.node_ids.push(id);
        lists.mesh.coordinates.push(point);
    }
    Ok(index)
}

fn named_twice(table: &Table, what: &str, id: u32, first: usize, again: usize) -> ReadError {
    let key = format!("{what} {id}");
    ReadError::at(&table.file, again, key, format!("it again after line {first}"), "each number once")
}

fn read_elements(
    file: &Path,
    layout: &ListLayout,
    index: &NodeIndex,
    lists: &mut Lists,
) -> Result<(), ReadError> {
    let table = Table::read(file, "element list")?;
    lists.warnings.extend(table.warnings.iter().cloned());
    if table.rows.is_empty() {
        return Err(ReadError::whole(file, "elements", "none", "at least one row of id mat n1…n20"));
    }
    let (columns, records) = element_list::split(&table, layout.columns, &mut lists.warnings)?;
    let mut lines = HashMap::with_capacity(records.len());
    for (i, record) in records.into_iter().enumerate() {
        let (id, material, nodes) = read_element(&table, columns, record, i, index)?;
        let line = table.rows[record.first].line;
        if let Some(first) = lines.insert(id, line) {
            return Err(named_twice(&table, "element", id, first, line));
        }
        lists.mesh.push_element(id, material.unwrap_or(layout.material), ElementKind::Hex20, &nodes);
    }
    Ok(())
}

type Element = (u32, Option<u32>, [u32; HEX20_NODES]);

fn read_element(
    table: &Table,
    columns: Columns,
    record: Record,
    position: usize,
    index: &NodeIndex,
) -> Result<Element, ReadError> {
    let file = &table.file;
    let mut id = position as u32 + 1;
    let mut material = None;
    let mut nodes = [0; HEX20_NODES];
    let mut ids = [0; HEX20_NODES];
    for (column, (line, text)) in element_list::fields(table, record).enumerate() {
        let value = |key: &str| table::whole(file, line, text, key);
        if Some(column) == columns.id {
            id = value("element number")?;
        } else if Some(column) == columns.material {
            material = Some(value(&format!("material of element {id}"))?);
        } else if let Some(n) = column.checked_sub(columns.nodes) {
            let key = format!("element {id}, node n{}", n + 1);
            ids[n] = value(&key)?;
            nodes[n] = *index.get(&ids[n]).ok_or_else(|| {
                let found = match ids[n] {
                    0 => "0, a dropped mid-side node".to_string(),
                    absent => format!("{absent}"),
                };
                ReadError::at(file, line, key, found, "a node of the node list")
            })?;
        }
    }
    let mut sorted = ids;
    sorted.sort_unstable();
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        let distinct = sorted.chunk_by(|a, b| a == b).count();
        let form = match distinct {
            15 => "a wedge",
            13 => "a pyramid",
            10 => "a tetrahedron",
            _ => "no known form",
        };
        let found = format!("node {} more than once ({distinct} different nodes: {form})", pair[0]);
        let expected =
            "20 different nodes (wedges, pyramids and tetrahedra are not supported in this version)";
        return Err(ReadError::at(
            file,
            table.rows[record.first].line,
            format!("element {id}"),
            found,
            expected,
        ));
    }
    Ok((id, material, nodes))
}

fn read_constraints(file: &Path, index: &NodeIndex, lists: &mut Lists) -> Result<(), ReadError> {
    let table = Table::read(file, "constraint list")?;
    lists.warnings.extend(table.warnings.iter().cloned());
    let mut given: HashMap<(u32, u8), (f64, usize)> = HashMap::with_capacity(table.rows.len());
    for row in &table.rows {
        // DLIST adds the imaginary part.
        if !(2..=4).contains(&row.width()) {
            let found = row.width().to_string();
            return Err(ReadError::at(
                file,
                row.line,
                "columns of a constraint",
                found,
                "3 (node dir value) or 2 (node dir)",
            ));
        }
        let id = table.whole(row, 0, "constrained node")?;
        let node = *index.get(&id).ok_or_else(|| {
            ReadError::at(file, row.line, "constrained node", id.to_string(), "a node of the node list")
        })?;
        let directions = directions(&table, row)?;
        let value = if row.width() > 2 { table.real(row, 2, "prescribed value")? } else { 0.0 };
        if row.width() > 3 && table.real(row, 3, "imaginary part")? != 0.0 {
            let found = table.field(row, 3);
            return Err(ReadError::at(file, row.line, "imaginary part", found, "0"));
        }
        for &direction in directions {
            match given.insert((node, direction), (value, row.line)) {
                None => lists.constraints.push(Constraint { node, direction, value }),
                Some((first, _)) if first == value => {}
                Some((first, line)) => {
                    let key = format!("constraint of node {id} in {}", ["x", "y", "z"][direction as usize]);
                    let found = format!("{value} after {first} on line {line}");
                    return Err(ReadError::at(file, row.line, key, found, "one value"));
                }
            }
        }
    }
    Ok(())
}

fn directions(table: &Table, row: &Row) -> Result<&'static [u8], ReadError> {
    let text = table.field(row, 1);
    match text.to_ascii_uppercase().as_str() {
        "UX" => return Ok(&[0]),
        "UY" => return Ok(&[1]),
        "UZ" => return Ok(&[2]),
        "ALL" => return Ok(&[0, 1, 2]),
        _ => {}
    }
    match number::whole(text) {
        Some(1) => Ok(&[0]),
        Some(2) => Ok(&[1]),
        Some(3) => Ok(&[2]),
        _ => {
            let found = format!("\"{text}\"");
            Err(ReadError::at(&table.file, row.line, "direction", found, "1, 2, 3, UX, UY, UZ or ALL"))
        }
    }
}

/// Leaves out nodes that belong to no element, with their constraints: they have no stiffness, and meshing
/// often leaves some behind.
fn drop_unused_nodes(file: &Path, lists: &mut Lists) {
    let mesh = &mut lists.mesh;
    let mut used = vec![false; mesh.node_count()];
    for node in mesh.connectivity.nodes() {
        used[*node as usize] = true;
    }
    let unused: Vec<u32> =
        used.iter().zip(&mesh.node_ids).filter(|(used, _)| !**used).map(|(_, id)| *id).collect();
    if unused.is_empty() {
        return;
    }
    let mut next = 0;
    let renumbered: Vec<u32> = used
        .iter()
        .map(|used| {
            next += u32::from(*used);
            next.wrapping_sub(1)
        })
        .collect();
    let mut keep = used.iter();
    mesh.node_ids.retain(|_| keep.next().copied().unwrap_or(false));
    let mut keep = used.iter();
    mesh.coordinates.retain(|_| keep.next().copied().unwrap_or(false));
    for node in mesh.connectivity.nodes_mut() {
        *node = renumbered[*node as usize];
    }
    lists.constraints.retain(|c| used[c.node as usize]);
    for constraint in &mut lists.constraints {
        constraint.node = renumbered[constraint.node as usize];
    }
    let shown = unused.iter().take(5).map(u32::to_string).collect::<Vec<_>>().join(", ");
    let sentence = match unused.len() {
        1 => format!("node {shown} belongs to no element and is left out"),
        count if count <= 5 => format!("{count} nodes belong to no element and are left out: {shown}"),
        count => format!("{count} nodes belong to no element and are left out: {shown}, …"),
    };
    lists.warnings.push(format!("{}: {sentence}", file.display()));
}

#[cfg(test)]
#[path = "ansys_lists_tests.rs"]
mod tests;
