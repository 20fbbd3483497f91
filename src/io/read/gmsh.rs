//! Reader of Gmsh meshes (`.msh`), formats 2.2 and 4.1, text and binary.
//!
//! | Gmsh | mesh |
//! |---|---|
//! | physical volume | material id; element set if named |
//! | physical surface | face and node set, by name or `physical_surface_7` |
//! | physical curve, point | node set, likewise |
//! | no physical volume | geometric volume id is the material id |
//!
//! A volume in several groups takes the material of the first and joins all sets.
//!
//! Source: Gmsh Reference Manual, "MSH file format".
//!
//! Not supported: nodes inside faces or volumes (hex27).

use std::collections::BTreeMap;
use std::path::Path;

use trackbed_fem::{ElementKind, Mesh};

use super::error::ReadError;
use super::faces::{self, Faces};
use super::foreign_elements::{FOREIGN, foreign};
use super::gmsh4;
use super::mesh_file::{Builder, MeshFile, read_bytes};
use super::tokens::{Encoding, Tokens};
use super::unit;

const LOWER: [(i32, usize, usize); 14] = [
    (15, 0, 1),
    (1, 1, 2),
    (8, 1, 3),
    (26, 1, 4),
    (27, 1, 5),
    (2, 2, 3),
    (3, 2, 4),
    (9, 2, 6),
    (10, 2, 9),
    (16, 2, 8),
    (20, 2, 9),
    (21, 2, 10),
    (22, 2, 12),
    (23, 2, 15),
];

const QUADRANGLES: [i32; 3] = [3, 10, 16];

pub(super) enum Shape {
    Volume(ElementKind),
    Lower { dimension: usize, nodes: usize, corners: usize },
}

pub(super) fn shape(tokens: &mut Tokens, kind: i32) -> Result<Shape, ReadError> {
    if let Some(row) = FOREIGN.iter().find(|row| row.gmsh.0 == kind) {
        return Ok(Shape::Volume(row.kind));
    }
    if let Some(&(_, dimension, nodes)) = LOWER.iter().find(|(number, ..)| *number == kind) {
        let corners = if QUADRANGLES.contains(&kind) { 4 } else { 3.min(nodes) };
        return Ok(Shape::Lower { dimension, nodes, corners });
    }
    let name = match kind {
        12 => "27-node hexahedra (type 12)".to_string(),
        13 => "18-node prisms (type 13)".to_string(),
        14 => "14-node pyramids (type 14)".to_string(),
        _ => format!("elements of type {kind}"),
    };
    let expected = "first-order elements, or second-order ones with nodes on edges only (Mesh.ElementOrder = 2, \
                    Mesh.SecondOrderIncomplete = 1)";
    Err(tokens.fault("element type", name, expected))
}

pub(super) struct RawElement {
    pub line: usize,
    pub id: u32,
    pub kind: ElementKind,
    /// Physical volumes, then the geometric volume.
    pub groups: Vec<u32>,
    pub entity: u32,
    pub nodes: Vec<u32>,
}

/// Physical volume of material 0: Gmsh numbers groups from 1.
pub(crate) const MATERIAL_0: &str = "material_0";

#[derive(Default)]
pub(super) struct Sections {
    pub names: BTreeMap<(usize, u32), String>,
    pub elements: Vec<RawElement>,
    pub node_groups: BTreeMap<(usize, u32), Vec<u32>>,
    pub face_groups: BTreeMap<u32, Vec<[u32; 4]>>,
    /// Physical groups by dimension and entity (4.1).
    pub entities: BTreeMap<(usize, i32), Vec<u32>>,
}

/// Sections encoded as `$MeshFormat` states.
const SECTIONS: [&str; 4] = ["$PhysicalNames", "$Entities", "$Nodes", "$Elements"];

