//! Immutable context shared by all stages.

use super::checkpoint_store::CheckpointStore;
use super::companion::Accompanied;
use super::device::Place;
use super::folder;
use super::origin::quoted;
use super::ranks::Ranked;
use super::run_file::{self, RunFile, Source};
use std::cell::{Cell, OnceCell};
use std::path::Path;
use trackbed_fem as fem;
use trackbed_input::model::Job;
use trackbed_input::plausible::Finding;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::progress::Verbosity;

/// Run in progress.
pub struct Run<'a> {
    /// Scene file, for messages.
    pub document: &'a Document,
    /// Resolved scene.
    pub job: &'a Job,
    /// Results directory.
    pub dir: &'a Path,
    /// Verbosity.
    pub verbosity: Verbosity,
    /// Memory limit of the solid [bytes].
    pub memory: Option<u64>,
    /// Device of the main DEM steps.
    pub device: Place,
    /// Ranks that share these steps.
    pub ranks: &'a Ranked,
    /// Whether the directory holds results of this run.
    pub prepared: Cell<bool>,
    /// Checkpoint store.
    pub checkpoints: CheckpointStore,
    /// Whether the main loop resumes and keeps files.
    pub continued: bool,
    /// Solid with sleepers set down.
    pub set_down: &'a OnceCell<fem::Model>,
    /// Earlier run, source of the initial state.
    pub from: Option<Source<'a>>,
    /// Observer.
    pub accompanied: &'a Accompanied,
    /// Pending plausibility warnings.
    pub findings: Cell<Vec<Finding>>,
}

impl Run<'_> {
    /// Prints plausibility warnings once, after the scene is accepted.
    pub fn remark(&self) {
        self.findings.take().iter().for_each(|finding| message::warn(&finding.to_string()));
    }

    /// Error for a moved results directory; `place`: new location.
    pub fn gone(&self, place: Option<&Path>) -> Failure {
        let dir = self.dir.display();
        let head = format!("{dir}: results directory was renamed or removed during the run");
        // Without either, a run starts from scratch.
        let begun = self.prepared.get() || self.checkpoints.kept().is_some();
        Failure::Other(match place {
            _ if !begun => format!("{head}; nothing had been written"),
            None => format!("{head}; its output is lost"),
            Some(place) => format!(
                "{head}; output up to then, with the last checkpoint, is in {}: resume with --resume --out {}",
                place.display(),
                quoted(place)
            ),
        })
    }

    /// Creates the results directory; resuming keeps files.
    ///
    /// # Errors
    /// I/O errors.
    pub fn prepare(&self) -> Result<(), Failure> {
        self.remark();
        if self.continued {
            folder::resume(self.dir, &self.job.output)?;
        } else {
            self.checkpoints.clear_others()?;
            folder::prepare(self.dir, &self.job.output)?;
        }
        if !self.continued || !self.dir.join(run_file::FILE).exists() {
            RunFile::of(self.document, self.from).write(self.dir)?;
        }
        self.prepared.set(true);
        Ok(())
    }
}
