//! Helpers shared by `[solid]` tables.

use crate::model::tables;
use crate::scene::history::{History, TimeFunction};
use crate::scene::{SceneError, Table};

/// Resolves the `history` of a table.
pub fn time_function(history: Option<Table<History>>) -> Result<TimeFunction, SceneError> {
    let Some(h) = history else { return Ok(TimeFunction::CONSTANT) };
    let rows = h.file.as_ref().map(|f| tables::history(&h.locate(f), tables::FACTOR)).transpose()?;
    TimeFunction::new(&h, rows).map_err(|(key, problem)| h.problem(key, problem))
}
