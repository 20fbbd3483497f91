//! Reader of legacy VTK (`.vtk`) unstructured grids, text and binary.
//!
//! Source: VTK User's Guide, "VTK file formats", versions 2.0 to 5.1. Array names: see `vtk_grid`.

use std::path::Path;

use super::error::ReadError;
use super::mesh_file::{Builder, MeshFile, read_bytes};
use super::tokens::{Encoding, Tokens};
use super::unit;
use super::vtk_grid::{self, Array, Grid};

/// Reads a legacy VTK file.
///
/// # Errors
/// Other data sets, damaged arrays, unknown cell types, unknown points.
pub fn read_vtk(file: &Path) -> Result<MeshFile, ReadError> {
    let bytes = read_bytes(file, "VTK file")?;
    let mut tokens = Tokens::new(file, &bytes);
    let first = tokens.rest_of_line().unwrap_or_default();
    if !first.starts_with("# vtk DataFile Version") {
        let shown: String = first.chars().take(40).collect();
        return Err(tokens.fault("first line", format!("\"{shown}\""), "# vtk DataFile Version …"));
    }
    let title = tokens.rest_of_line().unwrap_or_default();
    let unit = unit::refusal(file, 2, title).map(Box::new);
    let how = tokens.next_line().unwrap_or_default();
    let encoding = match how.to_ascii_uppercase().as_str() {
        "ASCII" => Encoding::Text,
        "BINARY" => Encoding::BigEndian,
        _ => {
            let shown: String = how.chars().take(40).collect();
            return Err(tokens.fault("encoding", format!("\"{shown}\""), "ASCII or BINARY"));
        }
    };
    let mut reader = Reader { tokens, encoding, grid: Grid::default(), of_points: None, count: 0 };
    while let Some(line) = reader.tokens.next_line() {
        reader.keyword(line)?;
    }
    let mut builder = Builder::new(file);
    builder.made.unit = unit;
    vtk_grid::mesh(builder, reader.grid)
}

struct Reader<'a> {
    tokens: Tokens<'a>,
    encoding: Encoding,
    grid: Grid,
    /// Whether arrays belong to points; `None` before POINT_DATA or CELL_DATA.
    of_points: Option<bool>,
    count: usize,
}

