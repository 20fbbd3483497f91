//! Packing files: initial spheres.
//!
//! Rows `x y z r`, optionally after an index; a first row of one number is the count.

use super::rows;
use std::path::Path;
use trackbed_io::columns::converted;
use trackbed_io::failure::Failure;
use trackbed_io::read::{ReadError, number};
use trackbed_io::write::csv::{Field, write_table};

const COLUMNS: [Field<[f64; 4]>; 4] =
    [(converted::X, |s| s[0]), (converted::Y, |s| s[1]), (converted::Z, |s| s[2]), (converted::R, |s| s[3])];

/// Reads the spheres of a packing.
///
/// # Errors
/// Damaged lines.
pub fn parse(file: &Path, text: &str) -> Result<Vec<[f64; 4]>, ReadError> {
    let mut spheres = Vec::new();
    let mut count = None;
    for (line, body) in text.lines().enumerate().map(|(k, l)| (k + 1, l.trim())) {
        if body.is_empty() || !number::looks_numeric(body) && spheres.is_empty() {
            continue;
        }
        let row = rows::numbers(file, line, body)?;
        match row[..] {
            [n] if spheres.is_empty() && count.is_none() => count = Some(n),
            [x, y, z, r] | [_, x, y, z, r] => {
                if r <= 0.0 {
                    return Err(ReadError::at(file, line, "radius", r.to_string(), "above 0"));
                }
                spheres.push([x, y, z, r]);
            }
            _ => {
                let expected = "x y z r, or these behind a number";
                return Err(ReadError::at(file, line, "columns", row.len().to_string(), expected));
            }
        }
    }
    if let Some(n) = count.filter(|n| *n != spheres.len() as f64) {
        let expected = format!("{n}, as in the first row");
        return Err(ReadError::whole(file, "spheres", spheres.len().to_string(), expected));
    }
    if spheres.is_empty() {
        return Err(ReadError::whole(
            file,
            "spheres",
            "none",
            "a packing, an animation, force chains, or a deck",
        ));
    }
    Ok(spheres)
}

/// Writes a packing in trackbed's format.
///
/// # Errors
/// Damaged lines; I/O errors.
pub fn convert((file, text): (&Path, &str), output: &Path) -> Result<Vec<String>, Failure> {
    let spheres = parse(file, text)?;
    write_table(output, &COLUMNS, &spheres)?;
    Ok(vec![format!("{} spheres", spheres.len())])
}
