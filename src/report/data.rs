//! Data of a results directory.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::replaced;
use trackbed_io::results::tables::Table;
use trackbed_io::system;
use trackbed_run::RunFile;

const TABLES: [&str; 9] =
    ["history", "cycles", "push", "breaks", "gradation", "radial", "safety", "modes", "gauss"];

/// State of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Completed without warnings.
    Passed,
    /// Completed with warnings.
    Warned,
    /// Failed.
    Failed,
    /// Interrupted, resumable.
    Interrupted,
    /// Running.
    Running,
    /// Ended without status.
    Stopped,
    /// Modal analysis, without checks.
    Modes,
}

/// Data of a results directory.
pub struct RunData {
    /// Directory.
    pub dir: PathBuf,
    /// Unique short name.
    pub label: String,
    /// `summary.json`, or null.
    pub summary: Value,
    /// `run.json`.
    pub file: Option<RunFile>,
    /// Scene keys with overrides.
    pub keys: BTreeMap<String, String>,
    /// Scene, if understood.
    pub scene: Option<Scene>,
    tables: BTreeMap<&'static str, Table>,
    lock: Option<(u32, bool)>,
}

impl RunData {
    /// Reads a directory.
    ///
    /// # Errors
    /// No results, or an invalid file.
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
            scene: document.as_ref().and_then(|d| d.scene().ok()),
            summary,
            file,
            tables,
            lock,
        })
    }

    /// Returns a non-empty table.
    pub fn table(&self, name: &str) -> Option<&Table> {
        self.tables.get(name).filter(|t| t.rows() > 0)
    }

    /// Returns tables with unreadable rows, and their number.
    pub fn damaged(&self) -> impl Iterator<Item = (&'static str, usize)> + '_ {
        self.tables.iter().filter(|(_, t)| t.skipped > 0).map(|(name, t)| (*name, t.skipped))
    }

    /// Returns a summary value such as `model.bodies`, or null.
    pub fn value(&self, path: &str) -> &Value {
        path.split('.').fold(&self.summary, |value, key| match key.parse::<usize>() {
            Ok(index) if value.is_array() => value.get(index).unwrap_or(&Value::Null),
            _ => value.get(key).unwrap_or(&Value::Null),
        })
    }

    /// Returns a finite number of the summary.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.value(path).as_f64().filter(|v| v.is_finite())
    }

    /// Returns a text of the summary.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.value(path).as_str()
    }

    /// Returns a list of the summary, or an empty one.
    pub fn list(&self, path: &str) -> &[Value] {
        self.value(path).as_array().map_or(&[], Vec::as_slice)
    }

    /// Returns the scene title.
    pub fn title(&self) -> &str {
        let named = self.text("title").or(self.scene.as_ref().map(|s| s.title.as_str()));
        named.filter(|t| !t.is_empty()).unwrap_or(&self.label)
    }

    /// Returns the state of the run.
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

    /// Returns the process in the lock file.
    pub fn process(&self) -> Option<u32> {
        self.lock.map(|l| l.0)
    }
}

fn summary(file: &Path) -> Result<Value, Failure> {
    if !file.exists() {
        return Ok(Value::Null);
    }
    let refused = |found: String, expected: &str| {
        Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
    };
    let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
    match serde_json::from_slice::<Value>(&bytes) {
        Ok(mut value) if value.get("status").is_some_and(Value::is_string) => {
            replaced::update(&mut value);
            Ok(value)
        }
        Ok(_) => Err(refused("no status".into(), "the summary of a run")),
        Err(e) => Err(refused(e.to_string(), "the summary of a run")),
    }
}

/// Not locked, because a starting run needs the file.
fn lock(dir: &Path) -> Option<(u32, bool)> {
    let text = std::fs::read_to_string(dir.join("run.lock")).ok()?;
    let process: u32 = text.lines().next()?.trim().parse().ok()?;
    Some((process, system::is_running(process)))
}

/// Makes labels unique by the parent directory, then numbers.
pub fn distinguish(runs: &mut [RunData]) {
    let alike = |runs: &[RunData], k: usize| runs.iter().filter(|r| r.label == runs[k].label).count() > 1;
    let doubled: Vec<usize> = (0..runs.len()).filter(|&k| alike(runs, k)).collect();
    for &k in &doubled {
        let parts: Vec<_> = runs[k].dir.components().collect();
        let last: PathBuf = parts[parts.len().saturating_sub(2)..].iter().collect();
        runs[k].label = last.display().to_string();
    }
    let doubled: Vec<usize> = (0..runs.len()).filter(|&k| alike(runs, k)).collect();
    for &k in &doubled {
        runs[k].label = format!("{} ({})", runs[k].label, k + 1);
    }
}
