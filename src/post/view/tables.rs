//! Plot data of `history.csv`, `cycles.csv` and `push.csv`.

use std::path::Path;

use serde_json::json;

use super::chunk::{Chunk, Coding};
use trackbed_io::failure::Failure;
use trackbed_io::results::tables::Table;

pub const TABLES: [&str; 3] = ["history", "cycles", "push"];
/// Most rows of a plot: more than its pixels.
const MOST: usize = 4000;

/// Table block: one array per column, rows thinned evenly.
///
/// # Errors
/// Unreadable file, no header.
pub fn table(file: &Path) -> Result<Vec<u8>, Failure> {
    let Table { names, columns, .. } = Table::read(file)?.unwrap_or_default();
    let rows = columns.first().map_or(0, Vec::len);
    let step = rows.div_ceil(MOST).max(1);
    let mut chunk = Chunk::new(Coding::Exact);
    chunk.meta("columns", json!(names));
    for (k, column) in columns.iter().enumerate() {
        let last = column.last().filter(|_| rows > 1 && !(rows - 1).is_multiple_of(step));
        let thin: Vec<f64> = column.iter().step_by(step).chain(last).copied().collect();
        chunk.exact(&format!("{k}"), &thin, 1);
    }
    Ok(chunk.finish())
}
