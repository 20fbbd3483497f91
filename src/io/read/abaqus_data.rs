//! Materials, sections and constraints of an Abaqus input file.

use std::collections::HashSet;

use super::abaqus::Deck;
use super::abaqus_lines::Block;
use super::abaqus_sets::{Members, with_elements, with_nodes};
use super::error::ReadError;
use super::mesh_file::{Builder, FileMaterial};
use super::number;

#[derive(Default)]
pub(super) struct Material {
    pub name: String,
    pub elastic: Option<(f64, f64)>,
    pub density: Option<f64>,
}

pub(super) struct Boundary {
    line: usize,
    target: String,
    directions: Vec<u8>,
    value: f64,
    step: usize,
}

pub(super) fn whole(builder: &Builder, line: usize, key: &str, text: Option<&str>) -> Result<u32, ReadError> {
    let text = text.unwrap_or_default();
    number::whole(text)
        .ok_or_else(|| builder.fault(line, key, format!("\"{text}\""), "a whole number of 0 or more"))
}

pub(super) fn real(builder: &Builder, line: usize, key: &str, text: &str) -> Result<f64, ReadError> {
    let value = number::real(text).filter(|v| v.is_finite());
    value.ok_or_else(|| builder.fault(line, key, format!("\"{text}\""), "a finite number"))
}

pub(super) fn property(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    let key = format!("*{}", block.keyword);
    let Some(material) = deck.materials.last_mut() else {
        return Err(builder.fault(block.line, key, "it before any material", "*MATERIAL first"));
    };
    let kind = block.option("TYPE").unwrap_or("ISOTROPIC");
    if block.keyword == "ELASTIC" && !kind.to_uppercase().starts_with("ISO") {
        let sentence = format!(
            "line {}: the elastic constants of {} are {kind} and are left out",
            block.line, material.name
        );
        builder.warn(sentence);
        return Ok(());
    }
    let Some((line, row)) = block.row(0) else {
        return Err(builder.fault(block.line, key, "no data line", "numbers"));
    };
    if block.len() > 1 {
        builder.warn(format!("line {line}: of the {key} of {} the first row is taken", material.name));
    }
    let first = real(builder, line, &key, row[0])?;
    if block.keyword == "DENSITY" {
        material.density = Some(first);
    } else {
        let poisson =
            row.get(1).filter(|t| !t.is_empty()).map_or(Ok(0.0), |t| real(builder, line, &key, t))?;
        material.elastic = Some((first, poisson));
    }
    Ok(())
}

fn numbers(materials: &[Material]) -> Vec<u32> {
    let trailing = |name: &str| {
        let digits = name.len() - name.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        name[name.len() - digits..].parse::<u32>().ok()
    };
    let numbers: Option<Vec<u32>> = materials.iter().map(|m| trailing(&m.name)).collect();
    match numbers {
        Some(numbers) if numbers.iter().collect::<HashSet<_>>().len() == numbers.len() => numbers,
        _ => (1..=materials.len() as u32).collect(),
    }
}

pub(super) fn sections(builder: &mut Builder, deck: &Deck) -> Result<(), ReadError> {
    let numbers = numbers(&deck.materials);
    let mut renumbered = Vec::new();
    for (material, number) in deck.materials.iter().zip(&numbers) {
        if !material.name.ends_with(&number.to_string()) {
            renumbered.push(format!("{} is material {number}", material.name));
        }
        if let Some((young, poisson)) = material.elastic {
            let constants = FileMaterial { young, poisson, density: material.density };
            builder.made.materials.insert(*number, constants);
        }
    }
    if !renumbered.is_empty() {
        builder.warn(renumbered.join(", "));
    }
    let mesh = &mut builder.made.mesh;
    if deck.sections.is_empty() {
        mesh.materials.fill(1);
        let count = mesh.element_count();
        builder.warn(format!("no sections: all {count} elements get material number 1"));
        return Ok(());
    }
    let mut with = vec![false; mesh.element_count()];
    for (line, set, material) in &deck.sections {
        let set_key = deck.without_instance(set).to_uppercase();
        let Some(ids) = deck.element_sets.get(&set_key) else {
            return Err(builder.fault(*line, "*SOLID SECTION", format!("ELSET={set}"), "a set of elements"));
        };
        let at = deck.materials.iter().position(|m| m.name.eq_ignore_ascii_case(material));
        let Some(at) = at else {
            return Err(builder.fault(
                *line,
                "*SOLID SECTION",
                format!("MATERIAL={material}"),
                "a *MATERIAL",
            ));
        };
        for index in with_elements(builder, |known| ids.resolve(known)).0 {
            builder.made.mesh.materials[index as usize] = numbers[at];
            with[index as usize] = true;
        }
    }
    let without = with.iter().filter(|w| !**w).count();
    if without > 0 {
        builder.warn(format!("{without} elements have no section and get material number 0"));
    }
    Ok(())
}

