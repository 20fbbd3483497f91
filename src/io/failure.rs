//! Failures and exit codes.

use crate::read::ReadError;
use crate::system;
use std::fmt;

/// Failure of a command.
#[derive(Debug)]
pub enum Failure {
    /// Input error: exit code 2. A sentence with file, line, key, found and expected.
    Input(String),
    /// Input errors of keys or file positions: exit code 2, as [`Failure::Input`].
    Faults(Vec<ReadError>),
    /// Numerical failure: exit code 3. Cause, place, time.
    Numerical(String),
    /// Interrupted after a checkpoint: exit code 130. Position and resume command.
    Interrupted(String),
    /// Other errors: exit code 1.
    Other(String),
}

impl Failure {
    /// Returns the exit code.
    pub fn code(&self) -> u8 {
        match self {
            Failure::Input(_) | Failure::Faults(_) => 2,
            Failure::Numerical(_) => 3,
            Failure::Interrupted(_) => 130,
            Failure::Other(_) => 1,
        }
    }

    /// Whether the input is invalid.
    pub fn is_input(&self) -> bool {
        matches!(self, Failure::Input(_) | Failure::Faults(_))
    }

    /// Returns one sentence per error.
    pub fn sentences(&self) -> Vec<String> {
        match self {
            Failure::Faults(faults) => faults.iter().map(ToString::to_string).collect(),
            other => vec![other.to_string()],
        }
    }

    /// Failure to start a thread.
    pub fn thread(error: impl fmt::Display) -> Failure {
        let expected = "memory and processes for all. Reduce --threads, or raise the system limits (ulimit -v, ulimit -u)";
        Failure::Numerical(format!(
            "threads: found a thread that cannot be started ({error}), expected {expected}"
        ))
    }

    /// Adds the stage to a numerical failure.
    #[must_use]
    pub fn in_stage(self, stage: &str) -> Failure {
        match self {
            Failure::Numerical(text) => Failure::Numerical(format!("{stage}: {text}")),
            other => other,
        }
    }

    /// Adds `time` [s] to a numerical failure.
    #[must_use]
    pub fn at(self, time: f64) -> Failure {
        match self {
            Failure::Numerical(text) => Failure::Numerical(format!("at t = {time:.6e} s: {text}")),
            other => other,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Input(text)
            | Failure::Numerical(text)
            | Failure::Interrupted(text)
            | Failure::Other(text) => f.write_str(text),
            Failure::Faults(_) => f.write_str(&self.sentences().join("; ")),
        }
    }
}

impl std::error::Error for Failure {}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Failure {
        Failure::Faults(vec![error])
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Failure {
        Failure::Other(system::words(&error))
    }
}

impl From<crate::write::WriteError> for Failure {
    fn from(error: crate::write::WriteError) -> Failure {
        match error {
            crate::write::WriteError::NotFinite { .. } => Failure::Numerical(error.to_string()),
            _ => Failure::Other(error.to_string()),
        }
    }
}
