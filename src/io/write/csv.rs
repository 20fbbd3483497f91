//! Time histories as CSV.

use serde::{Deserialize, Serialize};
use std::borrow::Borrow;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::atomic;
use super::error::WriteError;
use crate::columns::{Definition, Name};

/// Column of a history.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Quantity, such as `settlement`.
    pub name: String,
    /// SI unit, such as `m`; empty for dimensionless quantities.
    pub unit: String,
}

impl Column {
    /// Creates a column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { name: name.into(), unit: unit.into() }
    }

    /// Creates a defined column.
    pub fn of<'n>(name: impl Into<Name<'n>>) -> Self {
        let name = name.into();
        Column::new(name.to_string(), name.unit())
    }
}

/// Row under construction.
#[derive(Clone, Debug, Default)]
pub struct Row {
    columns: Option<Vec<Column>>,
    values: Vec<f64>,
}

impl Row {
    /// Collects the columns set by `fill`.
    pub fn columns_of(fill: impl FnOnce(&mut Row)) -> Vec<Column> {
        let mut row = Row { columns: Some(Vec::new()), values: Vec::new() };
        fill(&mut row);
        row.columns.unwrap_or_default()
    }

    /// Collects the values set by `fill`.
    pub fn values_of(fill: impl FnOnce(&mut Row)) -> Vec<f64> {
        let mut row = Row::default();
        fill(&mut row);
        row.values
    }

    /// Adds a column.
    pub fn put<'n>(&mut self, name: impl Into<Name<'n>>, value: f64) {
        if let Some(columns) = &mut self.columns {
            columns.push(Column::of(name));
        }
        self.values.push(value);
    }

    /// Adds the three columns of a vector.
    pub fn vector<'n>(&mut self, name: impl Into<Name<'n>>, value: impl Into<[f64; 3]>) {
        let name = name.into();
        for (axis, value) in value.into().into_iter().enumerate() {
            self.put(name.at(axis), value);
        }
    }

    /// Adds the six columns of a symmetric tensor.
    pub fn tensor<'n>(&mut self, name: impl Into<Name<'n>>, value: [f64; 6]) {
        let name = name.into();
        for (part, value) in value.into_iter().enumerate() {
            self.put(name.at(part), value);
        }
    }
}

/// Column of a table, and its value for an item.
pub type Field<T> = (&'static Definition, fn(&T) -> f64);

/// Writes one row per item.
///
/// # Errors
/// As [`History::row`].
pub fn write_table<T>(
    file: &Path,
    fields: &[Field<T>],
    items: impl IntoIterator<Item: Borrow<T>>,
) -> Result<(), WriteError> {
    let columns = fields.iter().map(|(column, _)| Column::of(*column)).collect();
    let mut table = History::create(file, columns)?;
    let mut row = Vec::with_capacity(fields.len());
    for item in items {
        row.clear();
        row.extend(fields.iter().map(|(_, value)| value(item.borrow())));
        table.row(&row)?;
    }
    Ok(())
}

const LINE: usize = 1 << 16;

/// Growing history file.
#[derive(Debug)]
pub struct History {
    file: PathBuf,
    columns: Vec<Column>,
    out: csv::Writer<File>,
    rows: usize,
    bytes: u64,
}

/// Position in a history, for a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    rows: usize,
    bytes: u64,
}

impl History {
    /// Creates `file` with a header.
    ///
    /// # Errors
    /// I/O errors.
    pub fn create(file: &Path, columns: Vec<Column>) -> Result<Self, WriteError> {
        let text = header(&columns);
        atomic::write(file, |out| out.write_all(&text).map_err(WriteError::io(file)))?;
        Self::open(file, columns, Mark { rows: 0, bytes: text.len() as u64 })
    }

    /// Resumes a history at a mark; later rows are truncated.
    ///
    /// # Errors
    /// Different columns, shorter file; I/O errors.
    pub fn resume(file: &Path, columns: Vec<Column>, mark: Mark) -> Result<Self, WriteError> {
        let head = header(&columns);
        let mut old = OpenOptions::new().read(true).write(true).open(file).map_err(WriteError::io(file))?;
        let length = old.metadata().map_err(WriteError::io(file))?.len();
        let mut found = vec![0; head.len().min(length as usize)];
        old.read_exact(&mut found).map_err(WriteError::io(file))?;
        if found != head {
            let head = String::from_utf8_lossy(&head);
            let message = format!("has other columns than this run, which writes {}", head.trim_end());
            return Err(WriteError::format(file, message));
        }
        let Mark { rows, bytes } = mark;
        let mut last = [0];
        if length >= bytes {
            old.seek(SeekFrom::Start(bytes - 1)).map_err(WriteError::io(file))?;
            old.read_exact(&mut last).map_err(WriteError::io(file))?;
        }
        if last != *b"\n" {
            let message = format!("is not the history of the checkpoint: {rows} rows in {bytes} bytes");
            return Err(WriteError::format(file, message));
        }
        old.set_len(bytes).map_err(WriteError::io(file))?;
        Self::open(file, columns, mark)
    }

    fn open(file: &Path, columns: Vec<Column>, mark: Mark) -> Result<Self, WriteError> {
        let out = OpenOptions::new().append(true).open(file).map_err(WriteError::io(file))?;
        let out = csv::WriterBuilder::new().buffer_capacity(LINE).from_writer(out);
        Ok(History { file: file.to_path_buf(), columns, out, rows: mark.rows, bytes: mark.bytes })
    }

    /// Syncs the history to disk and returns its position.
    ///
    /// # Errors
    /// I/O errors.
    pub fn mark(&self) -> Result<Mark, WriteError> {
        self.out.get_ref().sync_data().map_err(WriteError::io(&self.file))?;
        Ok(Mark { rows: self.rows, bytes: self.bytes })
    }

    /// Adds a row, visible to other programs on return.
    ///
    /// # Errors
    /// Wrong width or non-finite value (nothing is added); I/O errors.
    pub fn row(&mut self, values: &[f64]) -> Result<(), WriteError> {
        if values.len() != self.columns.len() {
            let (file, field) = (self.file.clone(), format!("row {}", self.rows));
            let (found, expected) = (values.len(), self.columns.len());
            return Err(WriteError::Length { file, field, found, expected });
        }
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            let (file, field) = (self.file.clone(), self.columns[at].name.clone());
            return Err(WriteError::NotFinite { file, field, index: self.rows, value: values[at] });
        }
        let cells: Vec<String> = values.iter().map(|v| number(*v)).collect();
        // One system call per row: no partial rows.
        let written = self.out.write_record(&cells).map_err(io::Error::from).and_then(|()| self.out.flush());
        written.map_err(WriteError::io(&self.file))?;
        self.rows += 1;
        self.bytes += cells.iter().map(|cell| cell.len() as u64 + 1).sum::<u64>();
        Ok(())
    }
}

fn number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if plain.len() <= scientific.len() + 4 { plain } else { scientific }
}

fn header(columns: &[Column]) -> Vec<u8> {
    let title = |c: &Column| match c.unit.as_str() {
        "" => c.name.clone(),
        unit => format!("{} [{unit}]", c.name),
    };
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record(columns.iter().map(title)).expect("memory takes every record of a first line");
    out.into_inner().expect("memory takes all that is buffered")
}

#[cfg(test)]
#[path = "csv_tests.rs"]
mod tests;
