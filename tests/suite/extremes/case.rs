//! Runs of small scenes, and what must hold for each: an exit code that is named, no fault of the program, only finite numbers.

use super::super::support::{Folder, Outcome, Table, json, run};
use serde_json::Value;
use std::path::PathBuf;
use trackbed_fem::mesh::{Constraint, Mesh};

/// A run of the program on a scene.
pub struct Case {
    folder: Folder,
    /// Exit code and what was said.
    pub outcome: Outcome,
}

impl Case {
    /// Runs the scene `text` with overrides `key.path=value`.
    pub fn run(text: &str, set: &[&str]) -> Case {
        Case::in_folder(Folder::new("extremes"), text, set)
    }

    /// Runs a scene beside the lists of a mesh, whose `constraints` are written with it.
    pub fn on_mesh(mesh: &Mesh, constraints: &[Constraint], text: &str, set: &[&str]) -> Case {
        let folder = Folder::new("extremes");
        trackbed::write::ansys_lists::write_lists(mesh, constraints, folder.path()).unwrap();
        Case::in_folder(folder, text, set)
    }

    /// Runs a scene in a folder that may hold files for it.
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

    /// No table that was left holds anything but finite numbers, and neither do the accounts of the summary.
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

    /// Fails the test unless the run came to its end.
    #[track_caller]
    pub fn good(self) -> Case {
        assert_eq!(self.outcome.code, 0, "{:?}", self.outcome);
        self
    }

    /// Asserts exit code 2 with `part` in the message; nothing was written.
    #[track_caller]
    pub fn refused(&self, part: &str) {
        self.ended(2, part);
    }

    /// Asserts exit code 3 with `part` in the message, and a summary with that status.
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

    /// What the run left as `summary.json`.
    pub fn summary(&self) -> Value {
        json(&self.file("summary.json"))
    }

    /// A number of the summary by its path, such as `/energy/largest_relative_error`.
    #[track_caller]
    pub fn value(&self, path: &str) -> f64 {
        let summary = self.summary();
        summary.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {summary:#}"))
    }

    /// Whether a remark of the summary holds `part`.
    pub fn warned(&self, part: &str) -> bool {
        self.summary()["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(part))
    }

    /// A table that the run left.
    pub fn table(&self, name: &str) -> Table {
        Table::read(&self.file(name))
    }

    /// A column of `history.csv`.
    #[track_caller]
    pub fn history(&self, column: &str) -> Vec<f64> {
        self.table("history.csv").column(column)
    }

    /// Last value of a column of `history.csv`.
    #[track_caller]
    pub fn last(&self, column: &str) -> f64 {
        *self.history(column).last().unwrap()
    }

    /// Mean velocity of the mean place of a recorded group over the last `part` of the rows [m/s].
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

/// Difference of two numbers relative to the second.
pub fn off(found: f64, right: f64) -> f64 {
    (found / right - 1.0).abs()
}
