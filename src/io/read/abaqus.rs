//! Reader of Abaqus and CalculiX input files (`.inp`).
//!
//! Material ids: trailing number of the name if all names have distinct ones (`MATERIAL_3`), else order of
//! *MATERIAL. Without sections all elements get 1.
//!
//! Source: Abaqus Keywords Reference and Analysis User's Guide, "Three-dimensional solid element library":
//! C3D20, C3D15 and C3D10 number mid-side nodes as SOLID186 and VTK do. A 13-node pyramid is a C3D20 with
//! repeated nodes.
//!
//! Not supported: constraints of later steps, local coordinate systems, several or moved parts.

use std::collections::BTreeMap;
use std::path::Path;

use trackbed_fem::ElementKind;
use trackbed_fem::element::NaturalShape;

use super::abaqus_data as data;
use super::abaqus_faces as faces;
use super::abaqus_lines::{Block, read_blocks};
use super::abaqus_sets::{self as sets, Members};
use super::degenerate::from_brick;
use super::error::ReadError;
use super::foreign_elements::{FOREIGN, foreign, listed};
use super::mesh_file::{Builder, MeshFile};
use super::number;

const REFUSED: [&str; 12] = [
    "NGEN",
    "NFILL",
    "NCOPY",
    "NMAP",
    "ELGEN",
    "ELCOPY",
    "UEL",
    "USERELEMENT",
    "SYSTEM",
    "TRANSFORM",
    "IMPORT",
    "ELPROGRESSIVE",
];

const MECHANICAL: [&str; 17] = [
    "MODELCHANGE",
    "EQUATION",
    "MPC",
    "TIE",
    "COUPLING",
    "KINEMATICCOUPLING",
    "RIGIDBODY",
    "EMBEDDEDELEMENT",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "CONTACTPAIR",
    "INITIALCONDITIONS",
    "PLASTIC",
    "AMPLITUDE",
    "SPRING",
    "SURFACEINTERACTION",
];

#[derive(Default)]
pub(super) struct Deck {
    pub element_sets: BTreeMap<String, Members>,
    pub node_sets: BTreeMap<String, Members>,
    pub members: u64,
    /// First spelling by upper case.
    pub names: BTreeMap<String, String>,
    pub materials: Vec<data::Material>,
    pub sections: Vec<(usize, String, String)>,
    pub boundaries: Vec<data::Boundary>,
    pub renewed: bool,
    pub surfaces: Vec<(String, Vec<faces::Row>)>,
    /// Elements of other kinds written as bricks with repeated nodes.
    pub folded: std::collections::HashSet<u32>,
    /// Skipped elements; sets may name them.
    pub left_out: std::collections::HashSet<u32>,
    pub parts: Vec<String>,
    pub instances: Vec<String>,
    pub steps: usize,
    pub skipped: BTreeMap<String, usize>,
}

/// Reads an Abaqus input file.
///
/// # Errors
/// Unsupported keywords or elements, wrong counts, unreadable numbers, unknown nodes, elements, sets and
/// materials.
pub fn read_inp(file: &Path) -> Result<MeshFile, ReadError> {
    let mut builder = Builder::new(file);
    let mut deck = Deck::default();
    let (blocks, unit) = read_blocks(file)?;
    builder.made.unit = unit;
    if blocks.is_empty() {
        return Err(ReadError::whole(file, "Abaqus input", "no keyword", "keywords such as *NODE"));
    }
    for block in &blocks {
        // Errors name the included file.
        builder.file.clone_from(&block.file);
        keyword(&mut builder, &mut deck, block)?;
    }
    builder.file = file.to_path_buf();
    sets::check_sizes(&builder, &deck)?;
    data::sections(&mut builder, &deck)?;
    data::boundaries(&mut builder, &deck)?;
    sets::sets(&mut builder, &deck);
    surfaces(&mut builder, &deck)?;
    if !deck.skipped.is_empty() {
        let skipped: Vec<String> = deck.skipped.iter().map(|(name, n)| format!("*{name} ({n})")).collect();
        builder.warn(format!("keywords that were not read: {}", skipped.join(", ")));
    }
    builder.finish()
}

