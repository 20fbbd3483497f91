//! Reader of ANSYS archives (`.cdb`, `.dat`) written by CDWRITE with option DB.
//!
//! Source: ANSYS Mechanical APDL Command Reference and Programmer's Reference, "Format of the coded database
//! file".
//!
//! Limits: blocked archives only, no constraints in rotated nodal systems, first value of temperature
//! tables.

use std::collections::BTreeMap;
use std::path::Path;

use super::cdb_blocks::{self, Lines};
use super::cdb_elements::{self, RawElement};
use super::error::ReadError;
use super::mesh_file::{Builder, FileMaterial, MeshFile, read_text};
use super::number;

const MECHANICAL: [&str; 14] = [
    "F", "SF", "SFE", "SFBLOCK", "SFEBLOCK", "CE", "CEBLOCK", "CP", "IC", "INISTATE", "TB", "BF", "DSYM",
    "CERIG",
];

pub(super) struct Component {
    pub name: String,
    pub of_nodes: bool,
    pub ranges: Vec<(u32, u32)>,
}

#[derive(Default)]
pub(super) struct Archive {
    /// Element type, such as 186, by type id.
    pub types: BTreeMap<u32, u32>,
    pub elements: Vec<RawElement>,
    /// Line of each node in a rotated coordinate system.
    pub turned: BTreeMap<u32, usize>,
    components: Vec<Component>,
    constraints: Vec<(usize, Vec<String>)>,
    properties: BTreeMap<u32, BTreeMap<String, f64>>,
    skipped: BTreeMap<String, usize>,
}

/// Reads an archive.
///
/// # Errors
/// Unblocked archives, damaged blocks, unknown element types or nodes, unreadable constraints.
pub fn read_cdb(file: &Path) -> Result<MeshFile, ReadError> {
    let text = read_text(file, "ANSYS archive")?;
    let mut builder = Builder::new(file);
    let mut archive = Archive::default();
    let mut lines = Lines::new(file, &text);
    while let Some((line, body)) = lines.next() {
        command(&mut lines, line, body, &mut builder, &mut archive)?;
    }
    builder.made.unit = lines.unit.take();
    cdb_elements::add(&mut builder, &archive)?;
    add_components(&mut builder, &archive);
    for (line, fields) in &archive.constraints {
        constrain(&mut builder, &archive, *line, fields)?;
    }
    add_materials(&mut builder, &archive);
    if !archive.skipped.is_empty() {
        let skipped: Vec<String> = archive.skipped.iter().map(|(name, n)| format!("{name} ({n})")).collect();
        builder.warn(format!("commands that were not read: {}", skipped.join(", ")));
    }
    builder.finish()
}

fn command(
    lines: &mut Lines,
    line: usize,
    body: &str,
    builder: &mut Builder,
    archive: &mut Archive,
) -> Result<(), ReadError> {
    let fields: Vec<&str> = body.split(',').map(str::trim).collect();
    let name = fields[0].to_ascii_uppercase();
    match name.as_str() {
        "NBLOCK" => cdb_blocks::nodes(lines, line, &fields, builder, archive),
        "EBLOCK" => cdb_blocks::elements(lines, line, &fields, archive),
        "ETBLOCK" => cdb_blocks::types(lines, line, archive),
        "CMBLOCK" => {
            match cdb_blocks::component(lines, line, &fields)? {
                Some(component) => archive.components.push(component),
                None => {
                    let (name, kind) = (fields[1], fields[2]);
                    builder.warn(format!("component {name} of the solid model ({kind}) is left out"));
                }
            }
            Ok(())
        }
        "ET" => element_type(builder, archive, line, &fields),
        "D" => {
            archive.constraints.push((line, fields.iter().map(|f| f.to_string()).collect()));
            Ok(())
        }
        "MP" | "MPDATA" => property(builder, archive, line, &fields),
        "N" | "EN" | "E" | "EMORE" => {
            // N,R5.3,LOC,-1 and EN,R5.5,ATTR,-1 end the blocks.
            let ends = fields.contains(&"-1");
            let found = format!("{name} commands, one per item");
            let expected = "a blocked archive (CDWRITE without UNBLOCKED)";
            if ends { Ok(()) } else { Err(builder.fault(line, "archive", found, expected)) }
        }
        _ if MECHANICAL.contains(&name.as_str()) => {
            *archive.skipped.entry(name).or_insert(0) += 1;
            Ok(())
        }
        _ => Ok(()),
    }
}