/// Reads a Gmsh mesh.
///
/// # Errors
/// Versions other than 2.2 and 4.1, damaged sections, element types with inner nodes, duplicate ids, unknown
/// nodes.
pub fn read_gmsh(file: &Path) -> Result<MeshFile, ReadError> {
    let bytes = read_bytes(file, "Gmsh mesh")?;
    let mut builder = Builder::new(file);
    let mut sections = Sections::default();
    let mut tokens = Tokens::new(file, &bytes);
    let mut version = None;
    let mut encoding = Encoding::Text;
    while let Some(name) = tokens.next_line() {
        if !name.starts_with('$') {
            let shown: String = name.chars().take(40).collect();
            return Err(tokens.fault("section", format!("\"{shown}\""), "a section such as $Nodes"));
        }
        if name == "$MeshFormat" {
            let (stated, how) = mesh_format(&mut tokens)?;
            (version, encoding) = (Some(stated), how);
        }
        let old = match (version, name) {
            (_, "$MeshFormat") => true,
            (Some(old), _) => old,
            (None, name) if SECTIONS.contains(&name) => {
                return Err(tokens.fault("section", name, "$MeshFormat first"));
            }
            // Comments and foreign sections are allowed.
            (None, _) => true,
        };
        tokens.encoding = encoding;
        match name {
            "$MeshFormat" => {}
            "$PhysicalNames" => physical_names(&mut tokens, &mut sections)?,
            "$Entities" => gmsh4::entities(&mut tokens, &mut sections)?,
            "$Nodes" if old => nodes2(&mut tokens, &mut builder)?,
            "$Nodes" => gmsh4::nodes(&mut tokens, &mut builder)?,
            "$Elements" if old => elements2(&mut tokens, &mut sections)?,
            "$Elements" => gmsh4::elements(&mut tokens, &mut sections)?,
            "$PartitionedEntities" => {
                let expected = "a mesh in one part (Mesh.PartitionSplitMeshFiles)";
                return Err(tokens.fault("section", name, expected));
            }
            _ => {}
        }
        tokens.encoding = Encoding::Text;
        let end = name.replacen('$', "$End", 1);
        let known = name == "$MeshFormat" || SECTIONS.contains(&name);
        loop {
            match tokens.next_line() {
                Some(line) if line == end => break,
                Some(line) if known => {
                    let shown: String = line.chars().take(40).collect();
                    return Err(tokens.fault(name, format!("\"{shown}\""), end));
                }
                Some(line) if name == "$Comments" && builder.made.unit.is_none() => {
                    let number = tokens.line().saturating_sub(1);
                    builder.made.unit = unit::refusal(file, number, line).map(Box::new);
                }
                Some(_) => {}
                None => return Err(tokens.fault(name, "the end of the file", end)),
            }
        }
    }
    if version.is_none() {
        return Err(tokens.fault("Gmsh mesh", "no section", "$MeshFormat"));
    }
    put_together(builder, sections)
}

fn mesh_format(tokens: &mut Tokens) -> Result<(bool, Encoding), ReadError> {
    let version = tokens.word("version")?;
    let old = match version {
        "2" | "2.0" | "2.1" | "2.2" => true,
        "4.1" => false,
        _ => {
            let shown: String = version.chars().take(40).collect();
            return Err(tokens.fault("version of the Gmsh format", shown, "2.2 or 4.1"));
        }
    };
    let (binary, size) = (tokens.int("file type")?, tokens.int("size of a number")?);
    if size != 8 {
        return Err(tokens.fault("size of a number", size.to_string(), "8"));
    }
    if binary == 0 {
        return Ok((old, Encoding::Text));
    }
    tokens.rest_of_line();
    match tokens.take(4, "byte order")? {
        [1, 0, 0, 0] => Ok((old, Encoding::LittleEndian)),
        [0, 0, 0, 1] => Ok((old, Encoding::BigEndian)),
        other => {
            let found = format!("{other:?}");
            Err(tokens.fault("byte order", found, "the number 1"))
        }
    }
}