fn keyword(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    match block.keyword.as_str() {
        "NODE" => nodes(builder, deck, block),
        "ELEMENT" => elements(builder, deck, block),
        "NSET" => sets::node_set(builder, deck, block),
        "ELSET" => sets::element_set(builder, deck, block),
        "MATERIAL" => {
            let name = block.required(builder, "NAME")?.to_string();
            deck.materials.push(data::Material { name, ..Default::default() });
            Ok(())
        }
        "ELASTIC" | "DENSITY" => data::property(builder, deck, block),
        "SOLIDSECTION" => {
            let set = block.required(builder, "ELSET")?.to_uppercase();
            let material = block.required(builder, "MATERIAL")?.to_uppercase();
            deck.sections.push((block.line, set, material));
            Ok(())
        }
        "BOUNDARY" => data::boundary(builder, deck, block),
        "SURFACE" => surface(builder, deck, block),
        "STEP" => {
            deck.steps += 1;
            Ok(())
        }
        "PART" => {
            let name = block.required(builder, "NAME")?.to_string();
            deck.parts.push(name);
            one_only(builder, block, "parts", &deck.parts)
        }
        "INSTANCE" => {
            let name = block.required(builder, "NAME")?.to_string();
            deck.instances.push(name);
            one_only(builder, block, "instances", &deck.instances)?;
            for (line, row) in block.rows() {
                if row.iter().any(|text| !text.is_empty() && number::real(text) != Some(0.0)) {
                    let expected = "an instance without translation or rotation";
                    return Err(builder.fault(line, "*INSTANCE", row.join(", "), expected));
                }
            }
            Ok(())
        }
        name if REFUSED.contains(&name) => {
            let expected = "a file that lists every node and element in global axes";
            Err(builder.fault(block.line, "keyword", format!("*{name}"), expected))
        }
        name => {
            if MECHANICAL.contains(&name) || name.ends_with("SECTION") {
                *deck.skipped.entry(name.to_string()).or_insert(0) += 1;
            }
            Ok(())
        }
    }
}

fn surface(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    let name = block.required(builder, "NAME")?.to_string();
    let kind = block.option("TYPE").unwrap_or("ELEMENT").to_uppercase();
    if kind != "ELEMENT" || block.option("COMBINE").is_some() || block.option("CROP").is_some() {
        *deck.skipped.entry(format!("SURFACE of {kind}")).or_insert(0) += 1;
        return Ok(());
    }
    deck.surfaces.push((name, faces::rows(builder, block)?));
    Ok(())
}

fn surfaces(builder: &mut Builder, deck: &Deck) -> Result<(), ReadError> {
    for (name, rows) in &deck.surfaces {
        let mut found = Vec::new();
        for row in rows {
            let target = deck.without_instance(&row.target);
            let one;
            let ids = match (number::whole(target), deck.element_sets.get(&target.to_uppercase())) {
                (Some(id), _) => {
                    one = Members::of([id]);
                    &one
                }
                (None, Some(set)) => set,
                (None, None) => {
                    let found = format!("\"{}\"", row.target);
                    let expected = "an element or a set of elements";
                    return Err(builder.fault(row.line, "*SURFACE", found, expected));
                }
            };
            let elements = sets::with_elements(builder, |known| ids.resolve(known)).0;
            found.extend(faces::faces_of(builder, row, &elements, &deck.folded)?);
        }
        builder.face_set(name, found);
    }
    Ok(())
}

fn one_only(builder: &Builder, block: &Block, what: &str, names: &[String]) -> Result<(), ReadError> {
    if names.len() < 2 {
        return Ok(());
    }
    let found = format!("several {what}: {}", names.join(", "));
    Err(builder.fault(block.line, format!("*{}", block.keyword), found, "one"))
}

fn nodes(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    if let Some(system) = block.option("SYSTEM").filter(|s| !s.eq_ignore_ascii_case("R")) {
        return Err(builder.fault(block.line, "*NODE", format!("SYSTEM={system}"), "Cartesian coordinates"));
    }
    let mut ids = Vec::with_capacity(block.len());
    for (line, row) in block.rows() {
        let id = data::whole(builder, line, "node number", row.first().copied())?;
        let mut point = [0.0; 3];
        for (axis, x) in point.iter_mut().enumerate() {
            if let Some(text) = row.get(axis + 1).filter(|t| !t.is_empty()) {
                *x = data::real(builder, line, &format!("coordinates of node {id}"), text)?;
            }
        }
        builder.node(line, id, point)?;
        ids.push(id);
    }
    if let Some(set) = block.option("NSET") {
        let name = deck.name(set);
        deck.node_sets.entry(name).or_default().add(ids);
    }
    Ok(())
}

