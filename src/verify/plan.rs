//! Resolved matrix.

use super::file::{MatrixFile, PeerTable, RowTable};
use crate::study::{self, Norm, Quantity};
use std::path::PathBuf;
use trackbed_input::scene::{Document, SceneError};
use trackbed_io::failure::Failure;

const EXPLANATIONS: [&str; 3] = ["law: ", "formula: ", "ours: "];

/// Cases and programs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Programs to compare with.
    pub peers: Vec<Peer>,
    /// Cases.
    pub rows: Vec<Row>,
}

/// Program to compare with.
#[derive(Clone, Debug)]
pub struct Peer {
    /// Keys of the file.
    pub table: PeerTable,
    /// Script.
    pub script: PathBuf,
}

/// Verification case.
#[derive(Clone, Debug)]
pub struct Row {
    /// Keys of the file.
    pub table: RowTable,
    /// Scene.
    pub scene: PathBuf,
    /// Quantity.
    pub quantity: Quantity,
    /// Reference value, in the unit of the quantity.
    pub reference: f64,
}

impl Row {
    /// Whether both rows need the same run.
    pub fn shares_run(&self, other: &Row) -> bool {
        let key = |row: &Row| (row.table.command, row.scene.clone(), row.table.set.clone());
        key(self) == key(other)
    }

    /// Returns the error of a value: relative, or a difference with an absolute norm.
    pub fn error(&self, value: f64) -> f64 {
        let scale = match self.quantity.norm {
            Norm::Absolute => 1.0,
            Norm::Relative => self.quantity.scale.unwrap_or(self.reference.abs()),
        };
        (value - self.reference) / scale
    }

    /// Returns the norm of errors and tolerance.
    pub fn norm(&self) -> &'static str {
        match self.quantity.norm {
            Norm::Absolute => "absolute",
            Norm::Relative => "relative",
        }
    }

    /// Whether an error is within the tolerance.
    pub fn passes(&self, error: f64) -> bool {
        error.abs() <= self.quantity.tolerance
    }
}

impl Plan {
    /// Resolves all rows.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, file: &MatrixFile) -> Result<Plan, SceneError> {
        let names: Vec<&str> = file.peer.iter().map(|peer| peer.name.as_str()).collect();
        for (k, peer) in file.peer.iter().enumerate() {
            check_name(document, &format!("peer.{k}.name"), &peer.name)?;
        }
        let peer = |table: &PeerTable| Peer { script: document.resolve(&table.script), table: table.clone() };
        let mut rows = Vec::new();
        for (k, table) in file.row.iter().enumerate() {
            if file.row[..k].iter().any(|other| other.name == table.name) {
                let found = format!("{:?} twice", table.name);
                return Err(document.error(&format!("row.{k}.name"), found, "distinct names"));
            }
            rows.push(row(document, k, table, &names)?);
        }
        Ok(Plan { peers: file.peer.iter().map(peer).collect(), rows })
    }

    /// Keeps the rows whose name or group is in `only`, all if it is empty.
    ///
    /// # Errors
    /// A name that is neither row nor group.
    pub fn keep(&mut self, only: &[String]) -> Result<(), Failure> {
        let has = |row: &Row, name: &String| row.table.name == *name || row.table.group == *name;
        if let Some(unknown) = only.iter().find(|name| !self.rows.iter().any(|row| has(row, name))) {
            let expected = format!("a row, or one of the groups {}", self.groups().join(", "));
            return Err(Failure::Input(format!("--only: found {unknown:?}, expected {expected}")));
        }
        self.rows.retain(|row| only.is_empty() || only.iter().any(|name| has(row, name)));
        Ok(())
    }

    /// Returns the groups in the order of the file.
    pub fn groups(&self) -> Vec<&str> {
        let mut groups: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !groups.contains(&row.table.group.as_str()) {
                groups.push(&row.table.group);
            }
        }
        groups
    }
}

/// Names are also names of files.
fn check_name(document: &Document, path: &str, name: &str) -> Result<(), SceneError> {
    let valid = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.chars().all(valid) {
        return Ok(());
    }
    Err(document.error(path, format!("{name:?}"), "letters, digits, `-` or `_`"))
}

fn row(document: &Document, k: usize, table: &RowTable, peers: &[&str]) -> Result<Row, SceneError> {
    let at = |key: &str| format!("row.{k}.{key}");
    check_name(document, &at("name"), &table.name)?;
    let scene = document.resolve(&table.scene);
    if !scene.is_file() {
        let expected = "a scene, or a file of element tests";
        return Err(document.error(&at("scene"), format!("{:?}", table.scene), expected));
    }
    let keys = [
        ("peers", table.peers.iter().collect::<Vec<_>>()),
        ("not_modelled", table.not_modelled.keys().collect()),
        ("explained", table.explained.keys().collect()),
    ];
    for (key, names) in keys {
        if let Some(name) = names.iter().find(|name| !peers.contains(&name.as_str())) {
            let expected = format!("one of {}", peers.join(", "));
            return Err(document.error(&at(key), format!("{name:?}"), expected));
        }
    }
    if let Some(name) = table.not_modelled.keys().find(|name| table.peers.contains(name)) {
        return Err(document.error(&at("not_modelled"), format!("{name:?}"), "a program not in `peers`"));
    }
    if let Some(text) =
        table.explained.values().find(|text| !EXPLANATIONS.iter().any(|e| text.starts_with(e)))
    {
        let expected = "a text that begins with \"law: \", \"formula: \" or \"ours: \"";
        return Err(document.error(&at("explained"), format!("{text:?}"), expected));
    }
    let quantity = study::quantity(document, &at("quantity"), &table.quantity, 0.0)?;
    let (Some(reference), Some(_)) = (table.quantity.exact, table.quantity.tolerance) else {
        let key = if table.quantity.exact.is_none() { "exact" } else { "tolerance" };
        return Err(document.error(&at(&format!("quantity.{key}")), "nothing", "a number"));
    };
    Ok(Row { table: table.clone(), scene, quantity, reference })
}
