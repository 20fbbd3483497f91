//! Writer of blocked ANSYS archives (`.cdb`), as by CDWRITE.
//!
//! Types: 1 SOLID186 (also wedges and pyramids), 2 SOLID187 (10-node tetrahedra), 3 SOLID185 (linear kinds).
//! Coordinates have 17 digits.

use std::fmt::Write;
use std::path::Path;

use trackbed_fem::ElementKind;

use crate::read::MeshFile;
use crate::read::foreign_elements::foreign;

use super::atomic;
use super::error::WriteError;
use super::mesh_file::{fortran, no_zero, plain_names};

const NAME: usize = 32;

/// Type numbers in the file.
const TYPES: [(u32, u32); 3] = [(1, 186), (2, 187), (3, 185)];

pub(super) fn write_cdb(path: &Path, file: &MeshFile) -> Result<Vec<String>, WriteError> {
    no_zero(path, file)?;
    let mut lost = Vec::new();
    let node_sets = plain_names(&file.node_sets, &[], NAME, &mut lost);
    let element_sets = plain_names(&file.element_sets, &[], NAME, &mut lost);
    let text = text(file, &node_sets, &element_sets).map_err(|e| WriteError::format(path, e))?;
    atomic::write(path, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(path)))?;
    Ok(lost)
}

type Sets<'a> = [(String, &'a [u32])];

fn text(file: &MeshFile, node_sets: &Sets, element_sets: &Sets) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let highest = |ids: &[u32]| ids.iter().copied().max().unwrap_or(0);
    let (most_node, most_element) = (highest(&mesh.node_ids), highest(&mesh.element_ids));
    let most = [most_node, most_element, highest(&mesh.materials)].into_iter().max().unwrap_or(0);
    let w = most.to_string().len().max(8) + 1;
    let mut out = String::new();
    writeln!(out, "/COM,ANSYS archive\n/PREP7")?;
    for (number, family) in TYPES {
        if mesh.connectivity.kinds().iter().any(|kind| element_type(*kind) == number) {
            writeln!(out, "ET,{number:9},{family}")?;
        }
    }
    writeln!(out, "NBLOCK,6,SOLID,{most_node:10},{:10}\n(3i{w},6e25.16e3)", mesh.node_count())?;
    for (id, x) in mesh.node_ids.iter().zip(&mesh.coordinates) {
        let [x, y, z] = x.map(fortran);
        writeln!(out, "{id:w$}{:w$}{:w$}{x:>25}{y:>25}{z:>25}", 0, 0)?;
    }
    writeln!(out, "N,R5.3,LOC,       -1,")?;
    writeln!(out, "EBLOCK,19,SOLID,{most_element:10},{:10}\n(19i{w})", mesh.element_count())?;
    for (e, nodes) in mesh.connectivity.iter().enumerate() {
        let (kind, material) = (mesh.connectivity.kind(e), mesh.materials[e]);
        let ids: Vec<u32> = nodes.iter().map(|n| mesh.node_ids[*n as usize]).collect();
        let ids = foreign(kind).ansys.1.write(kind, &ids);
        let entries = [material, element_type(kind), 1, 1, 0, 0, 0, 0, ids.len() as u32, 0];
        for number in entries.iter().chain([&mesh.element_ids[e]]).chain(&ids[..8]) {
            write!(out, "{number:w$}")?;
        }
        writeln!(out)?;
        if ids.len() > 8 {
            ids[8..].iter().try_for_each(|id| write!(out, "{id:w$}"))?;
            writeln!(out)?;
        }
    }
    writeln!(out, "{:>w$}", -1)?;
    for (sets, what, ids) in [(node_sets, "NODE", &mesh.node_ids), (element_sets, "ELEM", &mesh.element_ids)]
    {
        for (name, members) in sets {
            component(&mut out, name, what, members.iter().map(|m| ids[*m as usize]).collect(), w + 1)?;
        }
    }
    for (number, m) in &file.materials {
        let values = [("EX", Some(m.young)), ("PRXY", Some(m.poisson)), ("DENS", m.density)];
        for (label, value) in values {
            let Some(value) = value else { continue };
            writeln!(out, "MPTEMP,R5.0, 1, 1,  0.00000000    ,")?;
            writeln!(out, "MPDATA,R5.0, 1,{label:<4},{number:6}, 1, {},", fortran(value))?;
        }
    }
    for c in &file.constraints {
        let (id, label) = (mesh.node_ids[c.node as usize], ["UX", "UY", "UZ"][c.direction as usize]);
        writeln!(out, "D,{id:9},{label:<4}, {}, {}", fortran(c.value), fortran(0.0))?;
    }
    writeln!(out, "/GO\nFINISH")?;
    Ok(out)
}

fn element_type(kind: ElementKind) -> u32 {
    TYPES.iter().find(|(_, family)| *family == foreign(kind).ansys.0).map_or(0, |(number, _)| *number)
}

/// Ascending ids; runs of three or more as first and minus last.
fn component(out: &mut String, name: &str, what: &str, mut ids: Vec<u32>, w: usize) -> std::fmt::Result {
    ids.sort_unstable();
    let mut entries: Vec<i64> = Vec::new();
    let mut at = 0;
    while at < ids.len() {
        let mut end = at;
        while end + 1 < ids.len() && ids[end + 1] == ids[end] + 1 {
            end += 1;
        }
        entries.push(i64::from(ids[at]));
        match end - at {
            0 => {}
            1 => entries.push(i64::from(ids[end])),
            _ => entries.push(-i64::from(ids[end])),
        }
        at = end + 1;
    }
    writeln!(out, "CMBLOCK,{name:<8},{what},{:8}\n(8i{w})", entries.len())?;
    for row in entries.chunks(8) {
        row.iter().try_for_each(|entry| write!(out, "{entry:w$}"))?;
        writeln!(out)?;
    }
    Ok(())
}
