//! What the folder of a run offers for a report: its files, read as far as they are there.

use crate::failure::Failure;
use crate::read::source;
use crate::results::tables::Table;
use crate::run::RunFile;
use crate::scene::{Document, Scene};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The tables that are read, by their names without `.csv`.
const TABLES: [&str; 9] =
    ["history", "cycles", "push", "breaks", "gradation", "radial", "safety", "modes", "gauss"];

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It ended, and its accounts have nothing to remark.
    Passed,
    /// It ended, with remarks.
    Warned,
    /// It has no result, or a part of one.
    Failed,
    /// It was interrupted and can go on.
    Interrupted,
    /// It goes on.
    Running,
    /// It ended without a word: killed, or the machine went down.
    Stopped,
    /// Modes, which have no account.
    Modes,
}

/// What a folder offers.
pub struct RunData {
    /// The folder.
    pub dir: PathBuf,
    /// Short name, different for each folder.
    pub label: String,
    /// `summary.json`; null where there is none yet.
    pub summary: Value,
    /// `run.json`.
    pub file: Option<RunFile>,
    /// Every key of the scene with its overrides.
    pub keys: BTreeMap<String, String>,
    /// The scene, where this program understands it.
    pub scene: Option<Scene>,
    tables: BTreeMap<&'static str, Table>,
    /// Process that holds the lock, and whether it is there.
    lock: Option<(u32, bool)>,
}

impl RunData {
    /// Reads a folder.
    ///
    /// # Errors
    /// Bad input: it is no folder with results, or one of its files is not what its name says.
    pub fn read(dir: &Path) -> Result<RunData, Failure> {
        let refuse = |found: &str| {
            let expected = "a results directory";
            Err(Failure::Input(format!("{}: found {found}, expected {expected}", dir.display())))
        };
        if !dir.is_dir() {
            return refuse(if dir.exists() { "a file" } else { "nothing" });
        }
        let summary = summary(&dir.join("summary.json"))?;
        let mut tables = BTreeMap::new();
        for name in TABLES {
            if let Some(table) = Table::read(&dir.join(format!("{name}.csv")))? {
                tables.insert(name, table);
            }
        }
        let file = RunFile::read(dir);
        let lock = lock(dir);
        let none = summary.is_null() && file.is_none() && tables.is_empty();
        if none && dir.join("study.md").exists() {
            return refuse("a study, whose runs are in its directory `runs`");
        }
        if none && lock.is_some() {
            return refuse("a run without results");
        }
        if none {
            return refuse("no summary.json, run.json, history.csv or modes.csv");
        }
        let document = file.as_ref().and_then(RunFile::document);
        Ok(RunData {
            label: dir.file_name().map_or_else(|| dir.display(), |n| Path::new(n).display()).to_string(),
            dir: dir.to_path_buf(),
            keys: document.as_ref().map(Document::keys).unwrap_or_default(),
            scene: document.as_ref().and_then(|d| d.read().ok()),
            summary,
            file,
            tables,
            lock,
        })
    }

    /// A table of the folder.
    pub fn table(&self, name: &str) -> Option<&Table> {
        self.tables.get(name).filter(|t| t.rows() > 0)
    }

    /// Names of tables with rows that could not be read, and how many.
    pub fn damaged(&self) -> impl Iterator<Item = (&'static str, usize)> + '_ {
        self.tables.iter().filter(|(_, t)| t.skipped > 0).map(|(name, t)| (*name, t.skipped))
    }

    /// A value of the summary, by keys and indices such as `model.bodies`; null where there is none.
    pub fn value(&self, path: &str) -> &Value {
        path.split('.').fold(&self.summary, |value, key| match key.parse::<usize>() {
            Ok(index) if value.is_array() => value.get(index).unwrap_or(&Value::Null),
            _ => value.get(key).unwrap_or(&Value::Null),
        })
    }

    /// A number of the summary.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.value(path).as_f64().filter(|v| v.is_finite())
    }

    /// A text of the summary.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.value(path).as_str()
    }

    /// A list of the summary; empty where there is none.
    pub fn list(&self, path: &str) -> &[Value] {
        self.value(path).as_array().map_or(&[], Vec::as_slice)
    }

    /// Title of the scene.
    pub fn title(&self) -> &str {
        let named = self.text("title").or(self.scene.as_ref().map(|s| s.title.as_str()));
        named.filter(|t| !t.is_empty()).unwrap_or(&self.label)
    }

    /// How the run stands.
    pub fn state(&self) -> State {
        match (self.text("status"), self.text("verdict.outcome")) {
            (Some("done"), Some("failed")) => State::Failed,
            (Some("done"), Some("warned")) => State::Warned,
            (Some("done"), _) => State::Passed,
            (Some("interrupted"), _) => State::Interrupted,
            (Some(_), _) => State::Failed,
            (None, _) if self.tables.contains_key("modes") => State::Modes,
            (None, _) if self.lock.is_some_and(|(_, there)| there) => State::Running,
            (None, _) => State::Stopped,
        }
    }

    /// Process that holds the folder's lock.
    pub fn process(&self) -> Option<u32> {
        self.lock.map(|l| l.0)
    }
}

/// The summary; null where there is none.
fn summary(file: &Path) -> Result<Value, Failure> {
    if !file.exists() {
        return Ok(Value::Null);
    }
    let refused = |found: String, expected: &str| {
        Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
    };
    let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
    match serde_json::from_slice::<Value>(&bytes) {
        Ok(value) if value.get("status").is_some_and(Value::is_string) => Ok(value),
        Ok(_) => Err(refused("no status".into(), "the summary of a run")),
        Err(e) => Err(refused(e.to_string(), "the summary of a run")),
    }
}

/// Process of the lock of a folder, and whether there is such a process on this machine. The lock itself is left alone: a
/// run that begins at this moment must find it free.
fn lock(dir: &Path) -> Option<(u32, bool)> {
    let text = std::fs::read_to_string(dir.join("run.lock")).ok()?;
    let process: u32 = text.lines().next()?.trim().parse().ok()?;
    Some((process, Path::new("/proc").join(process.to_string()).exists()))
}

/// Gives folders of one name longer ones, and those that are still alike numbers.
pub fn distinguish(runs: &mut [RunData]) {
    let alike = |runs: &[RunData], k: usize| runs.iter().filter(|r| r.label == runs[k].label).count() > 1;
    let doubled: Vec<usize> = (0..runs.len()).filter(|&k| alike(runs, k)).collect();
    for &k in &doubled {
        runs[k].label = runs[k].dir.display().to_string();
    }
    let doubled: Vec<usize> = (0..runs.len()).filter(|&k| alike(runs, k)).collect();
    for &k in &doubled {
        runs[k].label = format!("{} ({})", runs[k].label, k + 1);
    }
}
