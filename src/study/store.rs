//! The folder of a study: a folder of results for each run, and beside it a record of what became of it.
//!
//! ```text
//! DIR/runs/NAME/        results of a run, as `trackbed run` leaves them
//! DIR/runs/NAME.json    its record
//! DIR/runs/NAME.log     what it said on standard error
//! DIR/study.csv, study.md, study.json, pareto.svg
//! ```

use super::plan::Run;
use crate::failure::Failure;
use crate::read::source;
use crate::write::{WriteError, atomic};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Exit code of a numerical failure, which the same run would come to again.
pub const NUMERICAL: i32 = 3;

/// What became of a run so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Label of the run.
    pub label: String,
    /// Overrides.
    pub set: Vec<String>,
    /// Hash of the scene, its overrides and files.
    pub scene_hash: String,
    /// Exit code; none while it runs.
    pub exit_code: Option<i32>,
    /// Why it failed.
    pub message: String,
    /// Processor time of all attempts that have ended by themselves [s].
    pub cpu_seconds: Option<f64>,
    /// Time by the clock of all attempts [s].
    pub wall_seconds: f64,
}

/// What is in the folder of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// A run that is done.
    Done(Record, serde_json::Value),
    /// A run that failed, and would fail again.
    Failed(Record),
    /// A run that was interrupted or killed, or lacked something of the system, with a checkpoint or without.
    Unfinished(Record, bool),
}

/// The folder of a study.
#[derive(Clone, Debug)]
pub struct Store {
    dir: PathBuf,
}

impl Store {
    /// The store in `dir`, which need not be there.
    pub fn new(dir: &Path) -> Store {
        Store { dir: dir.to_path_buf() }
    }

    /// The folder itself.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Folder of the results of a run.
    pub fn results(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(&run.folder)
    }

    /// File with what a run says.
    pub fn log(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(format!("{}.log", run.folder))
    }

    fn record_file(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(format!("{}.json", run.folder))
    }

    /// Makes the folder of the runs.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn make(&self) -> Result<(), Failure> {
        let runs = self.dir.join("runs");
        std::fs::create_dir_all(&runs).map_err(|e| Failure::Other(format!("{}: {e}", runs.display())))
    }

    /// Whether anything of a run is there.
    pub fn has(&self, run: &Run) -> bool {
        self.results(run).exists() || self.record_file(run).exists()
    }

    /// What became of a run, whose scene has the hash `scene_hash` now.
    ///
    /// # Errors
    /// Bad input: there are results of another scene.
    pub fn look(&self, run: &Run, scene_hash: &str) -> Result<Found, Failure> {
        let results = self.results(run);
        let summary = json(&results.join("summary.json"));
        let record: Option<Record> = serde_json::from_value(json(&self.record_file(run))).ok();
        let of = record.as_ref().map(|r| r.scene_hash.as_str()).or(summary["scene_hash"].as_str());
        if let Some(other) = of.filter(|of| *of != scene_hash) {
            let found = format!("found the run \"{}\" of a changed scene (hash {other})", run.label);
            let expected = format!("expected {scene_hash}, --force to start from scratch, or another --out");
            return Err(Failure::Input(format!("{}: {found}, {expected}", results.display())));
        }
        let checkpoint = results.join("checkpoint").exists();
        let done = summary["status"] == "done" && summary["scene_hash"] == scene_hash && !checkpoint;
        let none = record.is_none() && !results.exists();
        let unseen = || Record {
            label: run.label.clone(),
            set: run.set.clone(),
            scene_hash: scene_hash.into(),
            ..Record::default()
        };
        let mut record = record.unwrap_or_else(unseen);
        if done && record.exit_code.is_none() {
            // The study was killed before the run had ended.
            record.cpu_seconds =
                summary["cpu_seconds"].as_f64().map(|s| s + record.cpu_seconds.unwrap_or(0.0));
        }
        Ok(match (none, done, record.exit_code) {
            (true, ..) => Found::Nothing,
            (_, true, _) => Found::Done(record, summary),
            (_, _, Some(NUMERICAL)) => Found::Failed(record),
            _ => Found::Unfinished(record, checkpoint),
        })
    }

    /// Writes the record of a run.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn record(&self, run: &Run, record: &Record) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(record).map_err(|e| Failure::Other(e.to_string()))?;
        write(&self.record_file(run), &text)
    }

    /// Processor time of the last attempt of a run, from the summary that it left [s].
    pub fn cpu_seconds(&self, run: &Run) -> Option<f64> {
        json(&self.results(run).join("summary.json"))["cpu_seconds"].as_f64()
    }
}

/// Writes a text as a whole file, with an end of line.
///
/// # Errors
/// What the system refuses.
pub fn write(file: &Path, text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    atomic::write(file, |out| {
        write!(out, "{text}{end}").map_err(|source| WriteError::Io { file: file.to_path_buf(), source })
    })?;
    Ok(())
}

/// A JSON file; null where there is none.
fn json(file: &Path) -> serde_json::Value {
    let bytes = source::bytes(file, source::LARGEST_TEXT).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}
