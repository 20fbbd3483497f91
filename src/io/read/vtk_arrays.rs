//! Arrays of a one-piece VTK XML file, decoded on demand.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::mesh_file::read_bytes;
use super::vtu::{coding_of, text_numbers};
use super::vtu_data::{Coding, decode};
use super::xml::tags;

#[derive(Debug)]
struct Entry {
    section: String,
    name: String,
    kind: String,
    components: usize,
    ascii: bool,
    text: Range<usize>,
}

/// Arrays of an XML file of VTK, read on request.
#[derive(Debug)]
pub struct Arrays {
    file: PathBuf,
    bytes: Vec<u8>,
    coding: Coding,
    entries: Vec<Entry>,
    /// Number of points.
    pub points: usize,
    /// Cells of each kind in [`CELLS`].
    cells: [usize; CELLS.len()],
}

const SECTIONS: [&str; 6] = ["PointData", "CellData", "Points", "Cells", "Lines", "Polys"];

/// Attributes that count cells, with the sections that list them.
const CELLS: [(&str, &str); 4] = [
    ("NumberOfCells", "Cells"),
    ("NumberOfVerts", "Verts"),
    ("NumberOfLines", "Lines"),
    ("NumberOfPolys", "Polys"),
];

/// Largest array; files are far smaller.
const MOST: u64 = 1 << 32;

impl Arrays {
    /// Opens a file of type `kind`, such as `PolyData`.
    ///
    /// # Errors
    /// I/O errors, other types or codings.
    pub fn open(file: &Path, kind: &str) -> Result<Arrays, ReadError> {
        let bytes = read_bytes(file, "VTK file")?;
        let fault = |key: &str, found: &str, expected: &str| ReadError::whole(file, key, found, expected);
        let (mut entries, mut coding, mut points) = (Vec::new(), None, None);
        let mut cells = [0_usize; CELLS.len()];
        let mut section = None;
        for tag in tags(&bytes) {
            match tag.name.as_str() {
                "VTKFile" => {
                    let found = tag.attribute("type").unwrap_or_default();
                    if found != kind {
                        return Err(fault("type of the VTK file", &found, kind));
                    }
                    let known = coding_of(&tag);
                    coding = Some(known.map_err(|(key, found, expected)| fault(key, &found, expected))?);
                }
                "Piece" => {
                    let text = tag.attribute("NumberOfPoints").unwrap_or_default();
                    let count = text.trim().parse::<usize>();
                    let count = count
                        .map_err(|_| fault("NumberOfPoints", &format!("\"{text}\""), "a whole number"))?;
                    if points.replace(count).is_some() {
                        return Err(fault("Piece", "a second one", "one piece"));
                    }
                    cells = CELLS.map(|(attribute, _)| {
                        tag.attribute(attribute).and_then(|n| n.trim().parse().ok()).unwrap_or(0)
                    });
                }
                "DataArray" => {
                    let Some(section) = &section else { continue };
                    let format = tag.attribute("format").unwrap_or_default();
                    if format != "binary" && format != "ascii" {
                        return Err(fault("format of an array", &format!("\"{format}\""), "binary or ascii"));
                    }
                    let components = tag.attribute("NumberOfComponents").and_then(|c| c.trim().parse().ok());
                    entries.push(Entry {
                        section: String::clone(section),
                        name: tag.attribute("Name").unwrap_or_default(),
                        kind: tag.attribute("type").unwrap_or_default(),
                        components: components.unwrap_or(1).clamp(1, 9),
                        ascii: format == "ascii",
                        text: tag.end..tag.end + tag.text_after(&bytes).len(),
                    });
                }
                name => {
                    section = SECTIONS.into_iter().find(|s| *s == name).map(String::from).or(section);
                }
            }
        }
        let coding = coding.ok_or_else(|| fault("VTK file", "no VTKFile element", "a VTK XML file"))?;
        let points = points.ok_or_else(|| fault("VTK file", "no Piece", "one piece"))?;
        Ok(Arrays { file: file.to_path_buf(), bytes, coding, entries, points, cells })
    }

