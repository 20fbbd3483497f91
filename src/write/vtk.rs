//! What the VTK XML writers share: checked fields, compression, and the atomic file.

use std::path::{Path, PathBuf};

use vtkio::IOBuffer;
use vtkio::model::{Attribute, ByteOrder, DataSet, Version, VertexNumbers, Vtk};
use vtkio::xml::Compressor;

use super::atomic;
use super::error::{WriteError, check_field};

/// zlib level: result fields are noise in their low bits, so higher levels cost time and gain little.
const LEVEL: u32 = 1;

/// Block in which vtkio compresses [bytes]. It ends every array with a partial block, also where that block
/// is empty, which VTK then reads as a full one: arrays of whole blocks must stay uncompressed.
const BLOCK: usize = 32768;

/// Named, checked fields of the points or of the cells of one file.
pub struct Fields {
    file: PathBuf,
    count: usize,
    list: Vec<Attribute>,
    compressible: bool,
}

impl Fields {
    /// Fields of `count` items of `file`.
    pub fn new(file: &Path, count: usize) -> Self {
        Fields { file: file.to_path_buf(), count, list: Vec::new(), compressible: true }
    }

    /// One number per item.
    pub fn scalar(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.push(name, values, 1, Attribute::scalars(name, 1))
    }

    /// Three numbers per item.
    pub fn vector(&mut self, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.push(name, values, 3, Attribute::vectors(name))
    }

    /// Any number of components per item.
    pub fn generic(&mut self, name: &str, values: &[f64], components: usize) -> Result<(), WriteError> {
        self.push(name, values, components, Attribute::generic(name, components as u32))
    }

    /// Symmetric tensors xx, yy, zz, xy, yz, zx, written as full 3x3 matrices.
    pub fn tensor(&mut self, name: &str, values: &[[f64; 6]]) -> Result<(), WriteError> {
        let full: Vec<f64> = values
            .iter()
            .flat_map(|&[xx, yy, zz, xy, yz, zx]| [xx, xy, zx, xy, yy, yz, zx, yz, zz])
            .collect();
        self.push(name, &full, 9, Attribute::tensors(name))
    }

    /// One identifier per item.
    pub fn ids(&mut self, name: &str, values: &[u32]) -> Result<(), WriteError> {
        if values.len() != self.count {
            let (file, field) = (self.file.clone(), name.to_string());
            return Err(WriteError::Length { file, field, found: values.len(), expected: self.count });
        }
        self.compressible &= compressible(4 * values.len());
        self.list.push(Attribute::generic(name, 1).with_data(values.to_vec()));
        Ok(())
    }

    fn push(
        &mut self,
        name: &str,
        values: &[f64],
        components: usize,
        attribute: Attribute,
    ) -> Result<(), WriteError> {
        check_field(&self.file, name, values, components, self.count)?;
        self.compressible &= compressible(8 * values.len());
        self.list.push(attribute.with_data(values.to_vec()));
        Ok(())
    }

    /// The fields, and whether all of them may be compressed.
    pub fn finish(self) -> (Vec<Attribute>, bool) {
        (self.list, self.compressible)
    }
}

/// Whether an array of so many bytes may be compressed (see [`BLOCK`]).
pub fn compressible(bytes: usize) -> bool {
    !bytes.is_multiple_of(BLOCK)
}

/// Cells of `size` points each, numbered on.
pub fn cells_in_order(cells: usize, size: usize) -> VertexNumbers {
    VertexNumbers::XML {
        connectivity: (0..(cells * size) as u64).collect(),
        offsets: (1..=cells as u64).map(|c| c * size as u64).collect(),
    }
}

/// Points, checked and flat.
pub fn points(file: &Path, points: &[[f64; 3]]) -> Result<IOBuffer, WriteError> {
    let flat = points.as_flattened();
    check_field(file, "points", flat, 3, points.len())?;
    Ok(IOBuffer::F64(flat.to_vec()))
}

/// Writes a data set to `file`.
pub fn write(file: &Path, data: DataSet, compressed: bool) -> Result<(), WriteError> {
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data,
        file_path: None,
    };
    let (compressor, level) = if compressed { (Compressor::ZLib, LEVEL) } else { (Compressor::None, 0) };
    let xml = vtk.try_into_xml_format(compressor, level).map_err(|error| WriteError::format(file, error))?;
    atomic::write(file, |out| xml.write(out).map_err(|error| WriteError::format(file, error)))
}
