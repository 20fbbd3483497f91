//! Writer of Abaqus and CalculiX input files (`.inp`).
//!
//! Types: C3D20R, C3D15, C3D10, C3D8, C3D6, C3D5, C3D4; 13-node pyramids are C3D20R with repeated nodes.
//! CalculiX reads 20 columns of a number only.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use trackbed_fem::ElementKind;

use crate::read::MeshFile;
use crate::read::abaqus_faces::face_number;
use crate::read::foreign_elements::foreign;

use super::atomic;
use super::error::WriteError;
use super::mesh_file::plain_names;

const NAME: usize = 80;
const ROW: usize = 16;

pub(super) fn write_inp(path: &Path, file: &MeshFile) -> Result<Vec<String>, WriteError> {
    let mut lost = Vec::new();
    let pyramids = file.mesh.connectivity.kinds().iter().filter(|k| **k == ElementKind::Pyramid13).count();
    if pyramids > 0 {
        lost.push(format!("{pyramids} pyramids of 13 nodes are C3D20R with repeated nodes in the file"));
    }
    let text = text(file, &mut lost).map_err(|e| WriteError::format(path, e))?;
    atomic::write(path, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(path)))?;
    Ok(lost)
}

fn real(value: f64) -> String {
    let plain = format!("{value:?}");
    if !plain.contains('e') {
        return plain;
    }
    let long = format!("{value}");
    // Truncation to 20 columns would cut an exponent, but only digits of a decimal.
    if value.abs() < 1.0 && plain.len() > 20 { long } else { plain }
}

fn text(file: &MeshFile, lost: &mut Vec<String>) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let mut out = String::from("*HEADING\nmesh in SI units\n*NODE\n");
    for (id, x) in mesh.node_ids.iter().zip(&mesh.coordinates) {
        let [x, y, z] = x.map(real);
        writeln!(out, "{id}, {x}, {y}, {z}")?;
    }
    // Consecutive elements of one type share a keyword, to keep the order.
    let elements: Vec<usize> = (0..mesh.element_count()).collect();
    let name = |e: usize| foreign(mesh.connectivity.kind(e)).abaqus.0;
    for block in elements.chunk_by(|a, b| name(*a) == name(*b)) {
        writeln!(out, "*ELEMENT, TYPE={}", name(block[0]))?;
        for &e in block {
            let kind = mesh.connectivity.kind(e);
            let ids: Vec<u32> = mesh.connectivity[e].iter().map(|n| mesh.node_ids[*n as usize]).collect();
            let ids = foreign(kind).abaqus.1.write(kind, &ids);
            let fields: Vec<String> = [mesh.element_ids[e]].iter().chain(&ids).map(u32::to_string).collect();
            let rows: Vec<String> = fields.chunks(ROW).map(|row| row.join(", ")).collect();
            writeln!(out, "{}", rows.join(",\n"))?;
        }
    }
    let sections: BTreeSet<String> = mesh.materials.iter().map(|m| format!("MATERIAL_{m}")).collect();
    let sections: Vec<String> = sections.into_iter().collect();
    let node_sets = plain_names(&file.node_sets, &[], NAME, lost);
    // A face set has the name of its node set.
    let of_nodes: BTreeMap<&String, String> =
        file.node_sets.keys().zip(node_sets.iter().map(|(name, _)| name.clone())).collect();
    for (what, sets, ids) in [
        ("*NSET, NSET", node_sets, &mesh.node_ids),
        ("*ELSET, ELSET", plain_names(&file.element_sets, &sections, NAME, lost), &mesh.element_ids),
    ] {
        for (name, members) in sets {
            writeln!(out, "{what}={name}")?;
            numbers(&mut out, members.iter().map(|m| ids[*m as usize]))?;
        }
    }
    let own = plain_names(&file.face_sets, &[], NAME, &mut Vec::new());
    for (set, (own, faces)) in file.face_sets.keys().zip(own) {
        let name = of_nodes.get(set).unwrap_or(&own);
        writeln!(out, "*SURFACE, TYPE=ELEMENT, NAME={name}")?;
        for [element, side] in faces {
            let face = mesh.face(*element as usize, *side as usize);
            let number = face_number(
                mesh.connectivity.kind(*element as usize),
                &mesh.connectivity[*element as usize],
                face.corners(),
            );
            writeln!(out, "{}, S{number}", mesh.element_ids[*element as usize])?;
        }
    }
    let used: BTreeSet<u32> = mesh.materials.iter().chain(file.materials.keys()).copied().collect();
    let mut members: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (material, id) in mesh.materials.iter().zip(&mesh.element_ids) {
        members.entry(*material).or_default().push(*id);
    }
    for number in &used {
        writeln!(out, "*MATERIAL, NAME=MATERIAL_{number}")?;
        if let Some(m) = file.materials.get(number) {
            writeln!(out, "*ELASTIC\n{}, {}", real(m.young), real(m.poisson))?;
            if let Some(density) = m.density {
                writeln!(out, "*DENSITY\n{}", real(density))?;
            }
        }
    }
    for (number, ids) in &members {
        writeln!(out, "*ELSET, ELSET=MATERIAL_{number}")?;
        numbers(&mut out, ids.iter().copied())?;
        writeln!(out, "*SOLID SECTION, ELSET=MATERIAL_{number}, MATERIAL=MATERIAL_{number}")?;
    }
    if !file.constraints.is_empty() {
        writeln!(out, "*BOUNDARY")?;
        for c in &file.constraints {
            let (id, direction) = (mesh.node_ids[c.node as usize], c.direction + 1);
            writeln!(out, "{id}, {direction}, {direction}, {}", real(c.value))?;
        }
    }
    Ok(out)
}

fn numbers(out: &mut String, ids: impl Iterator<Item = u32>) -> std::fmt::Result {
    let all: Vec<String> = ids.map(|id| id.to_string()).collect();
    all.chunks(ROW).try_for_each(|row| writeln!(out, "{}", row.join(", ")))
}