impl Reader<'_> {
    fn keyword(&mut self, line: &str) -> Result<(), ReadError> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let word = |at: usize| words.get(at).copied().unwrap_or_default();
        match word(0).to_ascii_uppercase().as_str() {
            "DATASET" if word(1).eq_ignore_ascii_case("UNSTRUCTURED_GRID") => Ok(()),
            "DATASET" => Err(self.tokens.fault("DATASET", word(1), "UNSTRUCTURED_GRID")),
            "POINTS" => {
                let count = self.number("POINTS", word(1))?;
                self.grid.points = self.values(count.saturating_mul(3), word(2), "POINTS")?;
                Ok(())
            }
            "CELLS" => self.cells(word(1), word(2)),
            "CELL_TYPES" => {
                let count = self.number("CELL_TYPES", word(1))?;
                self.grid.types = self.values(count, "int", "CELL_TYPES")?;
                Ok(())
            }
            "POINT_DATA" | "CELL_DATA" => {
                self.of_points = Some(word(0).eq_ignore_ascii_case("POINT_DATA"));
                // A section may be empty: remaining bytes do not limit its count.
                self.count = self.unlimited("number of values", word(1))? as usize;
                Ok(())
            }
            "SCALARS" => {
                let components = if word(3).is_empty() { 1 } else { self.number("SCALARS", word(3))? };
                let table = self.tokens.next_line().unwrap_or_default();
                if !table.to_ascii_uppercase().starts_with("LOOKUP_TABLE") {
                    return Err(self.tokens.fault("SCALARS", "no LOOKUP_TABLE", "LOOKUP_TABLE default"));
                }
                self.array(word(1), components, self.count, word(2))
            }
            "VECTORS" | "NORMALS" => self.array(word(1), 3, self.count, word(2)),
            "TENSORS" => self.array(word(1), 9, self.count, word(2)),
            "TENSORS6" => self.array(word(1), 6, self.count, word(2)),
            "GLOBAL_IDS" | "PEDIGREE_IDS" => self.array(word(1), 1, self.count, word(2)),
            "TEXTURE_COORDINATES" => {
                let components = self.number("TEXTURE_COORDINATES", word(2))?;
                self.array(word(1), components, self.count, word(3))
            }
            "COLOR_SCALARS" => {
                let components = self.number("COLOR_SCALARS", word(2))?;
                let kind = if self.encoding == Encoding::Text { "float" } else { "unsigned_char" };
                self.array(word(1), components, self.count, kind)
            }
            "LOOKUP_TABLE" => {
                let size = self.number("LOOKUP_TABLE", word(2))?;
                let kind = if self.encoding == Encoding::Text { "float" } else { "unsigned_char" };
                self.values(size.saturating_mul(4), kind, "LOOKUP_TABLE").map(|_| ())
            }
            "FIELD" => {
                let arrays = self.number("FIELD", word(2))?;
                for _ in 0..arrays {
                    let Some(line) = self.tokens.next_line() else {
                        return Err(self.tokens.fault("FIELD", "the end of the file", "an array"));
                    };
                    let words: Vec<&str> = line.split_whitespace().collect();
                    let [name, components, tuples, kind] = words[..] else {
                        let shown: String = line.chars().take(40).collect();
                        let expected = "name, components, tuples and type";
                        return Err(self.tokens.fault("array of FIELD", format!("\"{shown}\""), expected));
                    };
                    let components = self.number("components", components)?;
                    let tuples = self.number("tuples", tuples)?;
                    self.array(name, components, tuples, kind)?;
                    self.metadata();
                }
                Ok(())
            }
            "METADATA" => {
                self.tokens_to_empty_line();
                Ok(())
            }
            _ => {
                let shown: String = line.chars().take(40).collect();
                Err(self.tokens.fault("keyword", format!("\"{shown}\""), "a keyword such as POINTS"))
            }
        }
    }

    /// METADATA within a FIELD end with an empty line.
    fn metadata(&mut self) {
        if self.tokens.next_is("METADATA") {
            self.tokens_to_empty_line();
        }
    }

    fn tokens_to_empty_line(&mut self) {
        while self.tokens.rest_of_line().is_some_and(|line| !line.is_empty()) {}
    }

    fn number(&mut self, key: &str, word: &str) -> Result<usize, ReadError> {
        let count = self.unlimited(key, word)?;
        self.tokens.plausible(count, key)
    }

    fn unlimited(&mut self, key: &str, word: &str) -> Result<u64, ReadError> {
        word.parse().map_err(|_| {
            let shown: String = word.chars().take(40).collect();
            self.tokens.fault(key, format!("\"{shown}\""), "a whole number of 0 or more")
        })
    }

    /// `CELLS cells numbers` with node counts before each cell, or, since version 5, `CELLS ends numbers`
    /// with OFFSETS and CONNECTIVITY.
    fn cells(&mut self, first: &str, second: &str) -> Result<(), ReadError> {
        let (count, size) = (self.number("CELLS", first)?, self.number("CELLS", second)?);
        if self.tokens.next_is("OFFSETS") {
            let mut both = Vec::new();
            for (word, length) in [("OFFSETS", count), ("CONNECTIVITY", size)] {
                let line = self.tokens.next_line().unwrap_or_default();
                let Some(kind) = line.strip_prefix(word) else {
                    let shown: String = line.chars().take(40).collect();
                    return Err(self.tokens.fault("CELLS", format!("\"{shown}\""), word));
                };
                both.push(self.values(length, kind.trim(), word)?);
            }
            self.grid.connectivity = both.pop().unwrap_or_default();
            self.grid.ends = both.pop().unwrap_or_default();
            if !self.grid.ends.is_empty() {
                self.grid.ends.remove(0);
            }
            return Ok(());
        }
        let flat = self.values(size, "int", "CELLS")?;
        let mut at = 0;
        for cell in 0..count {
            let length = flat.get(at).copied().unwrap_or(-1.0);
            let end = at + 1 + length.max(0.0) as usize;
            if length < 0.0 || end > flat.len() {
                let found = format!("{length} nodes in cell {cell}");
                return Err(self.tokens.fault("CELLS", found, format!("{size} numbers in all")));
            }
            self.grid.connectivity.extend(&flat[at + 1..end]);
            self.grid.ends.push(self.grid.connectivity.len() as f64);
            at = end;
        }
        Ok(())
    }

    /// Stores an array of points or cells, skips others.
    fn array(&mut self, name: &str, components: usize, tuples: usize, kind: &str) -> Result<(), ReadError> {
        let name = decode(name);
        let values = self.values(tuples.saturating_mul(components), kind, &name)?;
        let array = Array { name, components, values };
        match self.of_points {
            Some(true) => self.grid.point_data.push(array),
            Some(false) => self.grid.cell_data.push(array),
            None => {}
        }
        Ok(())
    }

    fn values(&mut self, count: usize, kind: &str, key: &str) -> Result<Vec<f64>, ReadError> {
        let kind = kind.to_ascii_lowercase();
        let width = match kind.as_str() {
            "unsigned_char" | "char" | "signed_char" | "vtktypeuint8" | "vtktypeint8" => 1,
            "unsigned_short" | "short" => 2,
            "unsigned_int" | "int" | "float" | "vtktypeint32" | "vtktypeuint32" => 4,
            "unsigned_long" | "long" | "double" | "vtktypeint64" | "vtktypeuint64" | "vtkidtype" => 8,
            _ if kind == "string" => return Err(self.tokens.fault(key, "text", "numbers")),
            _ => return Err(self.tokens.fault(key, format!("type \"{kind}\""), "a type such as double")),
        };
        if self.encoding == Encoding::Text {
            self.tokens.plausible(count as u64, key)?;
            return (0..count).map(|_| self.tokens.real(key)).collect();
        }
        // vtkIdType has 4 bytes in legacy files.
        let width = if kind == "vtkidtype" { 4 } else { width };
        let bytes = self.tokens.take(count.saturating_mul(width), key)?;
        let number = |b: &[u8]| -> f64 {
            let mut eight = [0; 8];
            eight[8 - b.len()..].copy_from_slice(b);
            let unsigned = u64::from_be_bytes(eight);
            let shift = 64 - 8 * b.len();
            match kind.as_str() {
                "float" => f64::from(f32::from_bits(unsigned as u32)),
                "double" => f64::from_bits(unsigned),
                k if k.starts_with("unsigned") || k.starts_with("vtktypeuint") => unsigned as f64,
                _ => (((unsigned << shift) as i64) >> shift) as f64,
            }
        };
        Ok(bytes.chunks_exact(width).map(number).collect())
    }
}

fn decode(name: &str) -> String {
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let hex = after.get(..2).and_then(|h| std::str::from_utf8(h).ok());
        let code = hex.filter(|_| *first == b'%').and_then(|h| u8::from_str_radix(h, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
