//! Face sets (*SURFACE) and face labels S1 to S6 of Abaqus.
//!
//! Source: Abaqus Analysis User's Guide, "Three-dimensional solid element library", element faces.

use std::collections::HashSet;

use trackbed_fem::ElementKind;
use trackbed_fem::element::NaturalShape;

use super::abaqus_lines::Block;
use super::degenerate::to_brick;
use super::error::ReadError;
use super::faces::key;
use super::foreign_elements::{Layout, foreign};
use super::mesh_file::Builder;

const BRICK: &[&[usize]] =
    &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]];
const WEDGE: &[&[usize]] = &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
const PYRAMID: &[&[usize]] = &[&[0, 1, 2, 3], &[0, 4, 1], &[1, 4, 2], &[2, 4, 3], &[3, 4, 0]];
const TETRAHEDRON: &[&[usize]] = &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]];

/// Corner nodes of faces S1, S2, ….
fn faces(kind: ElementKind, nodes: &[u32], folded: bool) -> Vec<Vec<u32>> {
    let nodes = &nodes[..kind.corner_count()];
    let (of_kind, corners) = match kind.shape() {
        _ if folded || foreign(kind).abaqus.1 == Layout::Brick => (BRICK, to_brick(kind.linear(), nodes)),
        NaturalShape::Hexahedron => (BRICK, nodes.to_vec()),
        NaturalShape::Wedge => (WEDGE, nodes.to_vec()),
        NaturalShape::Pyramid => (PYRAMID, nodes.to_vec()),
        NaturalShape::Tetrahedron => (TETRAHEDRON, nodes.to_vec()),
    };
    let distinct = |local: &&[usize]| {
        let mut face: Vec<u32> = local.iter().map(|l| corners[*l]).collect();
        face.sort_unstable();
        face.dedup();
        face
    };
    of_kind.iter().map(distinct).collect()
}

pub(crate) fn face_number(kind: ElementKind, nodes: &[u32], corners: &[u32]) -> usize {
    let wanted = key(corners);
    let all = faces(kind, nodes, false);
    1 + all.iter().position(|face| key(face) == wanted).expect("every face of a kind has a number")
}

/// Row of *SURFACE: elements and face label; no label selects free faces.
pub(super) struct Row {
    pub line: usize,
    /// Element id or set name.
    pub target: String,
    face: Option<usize>,
}

pub(super) fn rows(builder: &Builder, block: &Block) -> Result<Vec<Row>, ReadError> {
    let mut rows = Vec::new();
    for (line, row) in block.rows() {
        let label = row.get(1).copied().unwrap_or_default().to_uppercase();
        let number = label.strip_prefix('S').and_then(|digits| digits.parse::<usize>().ok());
        let face = match number {
            Some(number @ 1..=6) => Some(number),
            _ if label.is_empty() => None,
            _ => {
                let expected = "S1 to S6 of solid elements, or nothing for free faces";
                return Err(builder.fault(line, "face of *SURFACE", format!("\"{label}\""), expected));
            }
        };
        rows.push(Row { line, target: row[0].to_string(), face });
    }
    Ok(rows)
}

pub(super) fn faces_of(
    builder: &Builder,
    row: &Row,
    elements: &[u32],
    folded: &HashSet<u32>,
) -> Result<Vec<[u32; 2]>, ReadError> {
    let mut found = Vec::new();
    match row.face {
        Some(number) => numbered(builder, folded, row.line, elements, number, &mut found)?,
        None => free(builder, elements, &mut found),
    }
    Ok(found)
}

fn numbered(
    builder: &Builder,
    folded: &HashSet<u32>,
    line: usize,
    elements: &[u32],
    number: usize,
    found: &mut Vec<[u32; 2]>,
) -> Result<(), ReadError> {
    let mesh = &builder.made.mesh;
    for &element in elements {
        let e = element as usize;
        let (kind, id) = (mesh.connectivity.kind(e), mesh.element_ids[e]);
        let of_element = faces(kind, &mesh.connectivity[e], folded.contains(&id));
        let corners = of_element.get(number - 1).filter(|corners| corners.len() > 2);
        let side = corners.and_then(|corners| {
            let wanted = key(corners);
            (0..kind.faces().len()).find(|side| key(mesh.face(e, *side).corners()) == wanted)
        });
        let Some(side) = side else {
            let found = format!("S{number} of element {id}, a {}", kind.name());
            return Err(builder.fault(line, "*SURFACE", found, "a face that the element has"));
        };
        found.push([element, side as u32]);
    }
    Ok(())
}

/// Collects faces of single elements.
fn free(builder: &Builder, elements: &[u32], found: &mut Vec<[u32; 2]>) {
    let members: HashSet<u32> = elements.iter().copied().collect();
    let all = builder.made.mesh.boundary_faces().into_iter().filter(|face| members.contains(&face.element));
    found.extend(all.map(|face| [face.element, u32::from(face.side)]));
}
