//! What the VTK XML writers share: checked fields, compression, and the atomic file.

use std::path::{Path, PathBuf};

use vtkio::IOBuffer;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, DataSet, PolyDataPiece, ScalarType, Version, VertexNumbers, Vtk,
};
use vtkio::xml::Compressor;

use super::atomic;
use super::error::{WriteError, check_field};

/// zlib level: result fields are noise in their low bits, so higher levels cost time and gain little.
const LEVEL: u32 = 1;

/// Named, checked fields of the points or of the cells of one file.
pub struct Fields {
    file: PathBuf,
    count: usize,
    list: Vec<Attribute>,
}

impl Fields {
    /// Fields of `count` items of `file`.
    pub fn new(file: &Path, count: usize) -> Self {
        Fields { file: file.to_path_buf(), count, list: Vec::new() }
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
        self.list.push(attribute.with_data(values.to_vec()));
        Ok(())
    }

    /// The fields.
    pub fn finish(self) -> Vec<Attribute> {
        self.list
    }
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

/// Writes poly data to `file`.
pub fn write_poly(file: &Path, piece: PolyDataPiece) -> Result<(), WriteError> {
    if piece.points.is_empty() { write_empty(file, &piece.data) } else { write(file, piece) }
}

/// Poly data without points: vtkio leaves out counts of zero, which VTK then misses.
fn write_empty(file: &Path, data: &Attributes) -> Result<(), WriteError> {
    let arrays = |list: &[Attribute]| -> String {
        let one = |attribute: &Attribute| match attribute {
            Attribute::DataArray(array) => {
                let kind = if array.data.scalar_type() == ScalarType::U32 { "UInt32" } else { "Float64" };
                let (name, components) = (&array.name, array.elem.num_comp());
                format!(
                    "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                     format=\"ascii\"></DataArray>\n"
                )
            }
            Attribute::Field { .. } => String::new(),
        };
        list.iter().map(one).collect()
    };
    let (point, cell) = (arrays(&data.point), arrays(&data.cell));
    let text = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <PolyData>\n<Piece NumberOfPoints=\"0\" NumberOfVerts=\"0\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n\
         <PointData>\n{point}</PointData>\n<CellData>\n{cell}</CellData>\n\
         <Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\"></DataArray>\n</Points>\n\
         </Piece>\n</PolyData>\n</VTKFile>\n"
    );
    atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))
}

/// Writes a data set that is not empty to `file`.
pub fn write(file: &Path, data: impl Into<DataSet>) -> Result<(), WriteError> {
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(data),
        file_path: None,
    };
    let xml =
        vtk.try_into_xml_format(Compressor::ZLib, LEVEL).map_err(|error| WriteError::format(file, error))?;
    atomic::write(file, |out| xml.write(out).map_err(|error| WriteError::format(file, error)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_symmetric_tensor_becomes_a_matrix_by_rows() {
        let mut fields = Fields::new(Path::new("a.vtu"), 1);
        // xx, yy, zz, xy, yz, zx
        fields.tensor("stress", &[[11.0, 22.0, 33.0, 12.0, 23.0, 31.0]]).unwrap();
        let Some(Attribute::DataArray(array)) = fields.finish().pop() else { panic!("no array") };
        let matrix = [11.0, 12.0, 31.0, 12.0, 22.0, 23.0, 31.0, 23.0, 33.0];
        assert_eq!(array.data.into_vec::<f64>().unwrap(), matrix);
    }
}
