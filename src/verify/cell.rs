//! Results of programs.

use super::plan::Row;
use serde::Serialize;

/// Result of a program for a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "snake_case")]
pub enum Cell {
    /// Computed.
    Computed {
        /// Value, in the unit of the quantity.
        value: f64,
        /// Error: relative, or a difference with an absolute norm.
        error: f64,
        /// Whether the error is within the tolerance.
        passed: bool,
        /// Wall time [s]; of trackbed with start and output, shared by rows of one run.
        seconds: f64,
    },
    /// Not modelled.
    NotModelled {
        /// Reason.
        reason: String,
    },
    /// Program not available, or not asked for.
    Skipped,
    /// Without a value.
    Failed {
        /// Reason.
        reason: String,
    },
}

impl Cell {
    /// Compares a value with the reference.
    pub fn of(row: &Row, value: f64, seconds: f64) -> Cell {
        let error = row.error(value);
        Cell::Computed { value, error, passed: row.passes(error), seconds }
    }

    /// Whether a value is within the tolerance; none without a value, except after a failure.
    pub fn passed(&self) -> Option<bool> {
        match self {
            Cell::Computed { passed, .. } => Some(*passed),
            Cell::Failed { .. } => Some(false),
            Cell::NotModelled { .. } | Cell::Skipped => None,
        }
    }

    /// Wall time [s].
    pub fn seconds(&self) -> f64 {
        match self {
            Cell::Computed { seconds, .. } => *seconds,
            _ => 0.0,
        }
    }
}

/// Column of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Name in tables.
    pub title: String,
    /// This program.
    pub own: bool,
    /// Version; none if not available.
    pub version: Option<String>,
    /// Reason why it is not available.
    pub missing: Option<String>,
    /// Results by row.
    pub cells: Vec<Cell>,
}

impl Column {
    /// Number of rows within tolerance, and of rows with a result.
    pub fn score(&self) -> (usize, usize) {
        let known: Vec<bool> = self.cells.iter().filter_map(Cell::passed).collect();
        (known.iter().filter(|passed| **passed).count(), known.len())
    }
}
