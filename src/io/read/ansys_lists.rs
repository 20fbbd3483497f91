//! Reader of the ANSYS lists `NODECOORD.DAT`, `ELEMENTNUM.DAT` and `DOF.DAT`.
//!
//! Layout of the macros in `inputs/ansys`, one row per item:
//!
//! | list | columns |
//! |---|---|
//! | nodes | `id x y z` [m] |
//! | elements | `id mat n1 … n20`, SOLID186 order I…P, Q…T, U…X, Y…B |
//! | constraints | `node dir value`: dir 1, 2, 3, UX, UY, UZ or ALL; value [m], default 0 |
//!
//! Also read: elements without id or material, over several lines, or of 8 nodes; listings of NLIST, ELIST
//! and DLIST; NWRITE columns. Rotated nodal coordinate systems are rejected.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::{Constraint, Mesh};

use super::degenerate;
use super::element_list::{self, Columns, Record};
use super::error::ReadError;
use super::header::Content;
use super::mesh_file::{FARTHEST, FARTHEST_EXPECTED, MeshFile, check_faces, drop_unused_nodes};
use super::number;
use super::nwrite;
use super::table::{self, Row, Table};

/// What the columns of the element list are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ElementColumns {
    /// By count (of 21, material first if values repeat).
    #[default]
    Auto,
    /// `id material n1 … n20`.
    IdMaterialNodes,
    /// `id n1 … n20`.
    IdNodes,
    /// `material n1 … n20`.
    MaterialNodes,
    /// `n1 … n20`.
    Nodes,
}

/// Keys of a scene for the lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ListLayout {
    /// Columns of the element list; default `"auto"`.
    pub columns: ElementColumns,
    /// Material number without such a column; default 1.
    pub material: u32,
}

impl Default for ListLayout {
    fn default() -> Self {
        ListLayout { columns: ElementColumns::Auto, material: 1 }
    }
}

/// Contents of the lists.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// Mesh in file order, without unused nodes.
    pub mesh: Mesh,
    /// Constraints in file order, one per node and direction.
    pub constraints: Vec<Constraint>,
    /// Guesses and likely mistakes, one sentence each.
    pub warnings: Vec<String>,
    /// As of [`MeshFile`].
    pub unit: Option<Box<ReadError>>,
}

/// Reads the lists; `constraints` is optional.
///
/// # Errors
/// Missing files, wrong columns, unreadable numbers, duplicate or unknown ids, conflicting constraints.
pub fn read_lists(
    nodes: &Path,
    elements: &Path,
    constraints: Option<&Path>,
    layout: &ListLayout,
) -> Result<Lists, ReadError> {
    let mut lists = Lists::default();
    let index = read_nodes(nodes, &mut lists)?;
    read_elements(elements, layout, &index, &mut lists)?;
    check_faces(elements, &lists.mesh)?;
    if let Some(file) = constraints {
        read_constraints(file, &index, &mut lists)?;
    }
    let Lists { mesh, constraints, warnings, .. } = &mut lists;
    drop_unused_nodes(nodes, mesh, constraints, &mut BTreeMap::new(), warnings);
    Ok(lists)
}

impl From<Lists> for MeshFile {
    fn from(lists: Lists) -> MeshFile {
        let Lists { mesh, constraints, warnings, unit } = lists;
        let mut element_types: Vec<(String, usize)> = Vec::new();
        for kind in mesh.connectivity.kinds() {
            let (family, nodes) = if kind.has_mid_sides() { (186, 20) } else { (185, 8) };
            let name = format!("SOLID{family} form of {nodes} nodes {}", kind.name());
            match element_types.iter_mut().find(|(n, _)| *n == name) {
                Some((_, count)) => *count += 1,
                None => element_types.push((name, 1)),
            }
        }
        MeshFile { mesh, constraints, element_types, warnings, unit, ..MeshFile::default() }
    }
}

type NodeIndex = HashMap<u32, u32>;

const VALUES: [&str; 6] =
    ["coordinate x", "coordinate y", "coordinate z", "nodal rotation", "nodal rotation", "nodal rotation"];

