//! Text file as rows of fields.
//!
//! Fields are separated by blanks, tabs or commas. Comments start with `!`, `#`, `/` or `*`; `!` and `#`
//! also after data.

use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::header::{self, Content};
use super::mesh_file::read_bytes;
use super::{number, unit};

const PAGE: usize = 15;

pub struct Row {
    /// Line number, from 1.
    pub line: usize,
    /// Byte offset.
    start: usize,
    fields: Vec<(usize, usize)>,
}

pub struct Table {
    pub file: PathBuf,
    pub rows: Vec<Row>,
    /// Unit other than metres in a comment above the rows.
    pub unit: Option<Box<ReadError>>,
    text: String,
}

impl Table {
    pub fn read(file: &Path, content: Content) -> Result<Table, ReadError> {
        let bytes = read_bytes(file, content.name())?;
        // Headers may use any 8-bit code page; data are ASCII.
        let text = String::from_utf8_lossy(&bytes).into_owned();
        Self::parse(file, content, text)
    }

    fn parse(file: &Path, content: Content, text: String) -> Result<Table, ReadError> {
        let mut rows: Vec<Row> = Vec::new();
        let mut unit = None;
        // Line of a banner whose column heading is pending.
        let mut page: Option<usize> = None;
        let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let mut offset = start;
        for (number, raw) in text[start..].split('\n').enumerate() {
            let (line, at) = (number + 1, offset);
            offset += raw.len() + 1;
            let body = raw.trim();
            if is_banner(body) {
                page = page.or(Some(line));
                continue;
            }
            if let Some(banner) = page {
                if line - banner > PAGE {
                    return Err(open_page(file, banner));
                }
                page = page.filter(|_| !header::is_heading(body, content));
                continue;
            }
            check_overflow(file, line, body, !rows.is_empty())?;
            if body.starts_with(['!', '#', '/', '*']) {
                if rows.is_empty() && unit.is_none() {
                    unit = unit::refusal(file, line, body).map(Box::new);
                }
                continue;
            }
            let body = body.split(['!', '#']).next().unwrap_or_default().trim();
            if body.is_empty() {
                continue;
            }
            if !number::looks_numeric(body) {
                match header::refusal(body, content) {
                    Some((key, found, expected)) => {
                        return Err(ReadError::at(file, line, key, found, expected));
                    }
                    None => continue,
                }
            }
            check_separators(file, line, body)?;
            let base = at + (body.as_ptr() as usize - raw.as_ptr() as usize);
            let fields = split(body, base).map_err(|column| {
                let key = format!("column {column}");
                ReadError::at(file, line, key, "nothing between two commas", "a number")
            })?;
            rows.push(Row { line, start: at, fields });
        }
        match page {
            Some(banner) => Err(open_page(file, banner)),
            None => Ok(Table { file: file.to_path_buf(), rows, unit, text }),
        }
    }

    pub fn fields<'a>(&'a self, row: &'a Row) -> impl ExactSizeIterator<Item = &'a str> + 'a {
        row.fields.iter().map(|f| &self.text[f.0..f.1])
    }

    pub fn field<'a>(&'a self, row: &Row, column: usize) -> &'a str {
        let (from, to) = row.fields[column];
        &self.text[from..to]
    }

    /// First and last column of a field in its line, from 0.
    pub fn extent(&self, row: &Row, column: usize) -> (usize, usize) {
        let (from, to) = row.fields[column];
        (from - row.start, to - row.start)
    }

    pub fn whole(&self, row: &Row, column: usize, key: &str) -> Result<u32, ReadError> {
        whole(&self.file, row.line, self.field(row, column), key)
    }

    pub fn real(&self, row: &Row, column: usize, key: &str) -> Result<f64, ReadError> {
        let text = self.field(row, column);
        let fault = |expected| ReadError::at(&self.file, row.line, key, format!("\"{text}\""), expected);
        let value = number::real(text).ok_or_else(|| fault("a number"))?;
        if value.is_finite() { Ok(value) } else { Err(fault("a finite number")) }
    }
}

impl Row {
    pub fn width(&self) -> usize {
        self.fields.len()
    }
}

pub fn whole(file: &Path, line: usize, text: &str, key: &str) -> Result<u32, ReadError> {
    number::whole(text)
        .ok_or_else(|| ReadError::at(file, line, key, format!("\"{text}\""), "a whole number of 0 or more"))
}

fn is_banner(body: &str) -> bool {
    let upper = body.to_ascii_uppercase();
    upper.starts_with("***") && ["ANALYSIS SYSTEM", "ANSYS", "MAPDL"].iter().any(|name| upper.contains(name))
}

fn open_page(file: &Path, banner: usize) -> ReadError {
    let found = format!("no column heading in the {PAGE} lines below it");
    ReadError::at(file, banner, "page of a listing", found, "a heading such as NODE LABEL REAL IMAG")
}

fn check_overflow(file: &Path, line: usize, body: &str, within: bool) -> Result<(), ReadError> {
    let tail = body.find('#').map(|at| &body[at..]).filter(|_| number::looks_numeric(body));
    let within = within && body.starts_with('*');
    match header::overflow(body, within).or_else(|| header::overflow(tail?, true)) {
        None => Ok(()),
        Some(found) => {
            let expected = "a number: its field was too narrow; comments begin with !";
            Err(ReadError::at(file, line, "row", format!("\"{found}\""), expected))
        }
    }
}

/// Rejects decimal commas and semicolons, which would split or join columns.
fn check_separators(file: &Path, line: usize, body: &str) -> Result<(), ReadError> {
    let fault = |found: &str, expected: &str| {
        let shown: String = found.chars().take(40).collect();
        Err(ReadError::at(file, line, "row", format!("\"{shown}\""), expected))
    };
    if body.contains(';') {
        return fault(body, "columns separated by blanks, tabs or commas, and a decimal point");
    }
    if !body.contains(',') {
        return Ok(());
    }
    let words: Vec<&str> = body.split_whitespace().collect();
    let separate = words.iter().any(|word| word.starts_with(',') || word.ends_with(','));
    let decimal = |word: &&&str| {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let parts = word.split_once(',').filter(|(_, behind)| !behind.contains([',', '.']));
        parts.is_some_and(|(front, behind)| {
            digit(front.chars().last()) && digit(behind.chars().next()) && !front.contains('.')
        })
    };
    match words.iter().find(decimal) {
        Some(word) if words.len() > 1 && !separate => fault(word, "a decimal point"),
        _ => Ok(()),
    }
}

/// Byte ranges of fields; the error is the number of an empty column.
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
#[path = "table_tests.rs"]
mod tests;
