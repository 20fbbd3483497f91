//! Reader of Wavefront OBJ: vertices and polygons.
//!
//! Corners are `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards as −1, −2, …. Polygons become
//! triangle fans, exact for convex outlines. Textures, normals, groups and materials are skipped; curved
//! surfaces are rejected.
//!
//! Source: Wavefront Technologies, Advanced Visualizer Manual, appendix B1, "Object files".

use std::path::Path;

use super::error::ReadError;
use super::mesh_file::read_text;
use super::number;
use super::surface::Surface;

const IGNORED: [&str; 13] =
    ["vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "l", "p", "mg", "lod", "shadow_obj"];

/// Reads an OBJ file; equal vertices are merged.
///
/// # Errors
/// Unknown or damaged statements, unknown vertices, no face.
pub fn read_obj(file: &Path) -> Result<Surface, ReadError> {
    parse(file, &read_text(file, "OBJ surface")?)
}

fn parse(file: &Path, text: &str) -> Result<Surface, ReadError> {
    let mut surface = Surface::default();
    // With source lines: vertices may follow later.
    let mut lines = Vec::new();
    let mut joined = String::new();
    let mut start = 1;
    for (number, raw) in text.lines().enumerate() {
        if joined.is_empty() {
            start = number + 1;
        }
        let body = raw.split('#').next().unwrap_or_default().trim();
        if let Some(part) = body.strip_suffix('\\') {
            joined.push_str(part);
            joined.push(' ');
            continue;
        }
        joined.push_str(body);
        statement(file, start, &joined, &mut surface, &mut lines)?;
        joined.clear();
    }
    if !joined.is_empty() {
        statement(file, start, &joined, &mut surface, &mut lines)?;
    }
    let count = surface.vertices.len();
    for (t, line) in surface.triangles.iter().zip(&lines) {
        if let Some(bad) = t.iter().find(|v| **v as usize >= count) {
            let found = (u64::from(*bad) + 1).to_string();
            let expected = format!("the number of one of the {count} vertices");
            return Err(ReadError::at(file, *line, "corner of a face", found, expected));
        }
    }
    if surface.triangles.is_empty() {
        return Err(ReadError::whole(file, "faces", "none", "at least one"));
    }
    Ok(surface.merged(0.0))
}

fn statement(
    file: &Path,
    line: usize,
    text: &str,
    surface: &mut Surface,
    lines: &mut Vec<usize>,
) -> Result<(), ReadError> {
    let mut words = text.split_whitespace();
    let Some(kind) = words.next() else { return Ok(()) };
    match kind {
        "v" => {
            let words: Vec<&str> = words.collect();
            if !matches!(words.len(), 3 | 4 | 6 | 7) {
                let found = format!("{} numbers", words.len());
                return Err(ReadError::at(file, line, "vertex", found, "x y z"));
            }
            let mut point = [0.0; 3];
            for (k, key) in ["coordinate x", "coordinate y", "coordinate z"].iter().enumerate() {
                let value = number::real(words[k]).filter(|v| v.is_finite());
                point[k] = value.ok_or_else(|| {
                    ReadError::at(file, line, *key, format!("\"{}\"", words[k]), "a finite number")
                })?;
            }
            surface.vertices.push(point);
        }
        "f" => {
            let count = surface.vertices.len();
            let corners = words.map(|w| corner(file, line, w, count)).collect::<Result<Vec<u32>, _>>()?;
            if corners.len() < 3 {
                let found = format!("{} corners", corners.len());
                return Err(ReadError::at(file, line, "face", found, "at least three"));
            }
            for pair in corners[1..].windows(2) {
                surface.triangles.push([corners[0], pair[0], pair[1]]);
                lines.push(line);
            }
        }
        _ if IGNORED.contains(&kind) => {}
        _ => {
            let found: String = kind.chars().take(40).collect();
            let expected = "v, f, or a statement on textures, normals, groups or materials";
            return Err(ReadError::at(file, line, "statement", format!("\"{found}\""), expected));
        }
    }
    Ok(())
}

/// Vertex of a corner, from 0; existence is checked at the end.
fn corner(file: &Path, line: usize, word: &str, count: usize) -> Result<u32, ReadError> {
    let fault =
        |expected: String| ReadError::at(file, line, "corner of a face", format!("\"{word}\""), expected);
    let mut parts = word.split('/');
    let vertex = parts.next().unwrap_or_default();
    let rest: Vec<&str> = parts.collect();
    let whole = |t: &&str| t.parse::<i64>().is_ok_and(|n| n != 0);
    let well = rest.len() <= 2 && rest.iter().all(|text| text.is_empty() || whole(text));
    let number: i64 = vertex
        .parse()
        .ok()
        .filter(|n| *n != 0 && well)
        .ok_or_else(|| fault("a vertex number from 1 or −1, as v, v/vt, v//vn or v/vt/vn".to_string()))?;
    let index = if number > 0 { number - 1 } else { count as i64 + number };
    u32::try_from(index).map_err(|_| fault(format!("the number of one of the {count} vertices so far")))
}

#[cfg(test)]
#[path = "obj_tests.rs"]
mod tests;
