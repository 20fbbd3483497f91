//! Tables of a run, such as `history.csv` and `cycles.csv`: a head with units, rows that may still be growing.

use crate::columns::Name;
use crate::failure::Failure;
use crate::read::source;
use std::path::Path;

/// Columns of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name of each column with its unit in brackets.
    pub names: Vec<String>,
    /// Name of each column, without its unit.
    pub heads: Vec<String>,
    /// Values by column.
    pub columns: Vec<Vec<f64>>,
    /// Rows that could not be read: with too few values, or with one that is no finite number.
    pub skipped: usize,
}

impl Table {
    /// Reads a table; none where the file is missing. The last row is left out while it has no end, and so is every row that
    /// has not a finite number in each column.
    ///
    /// # Errors
    /// Bad input: the file is not to be read, or has no head.
    pub fn read(file: &Path) -> Result<Option<Table>, Failure> {
        if !file.exists() {
            return Ok(None);
        }
        let refused = |found: String, expected: &str| {
            Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
        };
        let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
        let end = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |k| k + 1);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(&bytes[..end]);
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

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Values of a column.
    pub fn column<'n>(&self, name: impl Into<Name<'n>>) -> Option<&[f64]> {
        let name = name.into().to_string();
        let index = self.heads.iter().position(|h| *h == name)?;
        Some(&self.columns[index])
    }

    /// Points (x, y) of two columns, where both are there.
    pub fn points<'n>(&self, x: impl Into<Name<'n>>, y: impl Into<Name<'n>>) -> Option<Vec<[f64; 2]>> {
        Some(self.column(x)?.iter().zip(self.column(y)?).map(|(x, y)| [*x, *y]).collect())
    }

    /// Items that have a column, such as `plate` of `plate_force_x` for `<wall>_force`, axis x.
    pub fn items<'n>(&self, name: impl Into<Name<'n>>) -> Vec<&str> {
        let name = name.into();
        self.heads.iter().filter_map(|h| name.item_in(h)).collect()
    }
}

/// Name in a head such as `settlement [m]`.
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
    fn a_table_that_grows_is_read_up_to_its_last_whole_row() {
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
        fs::remove_dir_all(&dir).unwrap();
    }
}
