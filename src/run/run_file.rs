//! `run.json`: origin of a run.

use serde::{Deserialize, Serialize};
use std::path::Path;
use trackbed_input::scene::{Document, IncludedText};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::write::{WriteError, atomic};

/// File name.
pub const FILE: &str = "run.json";

/// Earlier run, source of the initial state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source<'a> {
    /// Its results directory.
    pub dir: &'a Path,
    /// Whether only grains are imported.
    pub bed: bool,
}

/// Content of `run.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunFile {
    /// Program version.
    pub version: String,
    /// Scene file as on the command line.
    pub scene: String,
    /// Command-line overrides, key=value, in order.
    pub overrides: Vec<String>,
    /// Directory of the earlier run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Whether only its grains were imported.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub bed: bool,
    /// Scene text without overrides.
    pub text: String,
    /// Texts of included files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub included: Vec<IncludedText>,
}

impl RunFile {
    /// Describes a run.
    pub fn of(document: &Document, from: Option<Source<'_>>) -> RunFile {
        RunFile {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: document.file().display().to_string(),
            overrides: document.overrides().iter().map(|(key, value)| format!("{key}={value}")).collect(),
            from: from.map(|source| source.dir.display().to_string()),
            bed: from.is_some_and(|source| source.bed),
            text: document.text().into(),
            included: document.included_texts().collect(),
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// I/O errors.
    pub fn write(&self, dir: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Failure::Other(e.to_string()))?;
        let file = dir.join(FILE);
        atomic::write(&file, |out| {
            writeln!(out, "{text}").map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }

    /// Reads the file; none if unreadable.
    pub fn read(dir: &Path) -> Option<RunFile> {
        serde_json::from_slice(&source::bytes(&dir.join(FILE), source::LARGEST).ok()?).ok()
    }

    /// Whether results are of the same scene and overrides.
    pub fn is_of(&self, dir: &Path) -> bool {
        RunFile::read(dir).is_some_and(|other| {
            (&other.text, &other.overrides) == (&self.text, &self.overrides)
                && (&other.from, other.bed) == (&self.from, self.bed)
        })
    }

    /// Returns the earlier run.
    pub fn source(&self) -> Option<Source<'_>> {
        self.from.as_deref().map(|dir| Source { dir: Path::new(dir), bed: self.bed })
    }

    /// Returns the scene with overrides; none if not understood.
    pub fn document(&self) -> Option<Document> {
        let scene = Path::new(&self.scene);
        let mut document = Document::with_included(scene, self.text.clone(), self.included.clone()).ok()?;
        document.set_all(&self.overrides).ok()?;
        Some(document)
    }
}
