//! Runs of small scenes, with checks of exit code and finite values.

use super::super::support::{Folder, Outcome, Table, json, run};
use serde_json::Value;
use std::path::PathBuf;
use trackbed_fem::mesh::{Constraint, Mesh};

/// Run of a scene.
pub struct Case {
    folder: Folder,
    /// Exit code and output.
    pub outcome: Outcome,
}

impl Case {
    /// Runs `text` with overrides.
    pub fn run(text: &str, set: &[&str]) -> Case {
        Case::in_folder(Folder::new("extremes"), text, set)
    }

    /// Runs a scene on the lists of a mesh with `constraints`.
    pub fn on_mesh(mesh: &Mesh, constraints: &[Constraint], text: &str, set: &[&str]) -> Case {
        let folder = Folder::new("extremes");
        trackbed::write::ansys_lists::write_lists(mesh, constraints, folder.path()).unwrap();
        Case::in_folder(folder, text, set)
    }

    /// Runs a scene in a prepared directory.
    pub fn in_folder(folder: Folder, text: &str, set: &[&str]) -> Case {
        let scene = folder.write("scene.toml", text);
        let outcome = run(&scene, &folder.join("out"), set);
        let case = Case { folder, outcome };
        let Outcome { code, stderr, .. } = &case.outcome;
        assert!([0, 2, 3].contains(code) && !stderr.contains("internal error"), "{code}: {stderr}");
        match code {
            2 => assert!(!case.file("").exists() && stderr.trim_end().lines().count() == 1, "{stderr}"),
            _ => case.only_finite(),
        }
        case
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join("out").join(name)
    }

    fn only_finite(&self) {
        for name in ["history.csv", "packing.csv", "nodes.csv", "gauss.csv"] {
            if self.file(name).exists() {
                Table::read(&self.file(name));
            }
        }
        let summary = self.summary();
        for account in ["energy", "momentum", "statics"] {
            if let Some(values) = summary.get(account) {
                assert!(!values.to_string().contains("null"), "{account}: {values:#}");
            }
        }
    }

    /// Requires exit code 0.
    #[track_caller]
    pub fn good(self) -> Case {
        assert_eq!(self.outcome.code, 0, "{:?}", self.outcome);
        self
    }

    /// Requires exit code 2, `part` in the message, no files.
    #[track_caller]
    pub fn refused(&self, part: &str) {
        self.ended(2, part);
    }

    /// Requires exit code 3, `part` in the message and that status.
    #[track_caller]
    pub fn stopped(&self, part: &str) {
        self.ended(3, part);
        assert!(self.summary()["status"].as_str().unwrap().starts_with("failed: "));
    }

    #[track_caller]
    fn ended(&self, code: i32, part: &str) {
        let Outcome { code: found, stderr, .. } = &self.outcome;
        assert!(*found == code && stderr.contains(part), "expected {code} and {part:?}: {found}, {stderr}");
    }

    /// Content of `summary.json`.
    pub fn summary(&self) -> Value {
        json(&self.file("summary.json"))
    }

    /// Number at a JSON path of the summary.
    #[track_caller]
    pub fn value(&self, path: &str) -> f64 {
        let summary = self.summary();
        summary.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {summary:#}"))
    }

    /// Whether a warning contains `part`.
    pub fn warned(&self, part: &str) -> bool {
        self.summary()["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(part))
    }

    /// Result table.
    pub fn table(&self, name: &str) -> Table {
        Table::read(&self.file(name))
    }

    /// Column of `history.csv`.
    #[track_caller]
    pub fn history(&self, column: &str) -> Vec<f64> {
        self.table("history.csv").column(column)
    }

    /// Last value of a history column.
    #[track_caller]
    pub fn last(&self, column: &str) -> f64 {
        *self.history(column).last().unwrap()
    }

    /// Mean velocity of a recorded group over the last fraction `part` of the rows [m/s].
    #[track_caller]
    pub fn velocity(&self, group: &str, part: f64) -> [f64; 3] {
        let time = self.history("time");
        let end = time.len() - 1;
        let from = end - ((end as f64 * part) as usize).max(1);
        ["x", "y", "z"].map(|axis| {
            let place = self.history(&format!("{group}_{axis}"));
            (place[end] - place[from]) / (time[end] - time[from])
        })
    }
}

/// Relative difference from `right`.
pub fn off(found: f64, right: f64) -> f64 {
    (found / right - 1.0).abs()
}
