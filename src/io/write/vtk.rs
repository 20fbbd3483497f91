//! VTK XML files with checked, compressed fields, written atomically.
//!
//! Zlib blocks of 32 KiB in base64 after a header of lengths. Source: VTK's User's Guide, "VTK XML
//! formats".

use std::io::Write;
use std::path::{Path, PathBuf};

use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::{Compression, write::ZlibEncoder};
use quick_xml::Writer;
use quick_xml::events::BytesText;
use rayon::prelude::*;

use super::atomic;
use super::choice::Choice;
use super::error::{WriteError, check_field};

/// zlib level: low bits of results are noise, so higher levels gain little.
const LEVEL: u32 = 1;

/// Uncompressed block size [bytes].
const BLOCK: usize = 32768;

pub struct Array {
    name: String,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl Array {
    /// `components` per item.
    pub fn doubles(name: &str, values: &[f64], components: usize) -> Array {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Array { name: name.into(), kind: "Float64", components, bytes }
    }

    pub fn ids(name: &str, values: &[u32]) -> Array {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Array { name: name.into(), kind: "UInt32", components: 1, bytes }
    }

    /// Point indices or offsets.
    pub fn indices(name: &str, values: impl Iterator<Item = u64>) -> Array {
        Array {
            name: name.into(),
            kind: "UInt64",
            components: 1,
            bytes: values.flat_map(u64::to_le_bytes).collect(),
        }
    }

    pub fn bytes(name: &str, bytes: Vec<u8>) -> Array {
        Array { name: name.into(), kind: "UInt8", components: 1, bytes }
    }

    fn encoded(&self) -> std::io::Result<String> {
        let compressed = self.bytes.chunks(BLOCK).map(|block| {
            let mut encoder = ZlibEncoder::new(Vec::with_capacity(BLOCK / 2), Compression::new(LEVEL));
            encoder.write_all(block)?;
            encoder.finish()
        });
        let compressed = compressed.collect::<std::io::Result<Vec<_>>>()?;
        // A complete last block counts as no partial block.
        let counts = [compressed.len(), BLOCK, self.bytes.len() % BLOCK];
        let lengths = counts.into_iter().chain(compressed.iter().map(Vec::len));
        let header: Vec<u8> = lengths.flat_map(|n| (n as u64).to_le_bytes()).collect();
        let mut text = BASE64_STANDARD.encode(header);
        BASE64_STANDARD.encode_string(compressed.concat(), &mut text);
        Ok(text)
    }
}

pub struct Section {
    name: &'static str,
    /// Default scalars, vectors or tensors.
    active: Vec<(&'static str, String)>,
    arrays: Vec<Array>,
}

impl Section {
    pub fn new(name: &'static str, arrays: Vec<Array>) -> Section {
        Section { name, active: Vec::new(), arrays }
    }

    /// Checked points.
    ///
    /// # Errors
    /// Non-finite coordinates.
    pub fn points(file: &Path, points: &[[f64; 3]]) -> Result<Section, WriteError> {
        let flat = points.as_flattened();
        check_field(file, "points", flat, 3, points.len())?;
        Ok(Section::new("Points", vec![Array::doubles("Points", flat, 3)]))
    }

    /// Cells by concatenated points and end offsets.
    pub fn cells(
        name: &'static str,
        connectivity: impl Iterator<Item = u64>,
        ends: impl Iterator<Item = u64>,
    ) -> Section {
        let arrays = vec![Array::indices("connectivity", connectivity), Array::indices("offsets", ends)];
        Section::new(name, arrays)
    }

    /// Cells of `size` consecutive points each.
    pub fn cells_in_order(name: &'static str, cells: usize, size: usize) -> Section {
        Section::cells(name, 0..(cells * size) as u64, (1..=cells as u64).map(|c| c * size as u64))
    }

    pub fn with(mut self, array: Array) -> Section {
        self.arrays.push(array);
        self
    }
}

/// Checked fields of points or cells.
pub struct Fields<'a> {
    file: PathBuf,
    count: usize,
    section: Section,
    choice: Choice<'a>,
}

impl<'a> Fields<'a> {
    pub fn of_points(file: &Path, count: usize) -> Self {
        let section = Section::new("PointData", Vec::new());
        Fields { file: file.to_path_buf(), count, section, choice: Choice::default() }
    }

    pub fn of_cells(file: &Path, count: usize) -> Self {
        let section = Section::new("CellData", Vec::new());
        Fields { file: file.to_path_buf(), count, section, choice: Choice::default() }
    }

    /// Selects fields; others are checked only.
    #[must_use]
    pub fn only(self, choice: Choice<'a>) -> Self {
        Fields { choice, ..self }
    }

    pub fn scalar(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.show_first("Scalars", name);
        self.generic(name, values, 1)
    }

