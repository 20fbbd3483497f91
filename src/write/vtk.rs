//! VTK XML files: checked fields, compressed in blocks, in an atomic file.
//!
//! An array goes out as VTK's own writer does it by default: blocks of 32 KiB, each compressed whole by zlib, in base64 behind a header of
//! their lengths. Source: VTK's User's Guide, "VTK XML formats".

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

/// zlib level: result fields are noise in their low bits, so higher levels cost time and gain little.
const LEVEL: u32 = 1;

/// Bytes of a block before it is compressed.
const BLOCK: usize = 32768;

/// An array as little-endian bytes.
pub struct Array {
    name: String,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl Array {
    /// Numbers of double precision, `components` per item.
    pub fn doubles(name: &str, values: &[f64], components: usize) -> Array {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Array { name: name.into(), kind: "Float64", components, bytes }
    }

    /// Identifiers.
    pub fn ids(name: &str, values: &[u32]) -> Array {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        Array { name: name.into(), kind: "UInt32", components: 1, bytes }
    }

    /// Indices of points or of places in a list of them.
    pub fn indices(name: &str, values: impl Iterator<Item = u64>) -> Array {
        Array {
            name: name.into(),
            kind: "UInt64",
            components: 1,
            bytes: values.flat_map(u64::to_le_bytes).collect(),
        }
    }

    /// Small numbers.
    pub fn bytes(name: &str, bytes: Vec<u8>) -> Array {
        Array { name: name.into(), kind: "UInt8", components: 1, bytes }
    }

    /// The text of the array in the file.
    fn encoded(&self) -> std::io::Result<String> {
        let compressed = self.bytes.chunks(BLOCK).map(|block| {
            let mut encoder = ZlibEncoder::new(Vec::with_capacity(BLOCK / 2), Compression::new(LEVEL));
            encoder.write_all(block)?;
            encoder.finish()
        });
        let compressed = compressed.collect::<std::io::Result<Vec<_>>>()?;
        // A last block that is whole counts as no partial one.
        let counts = [compressed.len(), BLOCK, self.bytes.len() % BLOCK];
        let lengths = counts.into_iter().chain(compressed.iter().map(Vec::len));
        let header: Vec<u8> = lengths.flat_map(|n| (n as u64).to_le_bytes()).collect();
        let mut text = BASE64_STANDARD.encode(header);
        BASE64_STANDARD.encode_string(compressed.concat(), &mut text);
        Ok(text)
    }
}

/// Arrays of a file that belong together, such as `PointData`.
pub struct Section {
    name: &'static str,
    /// Attributes of the tag: which array is the one to show first, as scalars, vectors or tensors.
    active: Vec<(&'static str, String)>,
    arrays: Vec<Array>,
}

impl Section {
    /// A section without arrays to show first.
    pub fn new(name: &'static str, arrays: Vec<Array>) -> Section {
        Section { name, active: Vec::new(), arrays }
    }

    /// Points, checked.
    ///
    /// # Errors
    /// A coordinate that is not finite.
    pub fn points(file: &Path, points: &[[f64; 3]]) -> Result<Section, WriteError> {
        let flat = points.as_flattened();
        check_field(file, "points", flat, 3, points.len())?;
        Ok(Section::new("Points", vec![Array::doubles("Points", flat, 3)]))
    }

    /// Cells by the points of all of them, one behind the other, and the end of each in that list.
    pub fn cells(
        name: &'static str,
        connectivity: impl Iterator<Item = u64>,
        ends: impl Iterator<Item = u64>,
    ) -> Section {
        let arrays = vec![Array::indices("connectivity", connectivity), Array::indices("offsets", ends)];
        Section::new(name, arrays)
    }

    /// Cells of `size` points each, numbered on.
    pub fn cells_in_order(name: &'static str, cells: usize, size: usize) -> Section {
        Section::cells(name, 0..(cells * size) as u64, (1..=cells as u64).map(|c| c * size as u64))
    }

    /// With one array more.
    pub fn with(mut self, array: Array) -> Section {
        self.arrays.push(array);
        self
    }
}

/// Named, checked fields of the points or of the cells of one file.
pub struct Fields<'a> {
    file: PathBuf,
    count: usize,
    section: Section,
    choice: Choice<'a>,
}

impl<'a> Fields<'a> {
    /// Fields of the `count` points of `file`.
    pub fn of_points(file: &Path, count: usize) -> Self {
        let section = Section::new("PointData", Vec::new());
        Fields { file: file.to_path_buf(), count, section, choice: Choice::default() }
    }

    /// Fields of the `count` cells of `file`.
    pub fn of_cells(file: &Path, count: usize) -> Self {
        let section = Section::new("CellData", Vec::new());
        Fields { file: file.to_path_buf(), count, section, choice: Choice::default() }
    }

    /// The same; fields that are not chosen are checked and left out.
    #[must_use]
    pub fn only(self, choice: Choice<'a>) -> Self {
        Fields { choice, ..self }
    }

    /// One number per item.
    pub fn scalar(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.show_first("Scalars", name);
        self.generic(name, values, 1)
    }

    /// Three numbers per item.
    pub fn vector(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.show_first("Vectors", name);
        self.generic(name, values, 3)
    }

    /// Any number of components per item.
    pub fn generic(&mut self, name: &str, values: &[f64], components: usize) -> Result<(), WriteError> {
        check_field(&self.file, name, values, components, self.count)?;
        if !self.choice.has(name) {
            return Ok(());
        }
        self.section.arrays.push(Array::doubles(name, values, components));
        Ok(())
    }

    /// Symmetric tensors xx, yy, zz, xy, yz, zx, written as full 3x3 matrices.
    pub fn tensor(&mut self, name: &str, values: &[[f64; 6]]) -> Result<(), WriteError> {
        self.show_first("Tensors", name);
        self.generic(name, &matrices(values), 9)
    }

    /// One identifier per item.
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

    /// The first field of a kind is the one that a viewer shows.
    fn show_first(&mut self, kind: &'static str, name: &str) {
        if self.choice.has(name) && self.section.active.iter().all(|(k, _)| *k != kind) {
            self.section.active.push((kind, name.to_string()));
        }
    }

    /// The fields.
    pub fn finish(self) -> Section {
        self.section
    }
}

/// Symmetric tensors xx, yy, zz, xy, yz, zx as full 3x3 matrices by rows.
pub fn matrices(values: &[[f64; 6]]) -> Vec<f64> {
    values.iter().flat_map(|&[xx, yy, zz, xy, yz, zx]| [xx, xy, zx, xy, yy, yz, zx, yz, zz]).collect()
}

/// Writes a data set of type `kind` with one piece to `file`: its counts, such as `NumberOfPoints`, and its sections.
///
/// # Errors
/// What the system refuses.
pub fn write(
    file: &Path,
    kind: &str,
    counts: &[(&str, usize)],
    sections: &[Section],
) -> Result<(), WriteError> {
    let counts: Vec<(&str, String)> = counts.iter().map(|(k, n)| (*k, n.to_string())).collect();
    write_with(file, (kind, &[]), &counts, sections)
}

/// Writes a data set with attributes of its own and of its piece, as images have them.
///
/// # Errors
/// What the system refuses.
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

/// Writes a section with the texts of its arrays.
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
