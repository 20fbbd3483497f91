//! Triangle surfaces from files of other programs.
//!
//! The plain list gives the numbers of vertices and triangles, the vertices (`x y z`), and three vertex ids
//! per triangle, from 1 (from 0 if a 0 occurs). Any winding is accepted; surfaces may be open.

use std::io::Read;
use std::path::Path;

use super::error::ReadError;
use super::header::Content;
use super::table::Table;
use super::{MESH_ENDINGS, asc, geotiff, obj, skin, source, stl, unit};

pub use trackbed_dem::shape::polyhedron::Surface;

/// File extensions of surfaces.
pub const SURFACE_ENDINGS: [&str; 9] = ["stl", "obj", "dat", "txt", "tri", "srf", "asc", "tif", "tiff"];

/// Largest coordinate [m].
const LARGEST: f64 = 1e50;

/// Merging distance of STL vertices over the box diagonal, if exact merging leaves gaps.
const STL_TOLERANCE: f64 = 1e-6;

/// Reads a surface [m], with its format given by the extension: `.stl`, `.obj`, the plain list `.dat`,
/// `.txt`, `.tri`, `.srf`, heights `.asc` (ESRI) and `.tif`, `.tiff` (GeoTIFF), or the skin of a mesh. Equal
/// vertices are merged; open STL files also within 1e-6 of their size.
///
/// # Errors
/// Unknown extensions, errors of the format's reader, coordinates whose moments of volume would overflow.
pub fn read_surface(path: &Path) -> Result<Surface, ReadError> {
    let surface = read_any(path)?;
    match surface.vertices.iter().flatten().find(|x| x.abs() > LARGEST) {
        Some(x) => {
            Err(ReadError::whole(path, "vertices", format!("{x:e} m"), format!("at most {LARGEST:e} m")))
        }
        None => Ok(surface),
    }
}

fn read_any(path: &Path) -> Result<Surface, ReadError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "stl" => stl::read_stl(path).map(|soup| mended(&soup)),
        "obj" => obj::read_obj(path),
        "dat" | "txt" | "tri" | "srf" => read_plain(path),
        "asc" => asc::read_asc(path),
        "tif" | "tiff" => geotiff::read_geotiff(path),
        _ if MESH_ENDINGS.contains(&ending.as_str()) => skin::read_skin(path),
        _ => {
            let found =
                if ending.is_empty() { "no file extension".to_string() } else { format!("\".{ending}\"") };
            let expected = ".stl, .obj, .asc, .tif, a mesh such as .cdb, or .dat, .txt, .tri or .srf with a list of vertices and \
                            triangles";
            Err(ReadError::whole(path, "file extension", found, expected))
        }
    }
}

/// Start of a file in which comments state its unit [bytes].
const HEAD: u64 = 1 << 16;

/// Length unit other than metres that a comment of a text file states, as the error without `scale`.
pub fn surface_unit(path: &Path) -> Option<ReadError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase())?;
    if !["obj", "dat", "txt", "tri", "srf"].contains(&ending.as_str()) {
        return None;
    }
    let mut bytes = Vec::new();
    source::open(path, source::LARGEST).ok()?.take(HEAD).read_to_end(&mut bytes).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let comments =
        (1..).zip(text.lines()).filter(|(_, line)| line.trim_start().starts_with(['#', '!', '*', '/']));
    let mut stated = comments.filter_map(|(line, text)| unit::refusal_without(path, line, text, "scale"));
    stated.next()
}

/// Merges vertices of separate triangles.
fn mended(soup: &Surface) -> Surface {
    let open = |s: &Surface| s.topology().map_or(0, |t| t.open_edges);
    let exact = soup.merged(0.0);
    if open(&exact) == 0 {
        return exact;
    }
    let loose = exact.merged(STL_TOLERANCE * exact.diagonal());
    if open(&loose) < open(&exact) { loose } else { exact }
}

/// Reads the plain list.
///
/// # Errors
/// Wrong counts or row widths, non-finite coordinates, unknown vertices.
pub fn read_plain(file: &Path) -> Result<Surface, ReadError> {
    let table = Table::read(file, Content::Surface)?;
    let Some(head) = table.rows.first() else {
        return Err(ReadError::whole(
            file,
            "numbers of vertices and triangles",
            "no rows of numbers",
            "two counts",
        ));
    };
    let width = |row: usize, key: &str, count: usize, expected: &str| {
        let r = &table.rows[row];
        if r.width() == count {
            return Ok(r);
        }
        Err(ReadError::at(file, r.line, key, format!("{} columns", r.width()), expected))
    };
    width(0, "numbers of vertices and triangles", 2, "two counts")?;
    let vertices = table.whole(head, 0, "number of vertices")? as usize;
    let triangles = table.whole(head, 1, "number of triangles")? as usize;
    let rows = table.rows.len() - 1;
    if rows != vertices + triangles {
        let expected = format!("{vertices} vertices and {triangles} triangles, as in line {}", head.line);
        return Err(ReadError::whole(file, "rows", rows.to_string(), expected));
    }
    let mut surface = Surface::default();
    for i in 1..=vertices {
        let row = width(i, "vertex", 3, "x y z")?;
        let mut point = [0.0; 3];
        for (k, name) in ["x", "y", "z"].iter().enumerate() {
            point[k] = table.real(row, k, &format!("coordinate {name}"))?;
        }
        surface.vertices.push(point);
    }
    let mut numbers = Vec::with_capacity(triangles);
    for i in 1..=triangles {
        let row = width(vertices + i, "triangle", 3, "three vertex numbers")?;
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            *corner = table.whole(row, k, "vertex of a triangle")?;
        }
        numbers.push((row.line, corners));
    }
    let base = u32::from(!numbers.iter().any(|(_, t)| t.contains(&0)));
    for (line, corners) in numbers {
        if let Some(bad) = corners.iter().find(|v| **v as usize >= vertices + base as usize) {
            let expected = match vertices {
                0 => "no triangles: there are no vertices".to_string(),
                _ => format!("{base} to {}", vertices - 1 + base as usize),
            };
            return Err(ReadError::at(file, line, "vertex of a triangle", bad.to_string(), expected));
        }
        surface.triangles.push(corners.map(|v| v - base));
    }
    Ok(surface)
}

#[cfg(test)]
#[path = "surface_tests.rs"]
mod tests;
