//! ESRI ASCII grids (`.asc`) for geographic information systems.

use super::atomic;
use super::error::WriteError;
use std::path::Path;

/// Value of cells without data.
const NO_DATA: f64 = -9999.0;

/// Writes a grid.
///
/// `low`: lower left corner [m]; `cell`: side of a cell [m]; `values`: by cell, x fastest, from the south; `None` without data.
///
/// # Errors
/// I/O errors.
pub fn write_asc(
    file: &Path,
    (low, cell): ([f64; 2], f64),
    columns: usize,
    values: &[Option<f64>],
) -> Result<(), WriteError> {
    let rows = values.len() / columns.max(1);
    atomic::write(file, |out| {
        let mut lines =
            format!("ncols {columns}\nnrows {rows}\nxllcorner {}\nyllcorner {}\n", low[0], low[1]);
        lines += &format!("cellsize {cell}\nNODATA_value {NO_DATA}\n");
        for row in values.chunks_exact(columns.max(1)).rev() {
            let row: Vec<String> = row.iter().map(|v| v.unwrap_or(NO_DATA).to_string()).collect();
            lines += &row.join(" ");
            lines.push('\n');
        }
        out.write_all(lines.as_bytes()).map_err(|source| WriteError::Io { file: file.to_path_buf(), source })
    })
}
