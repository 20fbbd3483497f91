//! What several tables of `[solid]` share.

use crate::model::tables;
use crate::scene::history::{History, TimeFunction};
use crate::scene::{Document, SceneError};

/// Refuses a value that is not `good`.
pub fn check(
    document: &Document,
    key: &str,
    value: f64,
    good: bool,
    expected: &str,
) -> Result<(), SceneError> {
    if good { Ok(()) } else { Err(document.error(key, value.to_string(), expected)) }
}

/// Resolves the `history` of the table at `path`.
pub fn time_function(
    document: &Document,
    path: &str,
    history: Option<&History>,
) -> Result<TimeFunction, SceneError> {
    match history {
        None => Ok(TimeFunction::CONSTANT),
        Some(h) => {
            let rows = h.file.as_ref().map(|f| tables::history(&document.resolve(f))).transpose()?;
            TimeFunction::new(h, rows).map_err(|(k, found, expected)| {
                document.error(&format!("{path}.history.{k}"), found, expected)
            })
        }
    }
}