fn read_nodes(file: &Path, lists: &mut Lists) -> Result<NodeIndex, ReadError> {
    let mut table = Table::read(file, Content::Nodes)?;
    lists.unit = table.unit.take();
    if table.rows.is_empty() {
        return Err(ReadError::whole(file, "nodes", "none", "at least 4 rows of id x y z"));
    }
    let blanks = nwrite::places(&table);
    if blanks.is_some() {
        let short = table.rows.iter().filter(|row| row.width() < 4).count();
        let of = format!("{}: {short} rows", file.display());
        lists.warnings.push(format!("{of} have blank coordinates, which are 0 in the columns of NWRITE"));
    }
    let mut index = NodeIndex::with_capacity(table.rows.len());
    for (i, row) in table.rows.iter().enumerate() {
        // NLIST adds three angles of the nodal coordinate system.
        if blanks.is_none() && row.width() != 4 && row.width() != 7 {
            let found = row.width().to_string();
            return Err(ReadError::at(file, row.line, "columns of a node", found, "4 (id x y z)"));
        }
        let id = table.whole(row, 0, "node number")?;
        let mut values = [0.0; 6];
        for column in 1..row.width() {
            let place = blanks.as_ref().map_or(column - 1, |all| all[i][column - 1]);
            values[place] = table.real(row, column, VALUES[place])?;
            if place >= 3 && values[place] != 0.0 {
                let found = table.field(row, column);
                return Err(ReadError::at(file, row.line, VALUES[place], found, "0 (global directions)"));
            }
        }
        let point = [values[0], values[1], values[2]];
        if let Some(x) = point.iter().find(|x| x.abs() > FARTHEST) {
            let key = format!("coordinates of node {id}");
            return Err(ReadError::at(file, row.line, key, format!("{x:e}"), FARTHEST_EXPECTED));
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
    let table = Table::read(file, Content::Elements)?;
    if table.rows.is_empty() {
        return Err(ReadError::whole(file, "elements", "none", "at least one row of id mat n1…n20"));
    }
    let (columns, records) = element_list::split(&table, layout.columns, &mut lists.warnings)?;
    let mut lines = HashMap::with_capacity(records.len());
    for (i, record) in records.into_iter().enumerate() {
        let (id, material, kind, nodes) = read_element(&table, columns, record, i, index)?;
        let line = table.rows[record.first].line;
        if let Some(first) = lines.insert(id, line) {
            return Err(named_twice(&table, "element", id, first, line));
        }
        lists.mesh.push_element(id, material.unwrap_or(layout.material), kind, &nodes);
    }
    Ok(())
}

type Element = (u32, Option<u32>, ElementKind, Vec<u32>);

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
    let mut ids = Vec::with_capacity(columns.count);
    for (column, (line, text)) in element_list::fields(table, record).enumerate() {
        let value = |key: &str| table::whole(file, line, text, key);
        if Some(column) == columns.id {
            id = value("element number")?;
        } else if Some(column) == columns.material {
            material = Some(value(&format!("material of element {id}"))?);
        } else if let Some(n) = column.checked_sub(columns.nodes) {
            let key = format!("element {id}, node n{}", n + 1);
            let node = value(&key)?;
            // 0 marks an absent mid-side node.
            if node != 0 && !index.contains_key(&node) {
                return Err(ReadError::at(file, line, key, node.to_string(), "a node of the node list"));
            }
            ids.push(node);
        }
    }
    let (kind, nodes) = degenerate::from_brick(&ids).map_err(|fault| {
        let line = table.rows[record.first].line;
        ReadError::at(file, line, format!("element {id}"), fault.found, fault.expected)
    })?;
    // from_brick drops zeros; other ids were checked above.
    let nodes = nodes.iter().map(|node| index[node]).collect();
    Ok((id, material, kind, nodes))
}

fn read_constraints(file: &Path, index: &NodeIndex, lists: &mut Lists) -> Result<(), ReadError> {
    let table = Table::read(file, Content::Constraints)?;
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

#[cfg(test)]
#[path = "ansys_lists_tests.rs"]
mod tests;