/// Only the model and the first step count.
pub(super) fn boundary(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    if deck.steps > 1 {
        *deck.skipped.entry("BOUNDARY of later steps".into()).or_insert(0) += 1;
        return Ok(());
    }
    if let Some(what) = ["USER", "SUBMODEL"].into_iter().find(|what| block.option(what).is_some()) {
        let expected = "displacements in the rows of the file";
        return Err(builder.fault(block.line, "*BOUNDARY", what, expected));
    }
    if let Some(name) = block.option("AMPLITUDE") {
        let sentence = format!(
            "line {}: *BOUNDARY with AMPLITUDE={name}: the values of its rows are taken without it",
            block.line
        );
        builder.warn(sentence);
    }
    let is_new = block.option("OP").is_some_and(|op| op.eq_ignore_ascii_case("NEW"));
    if deck.steps == 1 && is_new {
        renew(builder, deck, block)?;
    } else if deck.renewed {
        let found = "a *BOUNDARY without OP=NEW after one with it";
        return Err(builder.fault(
            block.line,
            "*BOUNDARY",
            found,
            "OP=NEW for all entries of a step, or for none",
        ));
    }
    if let Some(kind) = block.option("TYPE").filter(|k| !k.to_uppercase().starts_with("DISP")) {
        return Err(builder.fault(block.line, "*BOUNDARY", format!("TYPE={kind}"), "displacements"));
    }
    for (line, row) in block.rows() {
        let target = row[0].to_string();
        let second = row.get(1).copied().unwrap_or_default().to_uppercase();
        let named: Option<&[u8]> = match second.as_str() {
            "ENCASTRE" | "PINNED" => Some(&[0, 1, 2]),
            "XSYMM" => Some(&[0]),
            "YSYMM" => Some(&[1]),
            "ZSYMM" => Some(&[2]),
            "XASYMM" => Some(&[1, 2]),
            "YASYMM" => Some(&[0, 2]),
            "ZASYMM" => Some(&[0, 1]),
            _ => None,
        };
        let (directions, value) = match named {
            Some(directions) => (directions.to_vec(), 0.0),
            None => {
                let first = whole(builder, line, "direction of *BOUNDARY", Some(&second))?;
                let last = match row.get(2).filter(|t| !t.is_empty()) {
                    Some(text) => whole(builder, line, "last direction of *BOUNDARY", Some(text))?,
                    None => first,
                };
                let value = match row.get(3).filter(|t| !t.is_empty()) {
                    Some(text) => real(builder, line, "value of *BOUNDARY", text)?,
                    None => 0.0,
                };
                if first == 0 || last < first || last > 11 {
                    let found = format!("{first} to {last}");
                    return Err(builder.fault(line, "directions of *BOUNDARY", found, "1 to 3"));
                }
                ((first..=last.min(3)).map(|d| d as u8 - 1).collect(), value)
            }
        };
        deck.boundaries.push(Boundary { line, target, directions, value, step: deck.steps });
    }
    Ok(())
}

/// OP=NEW in the first step removes all constraints of the model.
fn renew(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    if deck.renewed {
        return Ok(());
    }
    deck.renewed = true;
    if let Some(row) = deck.boundaries.iter().find(|row| row.step == 1) {
        let found = format!("OP=NEW after a *BOUNDARY without it on line {}", row.line);
        return Err(builder.fault(
            block.line,
            "*BOUNDARY",
            found,
            "OP=NEW for all entries of a step, or for none",
        ));
    }
    let count = deck.boundaries.len();
    deck.boundaries.clear();
    if count > 0 {
        let line = block.line;
        builder.warn(format!(
            "line {line}: *BOUNDARY, OP=NEW removes the {count} rows of constraints of the model"
        ));
    }
    Ok(())
}

pub(super) fn boundaries(builder: &mut Builder, deck: &Deck) -> Result<(), ReadError> {
    for row in &deck.boundaries {
        let target = deck.without_instance(&row.target);
        let one;
        let ids = match number::whole(target) {
            Some(id) => {
                one = Members::of([id]);
                &one
            }
            None => match deck.node_sets.get(&target.to_uppercase()) {
                Some(set) => set,
                None => {
                    let found = format!("\"{}\"", row.target);
                    return Err(builder.fault(row.line, "*BOUNDARY", found, "a node or a set of nodes"));
                }
            },
        };
        if let Some(id) = with_nodes(builder, |known| ids.first_absent(known)) {
            return Err(builder.fault(row.line, "*BOUNDARY", format!("node {id}"), "a node of the file"));
        }
        for node in with_nodes(builder, |known| ids.resolve(known)).0 {
            for direction in &row.directions {
                builder.constrain(row.line, node, *direction, row.value)?;
            }
        }
    }
    Ok(())
}
