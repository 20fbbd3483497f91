//! Histories for the plots of the page: columns of `history.csv`, `cycles.csv` and `push.csv`.

use std::path::Path;

use serde_json::json;

use super::chunk::{Chunk, Coding};
use crate::failure::Failure;

/// The tables that are plotted.
pub const TABLES: [&str; 3] = ["history", "cycles", "push"];
/// Rows that a plot gets at most: more than it has pixels.
const MOST: usize = 4000;

/// The block of a table: one array per column, rows left out evenly beyond a number that no plot can show; the last row of a
/// run that is being written may not be whole and is left out.
///
/// # Errors
/// The file cannot be read or holds words.
pub fn table(file: &Path) -> Result<Vec<u8>, Failure> {
    let bad = |what: String| Failure::Input(format!("{}: {what}", file.display()));
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).from_path(file).map_err(|e| bad(e.to_string()))?;
    let names: Vec<String> =
        reader.headers().map_err(|e| bad(e.to_string()))?.iter().map(String::from).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|e| bad(e.to_string()))?;
        if record.len() != names.len() {
            break;
        }
        for ((column, text), name) in columns.iter_mut().zip(&record).zip(&names) {
            let value = text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            let number = || bad(format!("line {}: {name}: found {text:?}, expected a number", row + 2));
            column.push(value.ok_or_else(number)?);
        }
    }
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
