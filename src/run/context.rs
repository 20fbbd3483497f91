//! What all stages of a run share and none changes.

use super::checkpoint_store::CheckpointStore;
use super::companion::Accompanied;
use super::device::Place;
use super::folder;
use super::origin::quoted;
use super::ranks::Ranked;
use super::run_file::{self, RunFile, Source};
use crate::failure::Failure;
use crate::message;
use crate::model::Job;
use crate::plausible::Finding;
use crate::progress::Verbosity;
use crate::scene::Document;
use std::cell::{Cell, OnceCell};
use std::path::Path;
use trackbed_fem as fem;

/// One run in progress.
pub struct Run<'a> {
    /// The scene file, for messages about its keys.
    pub document: &'a Document,
    /// The scene, resolved.
    pub job: &'a Job,
    /// Folder of the results.
    pub dir: &'a Path,
    /// How much is printed.
    pub verbosity: Verbosity,
    /// Most memory that a solid may need [bytes].
    pub memory: Option<u64>,
    /// Where the steps of the grains are computed in the main loop.
    pub device: Place,
    /// The ranks that share these steps, if there are any.
    pub ranks: &'a Ranked,
    /// Whether the folder is cleared of earlier results and holds those of this run.
    pub prepared: Cell<bool>,
    /// Where checkpoints go.
    pub checkpoints: CheckpointStore,
    /// Whether the main loop is continued from a checkpoint, so that the files in the folder are its own.
    pub continued: bool,
    /// The solid with its meshed sleepers where they were set down.
    pub set_down: &'a OnceCell<fem::Model>,
    /// The run from whose end this one goes on.
    pub from: Option<Source<'a>>,
    /// Who accompanies the run.
    pub accompanied: &'a Accompanied,
    /// Values that are not plausible, until they are remarked on.
    pub findings: Cell<Vec<Finding>>,
}

impl Run<'_> {
    /// Remarks on values that are not plausible, once: when it is sure that the scene is not refused.
    pub fn remark(&self) {
        self.findings.take().iter().for_each(|finding| message::warn(&finding.to_string()));
    }

    /// The folder of the results is no longer where it was; `place` is where it is now, if that is known.
    pub fn gone(&self, place: Option<&Path>) -> Failure {
        let dir = self.dir.display();
        let head = format!("{dir}: results directory was renamed or removed during the run");
        // A run that has neither is not gone on with: it is begun again.
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

    /// Makes the folder of the results; of a run that is continued its files stay.
    ///
    /// # Errors
    /// The disk refuses.
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
