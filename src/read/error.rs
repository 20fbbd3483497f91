//! What a reader says about a file that it cannot take.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::message::shown;

/// Longest name or value of a file in a message [characters].
const LONGEST: usize = 300;
/// Longest list of what was expected [characters].
const LONGEST_LIST: usize = 1000;

/// One fault in an input file, printed as one sentence:
/// `NODECOORD.DAT:17: coordinate y: found "1.2.3", expected a number`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ReadError {
    /// The file.
    pub file: PathBuf,
    /// Line number, counted from 1; `None` where the fault is in no single line.
    pub line: Option<usize>,
    /// The field or item at fault, in the words of the file's documentation.
    pub key: String,
    /// What stands in the file.
    pub found: String,
    /// What belongs there.
    pub expected: String,
}

impl ReadError {
    /// A fault at a line of `file`.
    pub(crate) fn at(
        file: &Path,
        line: usize,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let (key, found, expected) = (key.into(), found.into(), expected.into());
        ReadError { file: file.to_path_buf(), line: Some(line), key, found, expected }
    }

    /// A fault of `file` as a whole.
    pub(crate) fn whole(
        file: &Path,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let (key, found, expected) = (key.into(), found.into(), expected.into());
        ReadError { file: file.to_path_buf(), line: None, key, found, expected }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        let (key, found) = (shown(&self.key, LONGEST), shown(&self.found, LONGEST));
        let expected = shown(&self.expected, LONGEST_LIST);
        write!(f, " {key}: found {found}, expected {expected}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_one_sentence_with_file_line_field_found_and_expected() {
        let file = Path::new("NODECOORD.DAT");
        let at = ReadError::at(file, 17, "coordinate y", "\"1.2.3\"", "a number");
        assert_eq!(at.to_string(), "NODECOORD.DAT:17: coordinate y: found \"1.2.3\", expected a number");
        let whole = ReadError::whole(file, "nodes", "none", "at least one");
        assert_eq!(whole.to_string(), "NODECOORD.DAT: nodes: found none, expected at least one");
    }
}
