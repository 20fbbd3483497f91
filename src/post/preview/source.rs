//! Scene file of a preview, read again when it or a file that it names changes.

use std::path::{Path, PathBuf};

use trackbed_input::model::{self, Job};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::results::series;
use trackbed_run::{Hash, named_files};

const FILE: &str = "scene.toml";
/// Files of a results directory.
const RESULTS: [&str; 3] = [series::SERIES, "run.json", "summary.json"];

/// Whether a file is a scene.
pub fn is_scene(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

/// Returns the scene of a path: the file, or `scene.toml` in a directory without results.
pub fn scene_file(path: &Path) -> Option<PathBuf> {
    if !path.is_dir() {
        return is_scene(path).then(|| path.to_path_buf());
    }
    let results = RESULTS.iter().any(|name| path.join(name).exists());
    Some(path.join(FILE)).filter(|file| !results && file.is_file())
}

/// Scene file with overrides.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Scene file.
    pub file: PathBuf,
    /// Text in place of the file's.
    pub text: Option<String>,
    /// Overrides.
    pub set: Vec<String>,
}

impl Source {
    /// Scene file with overrides.
    pub fn new(file: &Path, set: &[String]) -> Source {
        Source { file: file.into(), text: None, set: set.into() }
    }

    /// Opens the file with overrides.
    ///
    /// # Errors
    /// Input errors.
    pub fn document(&self) -> Result<Document, Failure> {
        let mut document = Document::open_or(&self.file, self.text.as_deref())?;
        document.set_all(&self.set)?;
        Ok(document)
    }

    /// Returns notes about earlier names of keys and values.
    pub fn notes(&self) -> Vec<String> {
        self.document().map_or_else(|_| Vec::new(), |document| document.renamed())
    }

    /// Resolves the scene.
    ///
    /// # Errors
    /// Input errors.
    pub fn resolve(&self) -> Result<(Document, Job), Failure> {
        let document = self.document()?;
        let scene = model::read_scene(&document)?;
        let job = model::resolve(&document, &scene)?;
        Ok((document, job))
    }

    /// Returns the file and those that it names, as far as it can be read.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = vec![self.file.clone()];
        if let Ok(document) = self.document() {
            files.extend(document.included().map(|file| document.resolve(file)));
            if let Ok(scene) = document.scene() {
                files.extend(named_files(&document, &scene).iter().map(|file| document.resolve(file)));
            }
        }
        files
    }
}

/// Returns a number that changes with sizes and times of files.
pub fn version(files: &[PathBuf]) -> String {
    let mut hash = Hash::default();
    for file in files {
        let about = std::fs::metadata(file).ok();
        let time = about.as_ref().and_then(|m| m.modified().ok());
        hash.add(format!("{:?} {:?}", about.map(|m| m.len()), time).as_bytes());
    }
    hash.hex()
}