fn physical_names(tokens: &mut Tokens, sections: &mut Sections) -> Result<(), ReadError> {
    tokens.encoding = Encoding::Text;
    let count = tokens.count("number of physical names")?;
    for _ in 0..count {
        let dimension = tokens.count("dimension of a physical name")?;
        let number = tokens.id("number of a physical name")?;
        let rest = tokens.rest_of_line().unwrap_or_default();
        let name = rest.strip_prefix('"').and_then(|r| r.strip_suffix('"'));
        let Some(name) = name.filter(|_| dimension <= 3) else {
            let found = format!("{dimension} {number} {rest}");
            return Err(tokens.fault("physical name", found, "dimension, number and a name in quotes"));
        };
        sections.names.insert((dimension, number), name.to_string());
    }
    Ok(())
}

fn nodes2(tokens: &mut Tokens, builder: &mut Builder) -> Result<(), ReadError> {
    let encoding = std::mem::replace(&mut tokens.encoding, Encoding::Text);
    let count = tokens.count("number of nodes")?;
    skip_line_end(tokens, encoding);
    for _ in 0..count {
        let line = tokens.line();
        let id = tokens.int_id("node number")?;
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = tokens.real("coordinate of a node")?;
        }
        builder.node(line, id, point)?;
    }
    Ok(())
}

/// Binary files of 2.2 have text counts; numbers begin after the line end.
fn skip_line_end(tokens: &mut Tokens, encoding: Encoding) {
    if encoding != Encoding::Text {
        tokens.rest_of_line();
        tokens.encoding = encoding;
    }
}

fn elements2(tokens: &mut Tokens, sections: &mut Sections) -> Result<(), ReadError> {
    let encoding = std::mem::replace(&mut tokens.encoding, Encoding::Text);
    let count = tokens.count("number of elements")?;
    skip_line_end(tokens, encoding);
    let mut read = 0;
    while read < count {
        let (kind, in_block, tag_count, id_first) = if encoding == Encoding::Text {
            let id = tokens.int_id("element number")?;
            (tokens.int("element type")?, 1, tokens.int_count("number of tags")?, Some(id))
        } else {
            let kind = tokens.int("element type")?;
            (kind, tokens.int_count("number of elements")?, tokens.int_count("number of tags")?, None)
        };
        let shape = shape(tokens, kind)?;
        for _ in 0..in_block {
            let line = tokens.line();
            let id = match id_first {
                Some(id) => id,
                None => tokens.int_id("element number")?,
            };
            let tags: Vec<i32> = (0..tag_count).map(|_| tokens.int("tag")).collect::<Result<_, _>>()?;
            // Group ids are negative for reversed elements.
            let physical = tags.first().map_or(0, |t| t.unsigned_abs());
            let entity = tags.get(1).map_or(0, |t| t.unsigned_abs());
            let groups: Vec<u32> = if physical == 0 { vec![] } else { vec![physical] };
            one_element(tokens, sections, (line, id, entity), &shape, groups, Tokens::int_id)?;
        }
        read += in_block.max(1);
    }
    Ok(())
}

pub(super) fn one_element<'a>(
    tokens: &mut Tokens<'a>,
    sections: &mut Sections,
    (line, id, entity): (usize, u32, u32),
    shape: &Shape,
    groups: Vec<u32>,
    node: fn(&mut Tokens<'a>, &str) -> Result<u32, ReadError>,
) -> Result<(), ReadError> {
    let count = match shape {
        Shape::Volume(kind) => kind.node_count(),
        Shape::Lower { nodes, .. } => *nodes,
    };
    let nodes: Vec<u32> = (0..count).map(|_| node(tokens, "node of an element")).collect::<Result<_, _>>()?;
    match shape {
        Shape::Volume(kind) => {
            sections.elements.push(RawElement { line, id, kind: *kind, groups, entity, nodes });
        }
        Shape::Lower { dimension, corners, .. } => {
            for group in groups {
                if *dimension == 2 {
                    sections.face_groups.entry(group).or_default().push(faces::key(&nodes[..*corners]));
                }
                sections.node_groups.entry((*dimension, group)).or_default().extend(&nodes);
            }
        }
    }
    Ok(())
}

