//! Study directory with results and records of runs.
//!
//! ```text
//! DIR/runs/NAME/        results of a run
//! DIR/runs/NAME.json    its record
//! DIR/runs/NAME.log     its standard error
//! DIR/samples.csv, study.csv, study.md, study.json, sensitivity.csv, targets.csv, pareto.svg
//! DIR/plots/            response plots, tornado charts
//! ```

use super::label::file_names;
use super::plan::Run;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::write::{WriteError, atomic};

/// Exit code of a numerical failure.
pub const NUMERICAL: i32 = 3;

/// Record of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Label.
    pub label: String,
    /// Overrides.
    pub set: Vec<String>,
    /// Hash of scene, overrides and files.
    pub scene_hash: String,
    /// Exit code; none while running.
    pub exit_code: Option<i32>,
    /// Failure message.
    pub message: String,
    /// CPU time of completed attempts [s].
    pub cpu_seconds: Option<f64>,
    /// Wall time of all attempts [s].
    pub wall_seconds: f64,
}

/// Existing results of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// Completed.
    Done(Record, serde_json::Value),
    /// Failed reproducibly.
    Failed(Record),
    /// Interrupted or killed; whether with checkpoint.
    Unfinished(Record, bool),
}

/// Study directory.
#[derive(Clone, Debug)]
pub struct Store {
    dir: PathBuf,
}

impl Store {
    /// Creates a store in `dir`, which may be missing.
    pub fn new(dir: &Path) -> Store {
        Store { dir: dir.to_path_buf() }
    }

    /// Returns the directory.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Returns the results directory of a run.
    pub fn results(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(&run.folder)
    }

    /// Returns the log file of a run.
    pub fn log(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(format!("{}.log", run.folder))
    }

    fn record_file(&self, run: &Run) -> PathBuf {
        self.dir.join("runs").join(format!("{}.json", run.folder))
    }

    /// Creates the runs directory.
    ///
    /// # Errors
    /// I/O errors.
    pub fn make(&self) -> Result<(), Failure> {
        let runs = self.dir.join("runs");
        std::fs::create_dir_all(&runs).map_err(|e| Failure::Other(format!("{}: {e}", runs.display())))
    }

    /// Writes plots (title, SVG) to files with their titles as names.
    ///
    /// # Errors
    /// I/O errors.
    pub fn write_plots(&self, plots: &[(String, String)]) -> Result<(), Failure> {
        let dir = self.dir.join("plots");
        std::fs::create_dir_all(&dir).map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
        let names = file_names(plots.iter().map(|(title, _)| title.as_str()));
        plots.iter().zip(names).try_for_each(|((_, svg), name)| write(&dir.join(format!("{name}.svg")), svg))
    }

    /// Whether anything exists for a run.
    pub fn has(&self, run: &Run) -> bool {
        self.results(run).exists() || self.record_file(run).exists()
    }

    /// Returns the results of a run.
    ///
    /// # Errors
    /// Results of another scene.
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
            // The study was killed before.
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

    /// Writes a record.
    ///
    /// # Errors
    /// I/O errors.
    pub fn record(&self, run: &Run, record: &Record) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(record).map_err(|e| Failure::Other(e.to_string()))?;
        write(&self.record_file(run), &text)
    }

    /// Returns the CPU time of the last attempt [s].
    pub fn cpu_seconds(&self, run: &Run) -> Option<f64> {
        json(&self.results(run).join("summary.json"))["cpu_seconds"].as_f64()
    }
}

/// Writes a text file.
///
/// # Errors
/// I/O errors.
pub fn write(file: &Path, text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    atomic::write(file, |out| {
        write!(out, "{text}{end}").map_err(|source| WriteError::Io { file: file.to_path_buf(), source })
    })?;
    Ok(())
}

fn json(file: &Path) -> serde_json::Value {
    let bytes = source::bytes(file, source::LARGEST_TEXT).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}
