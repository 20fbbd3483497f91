//! Tables of a run: `history.csv`, `cycles.csv`, `push.csv`.

use std::path::Path;

use crate::failure::Failure;

/// Columns with their names.
pub struct Table {
    /// Names, with units in brackets.
    pub names: Vec<String>,
    /// Numbers of each column.
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table; the last row of a run that is being written may not be whole and is left out.
    ///
    /// # Errors
    /// The file cannot be read or holds words.
    pub fn open(file: &Path) -> Result<Table, Failure> {
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
        Ok(Table { names, columns })
    }

    /// The first column whose name begins so.
    pub fn column(&self, begin: &str) -> Option<&[f64]> {
        let at = self.names.iter().position(|name| name.starts_with(begin))?;
        Some(&self.columns[at])
    }
}