enum Type {
    Solid(ElementKind),
    /// Brick whose nodes may repeat.
    Brick(usize),
    Other,
    Unknown,
}

fn element_type(name: &str) -> Type {
    let Some(rest) = name.strip_prefix("C3D") else {
        let volumes = ["AC3D", "DC3D", "DCC3D", "CIN3D", "COH3D", "SC6", "SC8", "CSS8", "CCL", "EC3D"];
        return if volumes.iter().any(|v| name.starts_with(v)) { Type::Unknown } else { Type::Other };
    };
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let (count, suffix) = rest.split_at(digits);
    if !["", "R", "H", "RH", "I", "IH", "M", "MH", "S", "HS"].contains(&suffix) {
        return Type::Unknown;
    }
    match count {
        "20" => Type::Brick(20),
        "8" => Type::Brick(8),
        _ => {
            let row = FOREIGN.iter().find(|row| row.abaqus.0.strip_prefix("C3D") == Some(count));
            row.map_or(Type::Unknown, |row| Type::Solid(row.kind))
        }
    }
}

fn elements(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    let name = block.required(builder, "TYPE")?.to_uppercase();
    let kind = element_type(&name);
    if let Type::Unknown = kind {
        let expected =
            format!("{}, with or without R, I, H, M", listed(|row| row.abaqus.0.trim_end_matches('R')));
        return Err(builder.fault(block.line, "element type", name, expected));
    }
    let count = match &kind {
        Type::Solid(kind) => kind.node_count(),
        Type::Brick(count) => *count,
        _ => 0,
    };
    let mut ids = Vec::with_capacity(block.len());
    let mut at = 0;
    while let Some((line, first)) = block.row(at) {
        let id = data::whole(builder, line, "element number", first.first().copied())?;
        ids.push(id);
        let mut nodes: Vec<u32> = Vec::with_capacity(count);
        let mut row = first[1..].to_vec();
        loop {
            for text in row.iter().filter(|t| !t.is_empty()) {
                nodes.push(data::whole(builder, line, &format!("node of element {id}"), Some(*text))?);
            }
            at += 1;
            // Elements with many nodes continue on the next line.
            let more = if count > 0 { nodes.len() < count } else { row.last().is_some_and(|t| t.is_empty()) };
            match block.row(at) {
                Some((_, next)) if more => row = next,
                _ => break,
            }
        }
        if count == 0 {
            builder.leave_out(&name);
            deck.left_out.insert(id);
            continue;
        }
        if nodes.len() != count {
            let found = format!("{} nodes", nodes.len());
            let key = format!("element {id} ({name})");
            return Err(builder.fault(line, key, found, count.to_string()));
        }
        let (kind, nodes) = match &kind {
            Type::Solid(kind) => (*kind, foreign(*kind).abaqus.1.read(&nodes)),
            _ => from_brick(&nodes).map_err(|fault| {
                builder.fault(line, format!("element {id} ({name})"), fault.found, fault.expected)
            })?,
        };
        if [8, 20].contains(&count) && kind.shape() != NaturalShape::Hexahedron {
            deck.folded.insert(id);
        }
        let label = format!("{name} {}", kind.name());
        builder.element(line, id, 0, (kind, &label), &nodes)?;
    }
    if let Some(set) = block.option("ELSET") {
        let name = deck.name(set);
        deck.element_sets.entry(name).or_default().add(ids);
    }
    Ok(())
}

impl Deck {
    /// Upper-case set name without its instance prefix; records the first spelling.
    pub fn name(&mut self, written: &str) -> String {
        let written = self.without_instance(written).to_string();
        let upper = written.to_uppercase();
        self.names.entry(upper.clone()).or_insert(written);
        upper
    }

    pub fn without_instance<'a>(&self, written: &'a str) -> &'a str {
        match written.split_once('.') {
            Some((instance, rest)) if self.instances.iter().any(|i| i.eq_ignore_ascii_case(instance)) => rest,
            _ => written,
        }
    }
}
