//! `run.json`: what a run is of, so that its results can be read without the scene at hand, and while it goes on.

use crate::failure::Failure;
use crate::read::source;
use crate::scene::Document;
use crate::write::{WriteError, atomic};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file.
pub const FILE: &str = "run.json";

/// The run from whose end another goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source<'a> {
    /// Folder of its results.
    pub dir: &'a Path,
    /// Only its bed is taken, into another model.
    pub bed: bool,
}

/// The content of `run.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunFile {
    /// Version of the program.
    pub version: String,
    /// The scene file, as it was named on the command line.
    pub scene: String,
    /// Keys overridden on the command line, as key=value, in order.
    pub overrides: Vec<String>,
    /// Folder of the run from whose end this one went on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Whether only its bed was taken.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub bed: bool,
    /// Text of the scene file, without the overrides.
    pub text: String,
}

impl RunFile {
    /// Of a scene that is run.
    pub fn of(document: &Document, from: Option<Source<'_>>) -> RunFile {
        RunFile {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: document.file().display().to_string(),
            overrides: document.overrides().iter().map(|(key, value)| format!("{key}={value}")).collect(),
            from: from.map(|source| source.dir.display().to_string()),
            bed: from.is_some_and(|source| source.bed),
            text: document.text().into(),
        }
    }

    /// Writes it in a folder of results.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn write(&self, dir: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Failure::Other(e.to_string()))?;
        let file = dir.join(FILE);
        atomic::write(&file, |out| {
            writeln!(out, "{text}").map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }

    /// The one in a folder of results; none where there is none that can be read.
    pub fn read(dir: &Path) -> Option<RunFile> {
        serde_json::from_slice(&source::bytes(&dir.join(FILE), source::LARGEST).ok()?).ok()
    }

    /// Whether the results in a folder are of the same scene, with the same overrides.
    pub fn is_of(&self, dir: &Path) -> bool {
        RunFile::read(dir).is_some_and(|other| {
            (&other.text, &other.overrides) == (&self.text, &self.overrides)
                && (&other.from, other.bed) == (&self.from, self.bed)
        })
    }

    /// The run that this one went on from.
    pub fn source(&self) -> Option<Source<'_>> {
        self.from.as_deref().map(|dir| Source { dir: Path::new(dir), bed: self.bed })
    }

    /// The scene with its overrides; none where this program does not understand it.
    pub fn document(&self) -> Option<Document> {
        let mut document = Document::parse(Path::new(&self.scene), self.text.clone()).ok()?;
        self.overrides.iter().try_for_each(|o| document.set(o)).ok()?;
        Some(document)
    }
}