fn whole(builder: &Builder, line: usize, key: &str, text: &str) -> Result<u32, ReadError> {
    number::whole(text)
        .ok_or_else(|| builder.fault(line, key, format!("\"{text}\""), "a whole number of 0 or more"))
}

fn real(builder: &Builder, line: usize, key: &str, text: &str) -> Result<f64, ReadError> {
    let value = number::real(text).filter(|v| v.is_finite());
    value.ok_or_else(|| builder.fault(line, key, format!("\"{text}\""), "a finite number"))
}

/// `ET, number, type`; type is a number or a name such as SOLID186.
fn element_type(
    builder: &Builder,
    archive: &mut Archive,
    line: usize,
    fields: &[&str],
) -> Result<(), ReadError> {
    let (Some(number), Some(name)) = (fields.get(1), fields.get(2)) else {
        return Err(builder.fault(line, "ET", fields.join(","), "ET, number, type"));
    };
    let digits = name.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let number = whole(builder, line, "element type number", number)?;
    let kind = whole(builder, line, "element type", digits)?;
    archive.types.insert(number, kind);
    Ok(())
}

/// `MP, label, mat, value` or `MPDATA, R5.0, count, label, mat, first, values…`.
fn property(
    builder: &mut Builder,
    archive: &mut Archive,
    line: usize,
    fields: &[&str],
) -> Result<(), ReadError> {
    let label = |f: &str| ["EX", "NUXY", "PRXY", "DENS"].contains(&f.to_ascii_uppercase().as_str());
    let Some(at) = fields.iter().position(|f| label(f)) else {
        let anisotropic = ["EY", "EZ", "GXY", "GYZ", "GXZ"];
        if let Some(f) = fields.iter().find(|f| anisotropic.contains(&f.to_ascii_uppercase().as_str())) {
            builder.warn(format!("line {line}: {f} is not read: materials are isotropic"));
        }
        return Ok(());
    };
    let name = fields[at].to_ascii_uppercase();
    let values = at + if fields[0].eq_ignore_ascii_case("MPDATA") { 3 } else { 2 };
    let material = whole(builder, line, "material number", fields.get(at + 1).copied().unwrap_or(""))?;
    let Some(text) = fields.get(values).filter(|f| !f.is_empty()) else {
        return Err(builder.fault(line, name, "no value", "a number"));
    };
    let value = real(builder, line, &name, text)?;
    let first = fields.get(at + 2).filter(|_| values == at + 3).is_none_or(|f| *f == "1" || f.is_empty());
    let more = fields[values + 1..].iter().filter(|f| !f.is_empty()).count();
    if more > 0 || !first {
        builder.warn(format!("line {line}: of the {name} of material {material} the first value is taken"));
    }
    let of_material = archive.properties.entry(material).or_default();
    if first {
        of_material.insert(name, value);
    }
    Ok(())
}

fn add_materials(builder: &mut Builder, archive: &Archive) {
    for (number, values) in &archive.properties {
        let poisson = values.get("PRXY").or_else(|| values.get("NUXY"));
        if let (Some(young), Some(poisson)) = (values.get("EX"), poisson) {
            let density = values.get("DENS").copied();
            let material = FileMaterial { young: *young, poisson: *poisson, density };
            builder.made.materials.insert(*number, material);
        } else {
            let has: Vec<&str> = values.keys().map(String::as_str).collect();
            builder.warn(format!(
                "material {number} has {} only, not both EX and a Poisson's ratio, and is left out",
                has.join(", ")
            ));
        }
    }
}

