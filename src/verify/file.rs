//! Matrix file: TOML; unknown keys are errors.

use crate::study::QuantityTable;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Verification matrix.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MatrixFile {
    /// Programs to compare with.
    #[serde(default)]
    pub peer: Vec<PeerTable>,
    /// Cases.
    #[serde(default)]
    pub row: Vec<RowTable>,
}

/// Program to compare with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PeerTable {
    /// Name in `row.peers`.
    pub name: String,
    /// Name in tables.
    pub title: String,
    /// Python script that computes rows, relative to this file.
    pub script: PathBuf,
    /// Reason of rows that it does not model.
    pub otherwise: String,
}

/// Verification case.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RowTable {
    /// Name, unique.
    pub name: String,
    /// Group, a table of the page.
    pub group: String,
    /// Case in words.
    pub case: String,
    /// Command; default `run`.
    #[serde(default)]
    pub command: Verb,
    /// Scene or file of element tests, relative to this file.
    pub scene: PathBuf,
    /// Overrides of the scene.
    #[serde(default)]
    pub set: Vec<String>,
    /// Quantity with `exact` and `tolerance`.
    pub quantity: QuantityTable,
    /// Formula or origin of the reference.
    pub formula: String,
    /// Source of the reference.
    pub source: String,
    /// Programs that model the case.
    #[serde(default)]
    pub peers: Vec<String>,
    /// Reasons of programs that do not model it; default: `peer.otherwise`.
    #[serde(default)]
    pub not_modelled: BTreeMap<String, String>,
    /// Explanations of errors above tolerance, by program: `law: …`, `formula: …` or `ours: …`.
    #[serde(default)]
    pub explained: BTreeMap<String, String>,
}

/// Command of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verb {
    /// Run of a scene.
    #[default]
    Run,
    /// Element tests.
    Element,
    /// Natural frequencies.
    Modal,
}

impl Verb {
    /// Returns the command.
    pub fn word(self) -> &'static str {
        match self {
            Verb::Run => "run",
            Verb::Element => "element",
            Verb::Modal => "modal",
        }
    }
}
