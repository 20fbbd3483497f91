//! Reader of STL, text or binary.
//!
//! A file is binary if its triangle count gives its length: binary titles may also begin with `solid`.
//! Otherwise it is text if it begins with `solid` and has no zero byte.
//!
//! Source: 3D Systems, StereoLithography Interface Specification, 1989.

use std::path::Path;

use super::error::ReadError;
use super::mesh_file::read_bytes;
use super::number;
use super::surface::Surface;

/// Bytes of the header, and of a triangle.
const HEAD: usize = 84;
const FACET: usize = 50;

/// Reads an STL file; triangles share no vertices.
///
/// # Errors
/// Damaged files, non-finite coordinates, no triangle.
pub fn read_stl(file: &Path) -> Result<Surface, ReadError> {
    let bytes = read_bytes(file, "STL surface")?;
    parse(file, &bytes)
}

fn parse(file: &Path, bytes: &[u8]) -> Result<Surface, ReadError> {
    let count = bytes.get(80..HEAD).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let plain = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let length = count.and_then(|n| n.checked_mul(FACET)).map(|n| n + HEAD);
    let surface = if length == Some(bytes.len()) {
        binary(file, bytes)?
    } else if plain.trim_ascii_start().get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"solid"))
        && !bytes.contains(&0)
    {
        text(file, &String::from_utf8_lossy(plain))?
    } else {
        let expected = match (count, length) {
            (Some(n), Some(l)) => {
                format!("{l} for the {n} triangles that a binary file counts, or text from `solid` on")
            }
            _ => "text that begins with `solid`, or at least 84 of a binary file".to_string(),
        };
        return Err(ReadError::whole(file, "length in bytes", bytes.len().to_string(), expected));
    };
    if surface.triangles.is_empty() {
        return Err(ReadError::whole(file, "triangles", "none", "at least one"));
    }
    Ok(surface)
}

fn binary(file: &Path, bytes: &[u8]) -> Result<Surface, ReadError> {
    let mut surface = Surface::default();
    for (i, facet) in bytes[HEAD..].chunks_exact(FACET).enumerate() {
        // Twelve bytes of normal first, two of attributes last.
        for corner in facet[12..48].chunks_exact(12) {
            let point: [f64; 3] = std::array::from_fn(|k| {
                f64::from(f32::from_le_bytes([
                    corner[4 * k],
                    corner[4 * k + 1],
                    corner[4 * k + 2],
                    corner[4 * k + 3],
                ]))
            });
            if let Some(bad) = point.iter().find(|x| !x.is_finite()) {
                let key = format!("vertex of triangle {}", i + 1);
                return Err(ReadError::whole(file, key, bad.to_string(), "a finite number"));
            }
            surface.vertices.push(point);
        }
        surface.triangles.push(last_three(&surface));
    }
    Ok(surface)
}

fn last_three(surface: &Surface) -> [u32; 3] {
    let n = surface.vertices.len() as u32;
    [n - 3, n - 2, n - 1]
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Outside,
    Solid,
    Facet,
    Loop(usize),
    AfterLoop,
}

impl State {
    fn expected(self) -> &'static str {
        match self {
            State::Outside => "`solid`",
            State::Solid => "`facet normal` or `endsolid`",
            State::Facet => "`outer loop`",
            State::Loop(3) => "`endloop` after three vertices",
            State::Loop(_) => "`vertex` and three numbers",
            State::AfterLoop => "`endfacet`",
        }
    }
}

fn text(file: &Path, text: &str) -> Result<Surface, ReadError> {
    let mut surface = Surface::default();
    let mut state = State::Outside;
    let mut last = 0;
    for (number, raw) in text.lines().enumerate() {
        let line = number + 1;
        let words: Vec<String> = raw.split_whitespace().map(str::to_ascii_lowercase).collect();
        let Some(first) = words.first() else { continue };
        last = line;
        let second = words.get(1).map(String::as_str);
        state = match (state, first.as_str(), second) {
            (State::Outside, "solid", _) => State::Solid,
            (State::Solid, "facet", Some("normal")) => State::Facet,
            (State::Solid, "endsolid", _) => State::Outside,
            (State::Solid, "end", Some("solid")) => State::Outside,
            (State::Facet, "outer", Some("loop")) => State::Loop(0),
            (State::Loop(k), "vertex", _) if k < 3 => {
                surface.vertices.push(vertex(file, line, &words)?);
                State::Loop(k + 1)
            }
            (State::Loop(3), "endloop", _) => State::AfterLoop,
            (State::AfterLoop, "endfacet", _) => {
                surface.triangles.push(last_three(&surface));
                State::Solid
            }
            _ => {
                let found: String = raw.trim().chars().take(40).collect();
                return Err(ReadError::at(file, line, "statement", format!("\"{found}\""), state.expected()));
            }
        };
    }
    if state != State::Outside {
        // A missing last `endsolid` loses nothing; a truncated triangle does.
        if state != State::Solid {
            return Err(ReadError::at(file, last, "statement", "the end of the file", state.expected()));
        }
    }
    Ok(surface)
}

fn vertex(file: &Path, line: usize, words: &[String]) -> Result<[f64; 3], ReadError> {
    if words.len() != 4 {
        let found = format!("{} numbers", words.len() - 1);
        return Err(ReadError::at(file, line, "vertex", found, "three numbers"));
    }
    let mut point = [0.0; 3];
    for k in 0..3 {
        let word = &words[k + 1];
        let value = number::real(word).filter(|v| v.is_finite());
        let key = ["coordinate x", "coordinate y", "coordinate z"][k];
        point[k] =
            value.ok_or_else(|| ReadError::at(file, line, key, format!("\"{word}\""), "a finite number"))?;
    }
    Ok(point)
}

#[cfg(test)]
#[path = "stl_tests.rs"]
mod tests;
