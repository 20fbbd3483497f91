//! Error messages of input files and scenes.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::message::shown;

/// Longest name or value in a message [characters].
const LONGEST: usize = 300;
/// Longest list of expected values [characters].
const LONGEST_LIST: usize = 1000;

/// Problem of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Problem {
    /// Value not allowed: `found X, expected Y`.
    Value {
        /// Value in the file.
        found: Box<str>,
        /// Noun phrase for the allowed values.
        expected: Box<str>,
    },
    /// Key that excludes another: `found together with Z, expected only one of them`.
    Conflict {
        /// Other key or table.
        with: Box<str>,
    },
    /// Key that requires another: `found without Z, expected both`.
    Requirement {
        /// Missing key or table.
        without: Box<str>,
    },
    /// Key without effect: `found, but it has no effect without Z`.
    NoEffect {
        /// Key, table or value that gives it effect.
        without: Box<str>,
    },
    /// Missing key: `found nothing, expected Y`.
    Missing {
        /// Noun phrase for the value.
        expected: Box<str>,
    },
}

impl Problem {
    /// Creates an error of a value.
    pub fn value(found: impl Into<String>, expected: impl Into<String>) -> Problem {
        Problem::Value { found: found.into().into(), expected: expected.into().into() }
    }

    /// Creates a conflict of two keys.
    pub fn conflict(with: impl Into<String>) -> Problem {
        Problem::Conflict { with: with.into().into() }
    }

    /// Creates a missing requirement.
    pub fn requirement(without: impl Into<String>) -> Problem {
        Problem::Requirement { without: without.into().into() }
    }

    /// Creates an error of a key without effect.
    pub fn no_effect(without: impl Into<String>) -> Problem {
        Problem::NoEffect { without: without.into().into() }
    }

    /// Creates an error of a missing key.
    pub fn missing(expected: impl Into<String>) -> Problem {
        Problem::Missing { expected: expected.into().into() }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Problem::Value { found, expected } => {
                write!(f, "found {}, expected {}", shown(found, LONGEST), shown(expected, LONGEST_LIST))
            }
            Problem::Conflict { with } => {
                write!(f, "found together with {}, expected only one of them", shown(with, LONGEST))
            }
            Problem::Requirement { without } => {
                write!(f, "found without {}, expected both", shown(without, LONGEST))
            }
            Problem::NoEffect { without } => {
                write!(f, "found, but it has no effect without {}", shown(without, LONGEST_LIST))
            }
            Problem::Missing { expected } => {
                write!(f, "found nothing, expected {}", shown(expected, LONGEST_LIST))
            }
        }
    }
}

/// Input error, printed as one line: `FILE:LINE: key: found X, expected Y. Remedy.`
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ReadError {
    /// Path of the file.
    pub file: PathBuf,
    /// Line number from 1; `None` if several lines are concerned.
    pub line: Option<usize>,
    /// Field or item, named as in the documentation.
    pub key: String,
    /// Problem of the key.
    pub problem: Problem,
    /// Remedy without full stop; `None` if obvious.
    pub remedy: Option<Box<str>>,
}

impl ReadError {
    /// Adds a remedy, a sentence without full stop.
    #[must_use]
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        ReadError { remedy: Some(remedy.into().into()), ..self }
    }

    /// Creates an error at a line.
    pub fn at(
        file: &Path,
        line: usize,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let problem = Problem::value(found, expected);
        ReadError { file: file.to_path_buf(), line: Some(line), key: key.into(), problem, remedy: None }
    }

    /// Creates an error of the whole file.
    pub fn whole(
        file: &Path,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let problem = Problem::value(found, expected);
        ReadError { file: file.to_path_buf(), line: None, key: key.into(), problem, remedy: None }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}: {}", shown(&self.key, LONGEST), self.problem)?;
        match &self.remedy {
            Some(remedy) => write!(f, ". {}.", shown(remedy, LONGEST)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_error_as_one_line() {
        let file = Path::new("NODECOORD.DAT");
        let at = ReadError::at(file, 17, "coordinate y", "\"1.2.3\"", "a number");
        assert_eq!(at.to_string(), "NODECOORD.DAT:17: coordinate y: found \"1.2.3\", expected a number");
        let whole = ReadError::whole(file, "nodes", "none", "at least one");
        assert_eq!(whole.to_string(), "NODECOORD.DAT: nodes: found none, expected at least one");
        assert_eq!(
            whole.remedy("Export the nodes").to_string(),
            "NODECOORD.DAT: nodes: found none, expected at least one. Export the nodes."
        );
    }

    #[test]
    fn forms_of_problems() {
        for (problem, sentence) in [
            (Problem::conflict("`at`"), "found together with `at`, expected only one of them"),
            (Problem::requirement("`young`"), "found without `young`, expected both"),
            (Problem::no_effect("[solid]"), "found, but it has no effect without [solid]"),
            (Problem::missing("a mass"), "found nothing, expected a mass"),
        ] {
            assert_eq!(problem.to_string(), sentence);
        }
    }
}
