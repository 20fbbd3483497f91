//! Reader of VTK XML (`.vtu`) unstructured grids: text, base64, appended raw or base64, plain or zlib.
//!
//! Source: VTK's wiki and User's Guide, "VTK XML formats", header types UInt32 and UInt64. Array names: see
//! `vtk_grid`.
//!
//! Not supported: parallel files (`.pvtu`), LZ4, LZMA.

use std::path::Path;

use super::error::ReadError;
use super::mesh_file::{Builder, MeshFile, read_bytes};
use super::number;
use super::vtk_grid::{self, Array, Grid};
use super::vtu_data::{Coding, decode};
use super::xml::{Tag, tags};

struct Raw<'a> {
    section: &'static str,
    piece: usize,
    tag: Tag<'a>,
    text: &'a [u8],
}

/// Most numbers per byte of a file: regular grids compress well.
const DENSEST: u64 = 40;
const FREE: u64 = 1_000_000;
/// Nodes of the largest cell, and mean number of lower-dimensional cells per point.
const CELL_NODES: u64 = 27;
const POINT_CELLS: u64 = 64;

const SECTIONS: [&str; 4] = ["PointData", "CellData", "Points", "Cells"];

/// Reads a `.vtu` file.
///
/// # Errors
/// Other data sets, compressors other than zlib, damaged arrays, unknown cell types, unknown points.
pub fn read_vtu(file: &Path) -> Result<MeshFile, ReadError> {
    let bytes = read_bytes(file, "VTK file")?;
    let builder = Builder::new(file);
    let fault = |key: &str, found: &str, expected: &str| ReadError::whole(file, key, found, expected);
    let mut coding = Coding::default();
    let mut raw: Vec<Raw> = Vec::new();
    let mut pieces: Vec<(usize, usize)> = Vec::new();
    let (mut section, mut known) = (None, false);
    let mut appended: Option<(&[u8], bool)> = None;
    for tag in tags(&bytes) {
        match tag.name.as_str() {
            "VTKFile" => {
                let kind = tag.attribute("type").unwrap_or_default();
                if kind != "UnstructuredGrid" {
                    return Err(fault("type of the VTK file", &kind, "UnstructuredGrid"));
                }
                coding = coding_of(&tag).map_err(|(key, found, expected)| fault(key, &found, expected))?;
                known = true;
            }
            "Piece" => {
                let count = |name: &str| {
                    let text = tag.attribute(name).unwrap_or_default();
                    text.trim().parse().map_err(|_| fault(name, &format!("\"{text}\""), "a whole number"))
                };
                pieces.push((count("NumberOfPoints")?, count("NumberOfCells")?));
            }
            "DataArray" | "Array" => {
                if let (Some(section), false) = (section, pieces.is_empty()) {
                    raw.push(Raw { section, piece: pieces.len() - 1, text: tag.text_after(&bytes), tag });
                }
            }
            "AppendedData" => {
                let base64 = tag.attribute("encoding").is_some_and(|e| e == "base64");
                let start = bytes[tag.end..].iter().position(|b| *b == b'_').map(|at| tag.end + at + 1);
                let start =
                    start.ok_or_else(|| fault("AppendedData", "no underscore", "_ before the data"))?;
                appended = Some((&bytes[start..], base64));
                break;
            }
            name => {
                section = SECTIONS.into_iter().find(|s| *s == name).or(section);
                if name.strip_prefix('/').is_some_and(|n| SECTIONS.contains(&n)) {
                    section = None;
                }
            }
        }
    }
    if !known {
        return Err(fault("VTK file", "no VTKFile element", "<VTKFile type=\"UnstructuredGrid\" …>"));
    }
    let mut grid = Grid::default();
    let mut left = FREE + DENSEST * bytes.len() as u64;
    for piece in 0..pieces.len() {
        let of_piece = raw.iter().filter(|r| r.piece == piece);
        add_piece(file, of_piece, coding, appended, pieces[piece], &mut grid, &mut left)?;
    }
    if pieces.len() > 1 {
        grid.point_data = joined(grid.point_data);
        grid.cell_data = joined(grid.cell_data);
    }
    vtk_grid::mesh(builder, grid)
}

pub(super) fn coding_of(tag: &Tag) -> Result<Coding, (&'static str, String, &'static str)> {
    let compressor = tag.attribute("compressor").unwrap_or_default();
    let zlib = match compressor.as_str() {
        "" => false,
        "vtkZLibDataCompressor" => true,
        _ => return Err(("compressor", compressor, "none or vtkZLibDataCompressor")),
    };
    let header = tag.attribute("header_type").unwrap_or_default();
    let wide = match header.as_str() {
        "" | "UInt32" => false,
        "UInt64" => true,
        _ => return Err(("header_type", header, "UInt32 or UInt64")),
    };
    let order = tag.attribute("byte_order").unwrap_or_default();
    let big_endian = match order.as_str() {
        "" | "LittleEndian" => false,
        "BigEndian" => true,
        _ => return Err(("byte_order", order, "LittleEndian or BigEndian")),
    };
    Ok(Coding { zlib, wide, big_endian })
}

