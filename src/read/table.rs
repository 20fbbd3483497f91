//! A text file as rows of fields: what is common to the three lists.
//!
//! Fields are separated by blanks, tabs or commas. Left out are empty lines, comments (a line that starts
//! with `!`, `#`, `/` or `*`, and the rest of a line after `!` or `#`) and headers: lines whose first field
//! does not start as a number does. Below the first row of numbers a header that holds numbers of its own is
//! taken only as a repeat of an earlier one (page titles of a listing); anything else there is more likely a
//! damaged row, and an error.

use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::mesh_file::read_bytes;
use super::number;

/// One line of a file that holds data.
pub struct Row {
    /// Line number, from 1.
    pub line: usize,
    fields: Vec<(usize, usize)>,
}

/// The rows of a file.
pub struct Table {
    /// The file.
    pub file: PathBuf,
    /// Its lines with data, in file order.
    pub rows: Vec<Row>,
    /// Headers left out although they hold numbers, as sentences for the user.
    pub warnings: Vec<String>,
    text: String,
}

impl Table {
    /// Reads `file`; `what` names its content in messages.
    pub fn read(file: &Path, what: &str) -> Result<Table, ReadError> {
        let bytes = read_bytes(file, what)?;
        // Headers may hold any 8-bit code page; the data are ASCII.
        let text = String::from_utf8_lossy(&bytes).into_owned();
        Self::parse(file, what, text)
    }

    fn parse(file: &Path, what: &str, text: String) -> Result<Table, ReadError> {
        let mut rows: Vec<Row> = Vec::new();
        let mut headers: Vec<&str> = Vec::new();
        let mut warnings = Vec::new();
        let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let mut offset = start;
        for (number, raw) in text[start..].split('\n').enumerate() {
            let (line, at) = (number + 1, offset);
            offset += raw.len() + 1;
            let body = raw.trim_start();
            if body.starts_with(['!', '#', '/', '*']) {
                continue;
            }
            let body = body.split(['!', '#']).next().unwrap_or_default().trim();
            if body.is_empty() {
                continue;
            }
            let base = at + (body.as_ptr() as usize - raw.as_ptr() as usize);
            let fields = split(body, base).map_err(|column| {
                let key = format!("column {column}");
                ReadError::at(file, line, key, "nothing between two commas", "a number")
            })?;
            let field = |f: &(usize, usize)| &text[f.0..f.1];
            if fields.first().is_some_and(|f| number::looks_numeric(field(f))) {
                rows.push(Row { line, fields });
                continue;
            }
            if fields.iter().any(|f| number::looks_numeric(field(f))) && !headers.contains(&body) {
                if !rows.is_empty() {
                    let found = format!("\"{}\"", fields.first().map_or("", field));
                    return Err(ReadError::at(file, line, what, found, "a number"));
                }
                warnings
                    .push(format!("{}:{line}: taken as a header and left out: \"{body}\"", file.display()));
            }
            headers.push(body);
        }
        Ok(Table { file: file.to_path_buf(), rows, warnings, text })
    }

    /// The fields of a row.
    pub fn fields<'a>(&'a self, row: &'a Row) -> impl ExactSizeIterator<Item = &'a str> + 'a {
        row.fields.iter().map(|f| &self.text[f.0..f.1])
    }

    /// Field `column` of a row.
    pub fn field<'a>(&'a self, row: &Row, column: usize) -> &'a str {
        let (from, to) = row.fields[column];
        &self.text[from..to]
    }

    /// Field `column` of a row as an identifier.
    pub fn whole(&self, row: &Row, column: usize, key: &str) -> Result<u32, ReadError> {
        whole(&self.file, row.line, self.field(row, column), key)
    }

    /// Field `column` of a row as a finite real.
    pub fn real(&self, row: &Row, column: usize, key: &str) -> Result<f64, ReadError> {
        let text = self.field(row, column);
        let fault = |expected| ReadError::at(&self.file, row.line, key, format!("\"{text}\""), expected);
        let value = number::real(text).ok_or_else(|| fault("a number"))?;
        if value.is_finite() { Ok(value) } else { Err(fault("a finite number")) }
    }
}

impl Row {
    /// Number of fields.
    pub fn width(&self) -> usize {
        self.fields.len()
    }
}

/// A field as an identifier.
pub fn whole(file: &Path, line: usize, text: &str, key: &str) -> Result<u32, ReadError> {
    number::whole(text)
        .ok_or_else(|| ReadError::at(file, line, key, format!("\"{text}\""), "a whole number of 0 or more"))
}

/// Byte ranges of the fields of a trimmed line; the error is the number of a column left empty between
/// commas. A comma at the end of the line closes its last field.
fn split(body: &str, base: usize) -> Result<Vec<(usize, usize)>, usize> {
    let mut fields = Vec::new();
    let mut at = 0;
    let pieces = body.strip_suffix(',').unwrap_or(body);
    for piece in pieces.split(',') {
        let before = fields.len();
        let mut word = None;
        for (i, c) in piece.char_indices().chain([(piece.len(), ' ')]) {
            match (c.is_whitespace(), word) {
                (false, None) => word = Some(i),
                (true, Some(from)) => {
                    fields.push((base + at + from, base + at + i));
                    word = None;
                }
                _ => {}
            }
        }
        if fields.len() == before {
            return Err(before + 1);
        }
        at += piece.len() + 1;
    }
    Ok(fields)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Result<Vec<(usize, Vec<String>)>, ReadError> {
        let table = Table::parse(Path::new("F.DAT"), "rows", text.to_string())?;
        Ok(table.rows.iter().map(|r| (r.line, table.fields(r).map(String::from).collect())).collect())
    }

    fn row(line: usize, fields: &[&str]) -> (usize, Vec<String>) {
        (line, fields.iter().map(|f| f.to_string()).collect())
    }

    #[test]
    fn separators_line_ends_comments_and_the_byte_order_mark() {
        let text = "\u{feff}! c\r\n# c\r\n/PREP7\r\n*** c\r\n\r\n 1, 2.0 ,3\t4 \r\n5 6 ! rest\n7,8,\n\n9";
        let expected =
            vec![row(6, &["1", "2.0", "3", "4"]), row(7, &["5", "6"]), row(8, &["7", "8"]), row(10, &["9"])];
        assert_eq!(rows(text).unwrap(), expected);
    }

    #[test]
    fn headers_and_their_repeats_are_left_out() {
        let text = "LIST 3 NODES\nNODE X\n1 2\nNODE X\nLIST 3 NODES\n---\n3 4\n";
        assert_eq!(rows(text).unwrap(), vec![row(3, &["1", "2"]), row(7, &["3", "4"])]);
        let table = Table::parse(Path::new("F.DAT"), "rows", text.to_string()).unwrap();
        assert_eq!(table.warnings, ["F.DAT:1: taken as a header and left out: \"LIST 3 NODES\""]);
    }

    #[test]
    fn a_damaged_row_is_no_header() {
        let error = rows("1 2\nO3 4\n").unwrap_err();
        assert_eq!(error.to_string(), "F.DAT:2: rows: found \"O3\", expected a number");
    }

    #[test]
    fn an_empty_field_between_commas_is_named() {
        let error = rows("1,2\n3,,4\n").unwrap_err();
        assert_eq!(
            error.to_string(),
            "F.DAT:2: column 2: found nothing between two commas, expected a number"
        );
    }
}