    pub fn vector(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.show_first("Vectors", name);
        self.generic(name, values, 3)
    }

    pub fn generic(&mut self, name: &str, values: &[f64], components: usize) -> Result<(), WriteError> {
        check_field(&self.file, name, values, components, self.count)?;
        if !self.choice.has(name) {
            return Ok(());
        }
        self.section.arrays.push(Array::doubles(name, values, components));
        Ok(())
    }

    /// Adds symmetric tensors xx, yy, zz, xy, yz, zx as 3x3 matrices.
    pub fn tensor(&mut self, name: &str, values: &[[f64; 6]]) -> Result<(), WriteError> {
        self.show_first("Tensors", name);
        self.generic(name, &matrices(values), 9)
    }

    pub fn ids(&mut self, name: &str, values: &[u32]) -> Result<(), WriteError> {
        if values.len() != self.count {
            let (file, field) = (self.file.clone(), name.to_string());
            return Err(WriteError::Length { file, field, found: values.len(), expected: self.count });
        }
        if !self.choice.has(name) {
            return Ok(());
        }
        self.section.arrays.push(Array::ids(name, values));
        Ok(())
    }

    /// Viewers show the first field of each kind.
    fn show_first(&mut self, kind: &'static str, name: &str) {
        if self.choice.has(name) && self.section.active.iter().all(|(k, _)| *k != kind) {
            self.section.active.push((kind, name.to_string()));
        }
    }

    pub fn finish(self) -> Section {
        self.section
    }
}

/// Symmetric tensors xx, yy, zz, xy, yz, zx as 3x3 matrices by rows.
pub fn matrices(values: &[[f64; 6]]) -> Vec<f64> {
    values.iter().flat_map(|&[xx, yy, zz, xy, yz, zx]| [xx, xy, zx, xy, yy, yz, zx, yz, zz]).collect()
}

/// Writes a one-piece data set with its counts, such as `NumberOfPoints`.
///
/// # Errors
/// I/O errors.
pub fn write(
    file: &Path,
    kind: &str,
    counts: &[(&str, usize)],
    sections: &[Section],
) -> Result<(), WriteError> {
    let counts: Vec<(&str, String)> = counts.iter().map(|(k, n)| (*k, n.to_string())).collect();
    write_with(file, (kind, &[]), &counts, sections)
}

/// Writes a data set with attributes.
///
/// # Errors
/// I/O errors.
pub fn write_with(
    file: &Path,
    (kind, attributes): (&str, &[(&str, String)]),
    piece: &[(&str, String)],
    sections: &[Section],
) -> Result<(), WriteError> {
    let arrays: Vec<&Array> = sections.iter().flat_map(|section| &section.arrays).collect();
    let texts = arrays.par_iter().map(|array| array.encoded()).collect::<Result<Vec<String>, _>>();
    let mut texts = texts.map_err(WriteError::io(file))?.into_iter();
    atomic::write(file, |out| {
        let mut xml = Writer::new(out);
        let root = xml.create_element("VTKFile").with_attributes([
            ("type", kind),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
            ("compressor", "vtkZLibDataCompressor"),
        ]);
        let written = root.write_inner_content(|xml| {
            let set =
                xml.create_element(kind).with_attributes(attributes.iter().map(|(k, v)| (*k, v.as_str())));
            set.write_inner_content(|xml| {
                let piece = piece.iter().map(|(k, v)| (*k, v.as_str()));
                xml.create_element("Piece").with_attributes(piece).write_inner_content(|xml| {
                    sections.iter().try_for_each(|section| write_section(xml, section, &mut texts))
                })?;
                Ok::<(), quick_xml::Error>(())
            })?;
            Ok(())
        });
        written.map(|_| ()).map_err(|error: quick_xml::Error| WriteError::format(file, error))
    })
}

fn write_section<W: Write>(
    xml: &mut Writer<W>,
    section: &Section,
    texts: &mut impl Iterator<Item = String>,
) -> Result<(), quick_xml::Error> {
    let active = section.active.iter().map(|(kind, name)| (*kind, name.as_str()));
    xml.create_element(section.name).with_attributes(active).write_inner_content(|xml| {
        for (array, text) in section.arrays.iter().zip(texts) {
            let components = array.components.to_string();
            xml.create_element("DataArray")
                .with_attributes([
                    ("type", array.kind),
                    ("Name", array.name.as_str()),
                    ("NumberOfComponents", components.as_str()),
                    ("format", "binary"),
                ])
                .write_text_content(BytesText::from_escaped(text))?;
        }
        Ok::<(), quick_xml::Error>(())
    })?;
    Ok(())
}

#[cfg(test)]
#[path = "vtk_tests.rs"]
mod tests;