fn add_piece<'a>(
    file: &Path,
    raw: impl Iterator<Item = &'a Raw<'a>>,
    coding: Coding,
    appended: Option<(&[u8], bool)>,
    (points, cells): (usize, usize),
    grid: &mut Grid,
    left: &mut u64,
) -> Result<(), ReadError> {
    let (first_point, first_node) = (grid.points.len() / 3, grid.connectivity.len());
    let (old_points, old_cells) = (grid.points.len(), grid.types.len());
    for array in raw {
        let name = array.tag.attribute("Name").unwrap_or_default();
        let key = format!("array {name} of {}", array.section);
        let fault = |found: String, expected: &str| ReadError::whole(file, key.clone(), found, expected);
        let kind = array.tag.attribute("type").unwrap_or_default();
        if kind == "String" {
            continue;
        }
        let components = array.tag.attribute("NumberOfComponents").unwrap_or("1".into());
        let components = components.trim().parse::<usize>().ok().filter(|c| (1..=1000).contains(c));
        let components =
            components.ok_or_else(|| fault("no such number".into(), "a number of components"))?;
        let most =
            most_numbers(array.section, &name, points as u64, cells as u64, components as u64).min(*left);
        let format = array.tag.attribute("format").unwrap_or_default();
        let decoded = match format.as_str() {
            "ascii" | "" => text_numbers(array.text),
            "binary" => decode(array.text, true, &kind, coding, most),
            "appended" => {
                let offset = array.tag.attribute("offset").unwrap_or_default();
                let data = offset.trim().parse::<usize>().ok().and_then(|offset| {
                    let (data, base64) = appended?;
                    Some((data.get(offset..)?, base64))
                });
                let Some((data, base64)) = data else {
                    return Err(fault(format!("offset \"{offset}\""), "a place in AppendedData"));
                };
                decode(data, base64, &kind, coding, most)
            }
            _ => Err(format!("format \"{format}\"")),
        };
        let form = format!("at most {most} numbers, in ascii, binary or appended form");
        let values = decoded.map_err(|found| fault(found, &form))?;
        *left = left.saturating_sub(values.len() as u64);
        match (array.section, name.as_str()) {
            ("Points", _) => grid.points.extend(values),
            ("Cells", "connectivity") => {
                grid.connectivity.extend(values.iter().map(|v| v + first_point as f64));
            }
            ("Cells", "offsets") => grid.ends.extend(values.iter().map(|v| v + first_node as f64)),
            ("Cells", "types") => grid.types.extend(values),
            ("PointData", _) => grid.point_data.push(Array { name, components, values }),
            ("CellData", _) => grid.cell_data.push(Array { name, components, values }),
            _ => {}
        }
    }
    if grid.points.len() - old_points != points.saturating_mul(3) || grid.types.len() - old_cells != cells {
        let found = format!(
            "{} coordinates and {} cells",
            grid.points.len() - old_points,
            grid.types.len() - old_cells
        );
        let expected = format!("values for {points} points and {cells} cells, as in Piece");
        return Err(ReadError::whole(file, "Piece", found, expected));
    }
    Ok(())
}

/// Largest plausible array of a piece.
fn most_numbers(section: &str, name: &str, points: u64, cells: u64, components: u64) -> u64 {
    match (section, name) {
        ("Points", _) => points.saturating_mul(3),
        ("Cells", "connectivity") => {
            cells.saturating_mul(CELL_NODES).saturating_add(points.saturating_mul(POINT_CELLS))
        }
        ("Cells", "offsets" | "types") => cells,
        ("PointData", _) => points.saturating_mul(components),
        ("CellData", _) => cells.saturating_mul(components),
        _ => u64::MAX,
    }
}

pub(super) fn text_numbers(text: &[u8]) -> Result<Vec<f64>, String> {
    let text = std::str::from_utf8(text).map_err(|_| "no text".to_string())?;
    let number = |word: &str| {
        number::real(word).ok_or_else(|| format!("\"{}\"", word.chars().take(40).collect::<String>()))
    };
    text.split_whitespace().map(number).collect()
}

fn joined(arrays: Vec<Array>) -> Vec<Array> {
    let mut out: Vec<Array> = Vec::new();
    for array in arrays {
        match out.iter_mut().find(|a| a.name == array.name && a.components == array.components) {
            Some(first) => first.values.extend(array.values),
            None => out.push(array),
        }
    }
    out
}
