//! What is wrong with a scene, and where.

use std::fmt;
use std::path::PathBuf;

/// Bad input in a scene: one sentence with file, line, key, what was found and what was expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// File that holds the mistake.
    pub file: PathBuf,
    /// Line, counted from 1, when it is known.
    pub line: Option<usize>,
    /// Path of the key, such as `solid.material.0.young`; empty when no key is to blame.
    pub key: String,
    /// What stands there.
    pub found: String,
    /// What should stand there.
    pub expected: String,
}

impl SceneError {
    /// An error in a `--set` argument.
    pub(super) fn override_(key: &str, found: &str, expected: &str) -> SceneError {
        SceneError {
            file: PathBuf::from("--set"),
            line: None,
            key: key.into(),
            found: found.into(),
            expected: expected.into(),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        if !self.key.is_empty() {
            write!(f, " {}:", self.key)?;
        }
        write!(f, " found {}, expected {}", self.found, self.expected)
    }
}

impl std::error::Error for SceneError {}