    /// Array names of a section with component counts.
    pub fn names(&self, section: &str) -> impl Iterator<Item = (&str, usize)> {
        let of_section = self.entries.iter().filter(move |e| e.section == section);
        of_section.map(|e| (e.name.as_str(), e.components))
    }

    /// Component count of an array, if present.
    pub fn components(&self, section: &str, name: &str) -> Option<usize> {
        self.names(section).find(|(n, _)| *n == name).map(|(_, components)| components)
    }

    /// Values of an array.
    ///
    /// # Errors
    /// Missing or damaged array.
    pub fn values(&self, section: &str, name: &str) -> Result<Vec<f64>, ReadError> {
        let key = format!("array {name} of {section}");
        let fault = |found: String| ReadError::whole(&self.file, key.clone(), found, "a whole array");
        let entry = self.entries.iter().find(|e| e.section == section && e.name == name);
        let entry = entry.ok_or_else(|| fault("none".to_string()))?;
        let text = &self.bytes[entry.text.clone()];
        let values = match entry.ascii {
            true => text_numbers(text),
            false => decode(text.trim_ascii(), true, &entry.kind, self.coding, MOST),
        };
        let values = values.map_err(fault)?;
        if let Some(k) = values.iter().position(|v| !v.is_finite()) {
            return Err(ReadError::whole(&self.file, key, format!("{} at index {k}", values[k]), "a number"));
        }
        let rows = match section {
            "Points" => Some((3, self.points, "points")),
            "PointData" => Some((entry.components, self.points, "points")),
            "CellData" => Some((
                entry.components,
                self.cells.iter().fold(0_usize, |n, k| n.saturating_add(*k)),
                "cells",
            )),
            _ if name == "offsets" => {
                let cells =
                    CELLS.iter().zip(self.cells).filter(|((_, s), _)| *s == section).map(|(_, n)| n).sum();
                Some((1, cells, "cells"))
            }
            _ => None,
        };
        if let Some((components, rows, of)) = rows
            && rows.checked_mul(components) != Some(values.len())
        {
            let expected = format!("{} of {rows} {of}", rows.saturating_mul(components));
            return Err(ReadError::whole(&self.file, key, format!("{} numbers", values.len()), expected));
        }
        Ok(values)
    }

    /// Values of an array as indices.
    ///
    /// # Errors
    /// As [`Arrays::values`].
    pub fn indices(&self, section: &str, name: &str) -> Result<Vec<u32>, ReadError> {
        Ok(self.values(section, name)?.into_iter().map(|v| v as u32).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::Arrays;

    #[test]
    fn rejects_fields_shorter_than_cells() {
        let text = |polygons: usize, field: &str| {
            format!(
                r#"<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>
<Piece NumberOfPoints="3" NumberOfPolys="{polygons}"><CellData>
<DataArray type="Float64" Name="pressure" format="ascii">{field}</DataArray></CellData><Polys>
<DataArray type="Int64" Name="offsets" format="ascii">3 6</DataArray></Polys></Piece></PolyData></VTKFile>"#
            )
        };
        let file = std::env::temp_dir().join(format!("trackbed-arrays-{}.vtp", std::process::id()));
        let open = |polygons, field| {
            std::fs::write(&file, text(polygons, field)).unwrap();
            let arrays = Arrays::open(&file, "PolyData").unwrap();
            std::fs::remove_file(&file).unwrap();
            arrays
        };
        assert_eq!(open(2, "1 2").values("CellData", "pressure").unwrap(), [1.0, 2.0]);
        let short = open(2, "1").values("CellData", "pressure").unwrap_err().to_string();
        assert!(short.contains("found 1 numbers, expected 2 of 2 cells"), "{short}");
        let other = open(1, "1").indices("Polys", "offsets").unwrap_err().to_string();
        assert!(other.contains("found 2 numbers, expected 1 of 1 cells"), "{other}");
    }
}
