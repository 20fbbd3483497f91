//! Tables of a run, such as `history.csv` and `cycles.csv`, possibly still growing.

use crate::columns::Name;
use crate::failure::Failure;
use crate::read::source;
use std::path::Path;

/// Numeric columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Column names with units in brackets.
    pub names: Vec<String>,
    /// Column names without units.
    pub heads: Vec<String>,
    /// Values by column.
    pub columns: Vec<Vec<f64>>,
    /// Rows skipped as incomplete or non-finite.
    pub skipped: usize,
}

impl Table {
    /// Reads a table; `None` without file. Unterminated, incomplete and non-finite rows are skipped.
    ///
    /// # Errors
    /// Unreadable file, no header.
    pub fn read(file: &Path) -> Result<Option<Table>, Failure> {
        if !file.exists() {
            return Ok(None);
        }
        let refused = |found: String, expected: &str| {
            Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
        };
        let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
        let end = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |k| k + 1);
        let start = bytes[..end].strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes[..end]);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(start);
        let names: Vec<String> = match reader.headers() {
            Ok(names) => names.iter().map(String::from).collect(),
            Err(e) => return Err(refused(e.to_string(), "a table of numbers with a head")),
        };
        if names.is_empty() {
            return Err(refused("no head".into(), "a table of numbers with a head"));
        }
        let heads = names.iter().map(|name| head(name)).collect();
        let mut table = Table { columns: vec![Vec::new(); names.len()], names, heads, skipped: 0 };
        let mut row = Vec::new();
        for record in reader.records() {
            row.clear();
            row.extend(record.iter().flatten().filter_map(|v| v.trim().parse::<f64>().ok()));
            match row.len() == table.columns.len() && row.iter().all(|v| v.is_finite()) {
                true => table.columns.iter_mut().zip(&row).for_each(|(column, v)| column.push(*v)),
                false => table.skipped += 1,
            }
        }
        Ok(Some(table))
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Returns the values of a column.
    pub fn column<'n>(&self, name: impl Into<Name<'n>>) -> Option<&[f64]> {
        let name = name.into().to_string();
        let index = self.heads.iter().position(|h| *h == name)?;
        Some(&self.columns[index])
    }

    /// Returns points (x, y) of two columns, if both exist.
    pub fn points<'n>(&self, x: impl Into<Name<'n>>, y: impl Into<Name<'n>>) -> Option<Vec<[f64; 2]>> {
        Some(self.column(x)?.iter().zip(self.column(y)?).map(|(x, y)| [*x, *y]).collect())
    }

    /// Returns items with such a column.
    pub fn items<'n>(&self, name: impl Into<Name<'n>>) -> Vec<&str> {
        let name = name.into();
        self.heads.iter().filter_map(|h| name.item_in(h)).collect()
    }
}

fn head(text: &str) -> String {
    text.rsplit_once(" [").map_or(text, |(name, _)| name).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::history::{TIME, WALL_FORCE};
    use crate::write::sample::folder;
    use std::fs;

    #[test]
    fn reads_growing_table_without_partial_row() {
        let dir = folder("table");
        let file = dir.join("t.csv");
        assert_eq!(Table::read(&file).unwrap(), None);
        fs::write(&file, "time [s],plate_force_x [N],n\n0,1e3,2\n1,NaN,3\n2,5\n3,-4,5\n4,12").unwrap();
        let table = Table::read(&file).unwrap().unwrap();
        assert_eq!((table.rows(), table.skipped), (2, 2));
        assert_eq!(table.points(TIME, WALL_FORCE.of("plate").at(0)).unwrap(), [[0.0, 1e3], [3.0, -4.0]]);
        assert_eq!(table.heads[1], "plate_force_x", "without its unit");
        assert_eq!(table.names[1], "plate_force_x [N]");
        assert_eq!(table.items(WALL_FORCE.at(0)), ["plate"]);
        fs::write(&file, "time [s],n\n").unwrap();
        assert_eq!(Table::read(&file).unwrap().unwrap().rows(), 0);
        fs::write(&file, "time [s]").unwrap();
        assert!(Table::read(&file).is_err(), "the head is not whole yet");
        fs::write(&file, "\u{feff}time [s],n\n1,2\n").unwrap();
        assert_eq!(Table::read(&file).unwrap().unwrap().heads, ["time", "n"]);
        fs::remove_dir_all(&dir).unwrap();
    }
}