fn add_components(builder: &mut Builder, archive: &Archive) {
    for Component { name, of_nodes, ranges } in &archive.components {
        let mut members = Vec::new();
        let mut absent = 0;
        let mesh = &builder.made.mesh;
        let ids = if *of_nodes { &mesh.node_ids } else { &mesh.element_ids };
        for &(first, last) in ranges {
            if (last - first) as usize > ids.len() {
                let inside = ids.iter().enumerate().filter(|(_, id)| (first..=last).contains(id));
                members.extend(inside.map(|(index, _)| index as u32));
                continue;
            }
            for id in first..=last {
                let index = if *of_nodes { builder.node_index(id) } else { builder.element_index(id) };
                absent += usize::from(index.is_none());
                members.extend(index);
            }
        }
        if *of_nodes {
            builder.node_set(name, members)
        } else {
            builder.element_set(name, members)
        }
        if absent > 0 {
            let what = if *of_nodes { "nodes that are not there" } else { "elements that were left out" };
            builder.warn(format!("component {name} names {absent} {what}"));
        }
    }
}

/// `D, node, label, value, value2, last, step, label2…label6`; the node may be a component.
fn constrain(
    builder: &mut Builder,
    archive: &Archive,
    line: usize,
    fields: &[String],
) -> Result<(), ReadError> {
    let field = |at: usize| fields.get(at).map_or("", String::as_str);
    let mut directions: Vec<u8> = Vec::new();
    let mut unread = Vec::new();
    for label in std::iter::once(field(2)).chain((7..12).map(field)).filter(|l| !l.is_empty()) {
        match label.to_ascii_uppercase().as_str() {
            "UX" => directions.push(0),
            "UY" => directions.push(1),
            "UZ" => directions.push(2),
            "ALL" => directions.extend([0, 1, 2]),
            other => unread.push(other.to_string()),
        }
    }
    if !unread.is_empty() {
        builder.warn(format!("line {line}: D of {} is not read", unread.join(", ")));
    }
    if directions.is_empty() {
        if field(2).is_empty() {
            return Err(builder.fault(line, "D", "no direction", "UX, UY, UZ or ALL"));
        }
        return Ok(());
    }
    let value = match field(3) {
        "" => 0.0,
        text => real(builder, line, "prescribed value", text)?,
    };
    if !field(4).is_empty() && real(builder, line, "imaginary part", field(4))? != 0.0 {
        return Err(builder.fault(line, "imaginary part of D", field(4), "0"));
    }
    let mut nodes = Vec::new();
    if let Some(first) = number::whole(field(1)) {
        let last = if field(5).is_empty() { first } else { whole(builder, line, "last node", field(5))? };
        let step = if field(6).is_empty() { 1 } else { whole(builder, line, "node step", field(6))?.max(1) };
        if first == last {
            let found = format!("node {first}");
            let expected = "a node of the file";
            let index = builder.node_index(first).ok_or_else(|| builder.fault(line, "D", found, expected))?;
            nodes.push(index);
        } else {
            let of_range = |id: &u32| (first..=last).contains(id) && (id - first).is_multiple_of(step);
            let ids = builder.made.mesh.node_ids.iter().enumerate();
            nodes.extend(ids.filter(|(_, id)| of_range(id)).map(|(index, _)| index as u32));
        }
    } else {
        let set = builder.made.node_sets.iter().find(|(name, _)| name.eq_ignore_ascii_case(field(1)));
        let Some((_, set)) = set else {
            let found = format!("\"{}\"", field(1));
            return Err(builder.fault(line, "node of D", found, "a node number or a component of nodes"));
        };
        nodes.extend(set);
    }
    if nodes.is_empty() {
        return Err(builder.fault(line, "D", fields[1..].join(","), "at least one node of the file"));
    }
    for node in nodes {
        let id = builder.made.mesh.node_ids[node as usize];
        if archive.turned.contains_key(&id) {
            let key = format!("constraint of node {id}");
            let expected = "global directions (NROTAT,ALL with CSYS,0 before CDWRITE)";
            return Err(builder.fault(line, key, "a node in a rotated coordinate system", expected));
        }
        for direction in &directions {
            builder.constrain(line, node, *direction, value)?;
        }
    }
    Ok(())
}
