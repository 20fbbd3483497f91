//! Histories as comma-separated values: a header with units, then rows as the run goes.
//!
//! Numbers are written in Rust's shortest form that reads back to the same bits. The first column is what the
//! rows are ordered by (time or cycle).

use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::atomic;
use super::error::WriteError;

/// A column of a history.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// What it is, such as `settlement`.
    pub name: String,
    /// Its SI unit, such as `m`; empty for a count or a ratio without one.
    pub unit: String,
}

impl Column {
    /// A column with its unit.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { name: name.into(), unit: unit.into() }
    }
}

/// A history file that grows.
#[derive(Debug)]
pub struct History {
    file: PathBuf,
    columns: Vec<Column>,
    out: File,
    rows: usize,
    bytes: u64,
}

/// How far a history has come, for a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    rows: usize,
    bytes: u64,
}

impl History {
    /// Starts `file` with a header.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn create(file: &Path, columns: Vec<Column>) -> Result<Self, WriteError> {
        let text = header(&columns) + "\n";
        atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))?;
        Self::open(file, columns, Mark { rows: 0, bytes: text.len() as u64 })
    }

    /// Takes up the history of an earlier run at a mark; what was written after it is cut off.
    ///
    /// # Errors
    /// The file has other columns, or less than was there at the mark; what the system refuses.
    pub fn resume(file: &Path, columns: Vec<Column>, mark: Mark) -> Result<Self, WriteError> {
        let head = header(&columns) + "\n";
        let mut old = OpenOptions::new().read(true).write(true).open(file).map_err(WriteError::io(file))?;
        let length = old.metadata().map_err(WriteError::io(file))?.len();
        let mut found = vec![0; head.len().min(length as usize)];
        old.read_exact(&mut found).map_err(WriteError::io(file))?;
        if found != head.as_bytes() {
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
            let message =
                format!("is not the history that the checkpoint goes on from: {rows} rows in {bytes} bytes");
            return Err(WriteError::format(file, message));
        }
        old.set_len(bytes).map_err(WriteError::io(file))?;
        Self::open(file, columns, mark)
    }

    fn open(file: &Path, columns: Vec<Column>, mark: Mark) -> Result<Self, WriteError> {
        let out = OpenOptions::new().append(true).open(file).map_err(WriteError::io(file))?;
        Ok(History { file: file.to_path_buf(), columns, out, rows: mark.rows, bytes: mark.bytes })
    }

    /// How far the history has come. All of it is on the disk, whatever happens to the machine, when this returns.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn mark(&self) -> Result<Mark, WriteError> {
        self.out.sync_data().map_err(WriteError::io(&self.file))?;
        Ok(Mark { rows: self.rows, bytes: self.bytes })
    }

    /// Adds a row, which is on disk for other programs to read when this returns.
    ///
    /// # Errors
    /// A row of another width or with a number that is not finite (named by its column; nothing is added),
    /// and what the system refuses.
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
        let mut line = values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(",");
        line.push('\n');
        // One call per row: a row is there whole or not at all.
        self.out.write_all(line.as_bytes()).map_err(WriteError::io(&self.file))?;
        self.rows += 1;
        self.bytes += line.len() as u64;
        Ok(())
    }
}

/// The shorter of the two forms that read back to the same bits.
fn number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if plain.len() <= scientific.len() + 4 { plain } else { scientific }
}

fn header(columns: &[Column]) -> String {
    let title = |c: &Column| {
        let text = if c.unit.is_empty() { c.name.clone() } else { format!("{} [{}]", c.name, c.unit) };
        if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
    };
    columns.iter().map(title).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample::folder;

    fn columns() -> Vec<Column> {
        vec![Column::new("time", "s"), Column::new("settlement", "m"), Column::new("a, b", "")]
    }

    #[test]
    fn rows_are_on_disk_at_once_and_keep_their_bits() {
        let dir = folder("csv");
        let file = dir.join("history.csv");
        let mut history = History::create(&file, columns()).unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "time [s],settlement [m],\"a, b\"\n");
        let values = [0.1 + 0.2, -1.0e-300, f64::MAX, 1.0 / 3.0, 5.0e-324, -0.0, 12345678.9, 1e15, 2.5e-7];
        for row in values.chunks(3) {
            history.row(row).unwrap();
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let back: Vec<u64> = text
            .lines()
            .skip(1)
            .flat_map(|row| row.split(','))
            .map(|v| v.parse::<f64>().unwrap().to_bits())
            .collect();
        assert_eq!(back, values.map(f64::to_bits));
        assert!(text.lines().all(|row| row.len() < 90), "no number takes 300 digits: {text}");
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn a_value_that_is_not_finite_is_named_and_its_row_left_out() {
        let dir = folder("csv_nan");
        let file = dir.join("history.csv");
        let mut history = History::create(&file, columns()).unwrap();
        history.row(&[0.0, 1.0, 2.0]).unwrap();
        let error = history.row(&[0.5, f64::NAN, 2.0]).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("{}: settlement at index 1 is NaN: not written", file.display())
        );
        assert!(history.row(&[0.5, 1.0]).unwrap_err().to_string().contains("row 1 has 2 values, expected 3"));
        assert_eq!(std::fs::read_to_string(&file).unwrap().lines().count(), 2);
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn a_resumed_history_is_the_one_of_a_run_without_a_break() {
        let dir = folder("csv_resume");
        let file = dir.join("history.csv");
        let row = |i: u32| [0.1 * f64::from(i), f64::from(i), 0.25];
        let mut whole = History::create(&file, columns()).unwrap();
        let start = whole.mark().unwrap();
        (0..3).for_each(|i| whole.row(&row(i)).unwrap());
        let mark = whole.mark().unwrap();
        (3..6).for_each(|i| whole.row(&row(i)).unwrap());
        let expected = std::fs::read_to_string(&file).unwrap();
        // Later rows already written, the last cut short; then nothing beyond the mark; then nothing at all.
        for (left, mark, first) in
            [(expected.len() - 4, mark, 3), (mark.bytes as usize, mark, 3), (40, start, 0)]
        {
            std::fs::write(&file, &expected[..left]).unwrap();
            let mut second = History::resume(&file, columns(), mark).unwrap();
            (first..6).for_each(|i| second.row(&row(i)).unwrap());
            assert_eq!(std::fs::read_to_string(&file).unwrap(), expected);
            assert_eq!(second.mark().unwrap(), Mark { rows: 6, bytes: expected.len() as u64 });
        }

        let error = History::resume(&file, columns()[..2].to_vec(), mark).unwrap_err();
        assert!(error.to_string().contains("has other columns"), "{error}");
        for wrong in [&expected[..mark.bytes as usize - 1], &expected.replace("0.1,", "0.123,")] {
            std::fs::write(&file, wrong).unwrap();
            let error = History::resume(&file, columns(), mark).unwrap_err();
            assert!(error.to_string().contains("is not the history"), "{error}");
        }
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