fn put_together(mut builder: Builder, mut sections: Sections) -> Result<MeshFile, ReadError> {
    builder.made.no_constraints = true;
    merge_repeated(&mut sections.elements);
    let none = Mesh::default();
    let grouped = sections.elements.iter().filter(|e| !e.groups.is_empty()).count();
    let total = sections.elements.len();
    if grouped == 0 && total > 0 {
        builder.warn("no physical volumes: geometric volumes give the material numbers");
    } else if grouped < total {
        builder.warn(format!(
            "{} elements are in no physical volume and get material number 0",
            total - grouped
        ));
    }
    for raw in &sections.elements {
        let own = if grouped == 0 { raw.entity } else { 0 };
        let is_zero = |group: &u32| sections.names.get(&(3, *group)).is_some_and(|name| name == MATERIAL_0);
        let material = raw.groups.first().filter(|group| !is_zero(group)).copied();
        let material = material.unwrap_or(if raw.groups.is_empty() { own } else { 0 });
        let (number, layout) = foreign(raw.kind).gmsh;
        let nodes = layout.read(&raw.nodes);
        let name = format!("type {number} {}", raw.kind.name());
        builder.element(raw.line, raw.id, material, (raw.kind, &name), &nodes)?;
        let index = builder.made.mesh.element_count() as u32 - 1;
        for group in raw.groups.iter().filter(|group| !is_zero(group)) {
            if let Some(name) = sections.names.get(&(3, *group)) {
                builder.element_set(name, [index]);
            }
        }
    }
    let all_faces = Faces::of(if sections.face_groups.is_empty() { &none } else { &builder.made.mesh });
    for ((dimension, number), ids) in &sections.node_groups {
        let what = ["point", "curve", "surface"][*dimension];
        let name = sections.names.get(&(*dimension, *number)).cloned();
        let name = name.unwrap_or_else(|| format!("physical_{what}_{number}"));
        let mut nodes = Vec::with_capacity(ids.len());
        for id in ids {
            let Some(index) = builder.node_index(*id) else {
                return Err(builder.fault(0, name, format!("node {id}"), "a node of the file"));
            };
            nodes.push(index);
        }
        builder.node_set(&name, nodes);
        if *dimension == 2 {
            let faces = sections.face_groups.get(number).map(Vec::as_slice).unwrap_or_default();
            face_set(&mut builder, &all_faces, &name, faces);
        }
    }
    builder.finish()
}

fn face_set(builder: &mut Builder, all: &Faces, name: &str, faces: &[[u32; 4]]) {
    let (mut found, mut absent) = (Vec::new(), 0);
    for ids in faces {
        let corners = ids.map(|id| if id == u32::MAX { Some(id) } else { builder.node_index(id) });
        let key = corners.map(|corner| corner.unwrap_or(u32::MAX));
        let before = found.len();
        found.extend(all.find(faces::key(&key)));
        absent += usize::from(found.len() == before);
    }
    builder.face_set(name, found);
    if absent > 0 {
        builder.warn(format!("{absent} faces of the set {name} are no faces of volumes and are left out"));
    }
}

/// Format 2.2 repeats an element for each of its physical groups.
fn merge_repeated(elements: &mut Vec<RawElement>) {
    let mut first: std::collections::HashMap<Vec<u32>, usize> = std::collections::HashMap::new();
    let mut kept: Vec<RawElement> = Vec::with_capacity(elements.len());
    for element in elements.drain(..) {
        match first.get(&element.nodes) {
            Some(&at) if kept[at].kind == element.kind && kept[at].groups != element.groups => {
                for group in element.groups {
                    if !kept[at].groups.contains(&group) {
                        kept[at].groups.push(group);
                    }
                }
            }
            _ => {
                first.insert(element.nodes.clone(), kept.len());
                kept.push(element);
            }
        }
    }
    *elements = kept;
}
