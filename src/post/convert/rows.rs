//! Numeric rows below headers.

use std::path::Path;
use trackbed_io::read::ReadError;
use trackbed_io::read::number;

/// Numbers of a line, separated by blanks, tabs or commas.
///
/// # Errors
/// Fields that are not finite numbers.
pub fn numbers(file: &Path, line: usize, text: &str) -> Result<Vec<f64>, ReadError> {
    let fields = text.split(|c: char| c.is_whitespace() || c == ',').filter(|f| !f.is_empty());
    let value = |field: &str| {
        number::real(field)
            .filter(|v| v.is_finite())
            .ok_or_else(|| ReadError::at(file, line, "number", format!("\"{field}\""), "a finite number"))
    };
    fields.map(value).collect()
}

/// Block of a file.
pub struct Block {
    /// Line of the header.
    pub line: usize,
    /// Time or step.
    pub time: f64,
    /// Rows with their lines.
    pub rows: Vec<(usize, Vec<f64>)>,
}

/// Splits text into blocks below `head` lines with row counts.
///
/// # Errors
/// Damaged headers, wrong row counts or widths.
pub fn blocks(file: &Path, text: &str, head: &str, widths: [usize; 2]) -> Result<Vec<Block>, ReadError> {
    let mut blocks: Vec<(Block, usize)> = Vec::new();
    for (line, body) in text.lines().enumerate().map(|(k, l)| (k + 1, l.trim())) {
        if body.is_empty() {
            continue;
        }
        if body.get(..head.len()).is_some_and(|h| h.eq_ignore_ascii_case(head)) {
            if let Some((block, count)) = blocks.last() {
                complete(file, block, *count)?;
            }
            let values = numbers(file, line, &body[head.len()..])?;
            let counted = |n: f64| n >= 0.0 && n.fract() == 0.0 && n <= f64::from(u32::MAX);
            let [time, count] = values[..] else {
                let found = format!("{} numbers", values.len());
                return Err(ReadError::at(file, line, head, found, "time and number of rows"));
            };
            if !counted(count) {
                return Err(ReadError::at(file, line, "number of rows", count.to_string(), "a whole number"));
            }
            blocks.push((Block { line, time, rows: Vec::new() }, count as usize));
            continue;
        }
        let Some((block, count)) = blocks.last_mut() else {
            return Err(ReadError::at(file, line, "row", "one before the first head", format!("\"{head}\"")));
        };
        if block.rows.len() == *count {
            let expected = format!("\"{head}\" after {count} rows");
            return Err(ReadError::at(file, line, "row", "one more", expected));
        }
        let values = numbers(file, line, body)?;
        if !widths.contains(&values.len()) {
            let expected = format!("{} or {}", widths[0], widths[1]);
            return Err(ReadError::at(file, line, "columns", values.len().to_string(), expected));
        }
        block.rows.push((line, values));
    }
    if let Some((block, count)) = blocks.last() {
        complete(file, block, *count)?;
    }
    Ok(blocks.into_iter().map(|(block, _)| block).collect())
}

fn complete(file: &Path, block: &Block, count: usize) -> Result<(), ReadError> {
    if block.rows.len() == count {
        return Ok(());
    }
    let expected = format!("{count}, as in the header");
    Err(ReadError::at(file, block.line, "rows", block.rows.len().to_string(), expected))
}
