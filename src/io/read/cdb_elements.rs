//! Element types of ANSYS archives.

use std::collections::BTreeMap;

use trackbed_fem::ElementKind;

use super::cdb::Archive;
use super::degenerate::from_brick;
use super::error::ReadError;
use super::mesh_file::Builder;

pub(super) struct RawElement {
    pub line: usize,
    pub material: u32,
    pub kind: u32,
    pub id: u32,
    pub nodes: Vec<u32>,
}

const BRICKS8: [u32; 5] = [45, 65, 73, 185, 190];
const BRICKS20: [u32; 2] = [95, 186];
const TETRAHEDRA10: [u32; 2] = [92, 187];
const TETRAHEDRON4: u32 = 285;

/// Name of a type without volume, and whether skipping it loses force.
fn without_volume(kind: u32) -> Option<(&'static str, bool)> {
    Some(match kind {
        200 => ("MESH200", false),
        151..=154 | 156 => ("SURF", false),
        169 | 170 => ("TARGE", false),
        171..=178 => ("CONTA", true),
        201 => ("FOLLW201", false),
        14 | 37 | 39 | 40 | 250 => ("COMBIN", true),
        21 => ("MASS21", true),
        8 | 10 | 11 | 180 => ("LINK", true),
        3 | 4 | 23 | 24 | 44 | 54 | 188 | 189 => ("BEAM", true),
        16 | 20 | 59 | 288 | 289 | 290 => ("PIPE", true),
        41 | 43 | 57 | 63 | 91 | 93 | 99 | 131 | 132 | 157 | 181 | 208 | 209 | 281 => ("SHELL", true),
        184 => ("MPC184", true),
        179 => ("PRETS179", true),
        263..=265 => ("REINF", true),
        _ => return None,
    })
}

/// Node count of a type; 10 if irrelevant.
pub(super) fn node_count(kind: u32) -> usize {
    match kind {
        _ if BRICKS20.contains(&kind) => 20,
        _ if BRICKS8.contains(&kind) => 8,
        _ => 10,
    }
}

pub(super) fn add(builder: &mut Builder, archive: &Archive) -> Result<(), ReadError> {
    let mut missed: BTreeMap<String, usize> = BTreeMap::new();
    for raw in &archive.elements {
        let key = || format!("element {}", raw.id);
        let Some(&kind) = archive.types.get(&raw.kind) else {
            let found = format!("type number {}", raw.kind);
            return Err(builder.fault(raw.line, key(), found, "a type that an ET command defines"));
        };
        if let Some((family, carries)) = without_volume(kind) {
            let digits = family.ends_with(|c: char| c.is_ascii_digit());
            let name = if digits { family.to_string() } else { format!("{family}{kind}") };
            builder.leave_out(&name);
            if carries {
                *missed.entry(name).or_insert(0) += 1;
            }
            continue;
        }
        let (element, nodes) = shape(builder, raw, kind)?;
        let name = format!("SOLID{kind} {}", element.name());
        builder.element(raw.line, raw.id, raw.material, (element, &name), &nodes)?;
    }
    for (name, count) in missed {
        builder.warn(format!("what the {count} elements of type {name} carry is missing"));
    }
    Ok(())
}

fn shape(builder: &Builder, raw: &RawElement, kind: u32) -> Result<(ElementKind, Vec<u32>), ReadError> {
    let key = || format!("element {}", raw.id);
    let mut nodes = raw.nodes.clone();
    let zeros_after = |nodes: &[u32], n: usize| nodes.iter().skip(n).all(|id| *id == 0);
    let wrong = |expected: String| {
        let count = raw.nodes.iter().filter(|n| **n != 0).count();
        builder.fault(raw.line, key(), format!("{count} nodes in a SOLID{kind}"), expected)
    };
    if BRICKS8.contains(&kind) || BRICKS20.contains(&kind) {
        let full = if BRICKS8.contains(&kind) { 8 } else { 20 };
        if !zeros_after(&nodes, full) || nodes.len() < 8 {
            return Err(wrong(format!("{full} nodes")));
        }
        nodes.resize(full, 0);
        return from_brick(&nodes)
            .map_err(|fault| builder.fault(raw.line, key(), fault.found, fault.expected));
    }
    if TETRAHEDRA10.contains(&kind) || kind == TETRAHEDRON4 {
        let full = if kind == TETRAHEDRON4 { 4 } else { 10 };
        if !zeros_after(&nodes, full) || nodes.len() < 4 {
            return Err(wrong(format!("{full} nodes")));
        }
        nodes.resize(full, 0);
        if zeros_after(&nodes, 4) {
            nodes.truncate(4);
            return Ok((ElementKind::Tet4, nodes));
        }
        if nodes.contains(&0) {
            return Err(wrong("all 6 mid-side nodes, or none".into()));
        }
        return Ok((ElementKind::Tet10, nodes));
    }
    let expected = "SOLID185, SOLID186, SOLID187, SOLID285, or one of their elders 45, 65, 73, 92, 95, 190";
    Err(builder.fault(raw.line, key(), format!("type {kind}"), expected))
}
