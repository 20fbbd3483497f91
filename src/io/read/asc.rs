//! Reader of ESRI ASCII grids (`.asc`): heights on a rectangular grid.
//!
//! `xllcorner`, `yllcorner` are the corner of the lower left cell, `xllcenter`, `yllcenter` its centre;
//! GDAL also writes `dx` and `dy`. Heights start with the northern row.
//!
//! Source: Esri, "Esri ASCII raster format", ArcGIS Desktop help.

use std::path::Path;

use super::error::{Problem, ReadError};
use super::grid::{Grid, MOST_SAMPLES};
use super::mesh_file::read_text;
use super::number;
use super::surface::Surface;

const NAMES: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
];

#[derive(Default)]
struct Head {
    values: [Option<(f64, usize)>; NAMES.len()],
}

impl Head {
    fn get(&self, name: &str) -> Option<(f64, usize)> {
        NAMES.iter().position(|n| *n == name).and_then(|k| self.values[k])
    }

    fn need(&self, file: &Path, name: &str) -> Result<(f64, usize), ReadError> {
        self.get(name).ok_or_else(|| ReadError::whole(file, name, "nothing", "a line with its value"))
    }

    fn count(&self, file: &Path, name: &str) -> Result<usize, ReadError> {
        let (value, line) = self.need(file, name)?;
        let fits = value.fract() == 0.0 && (2.0..=MOST_SAMPLES as f64).contains(&value);
        let fault = || {
            let expected = format!("a whole number from 2 to {MOST_SAMPLES}");
            ReadError::at(file, line, name, value.to_string(), expected)
        };
        if fits { Ok(value as usize) } else { Err(fault()) }
    }

    /// Spacing of columns and rows [m].
    fn step(&self, file: &Path) -> Result<[f64; 2], ReadError> {
        let names = if self.get("cellsize").is_some() || self.get("dx").is_none() {
            ["cellsize"; 2]
        } else {
            ["dx", "dy"]
        };
        let mut step = [0.0; 2];
        for (step, name) in step.iter_mut().zip(names) {
            let (value, line) = self.need(file, name)?;
            if value <= 0.0 {
                return Err(ReadError::at(file, line, name, value.to_string(), "a length above 0"));
            }
            *step = value;
        }
        Ok(step)
    }

    /// Centre of the lower left cell [m].
    fn origin(&self, file: &Path, step: [f64; 2]) -> Result<[f64; 2], ReadError> {
        let mut origin = [0.0; 2];
        for (k, names) in [["xllcorner", "xllcenter"], ["yllcorner", "yllcenter"]].iter().enumerate() {
            origin[k] = match (self.get(names[0]), self.get(names[1])) {
                (Some((corner, _)), None) => corner + 0.5 * step[k],
                (None, Some((centre, _))) => centre,
                (Some(_), Some((_, line))) => {
                    let problem = Problem::conflict(names[0]);
                    return Err(ReadError { problem, ..ReadError::at(file, line, names[1], "", "") });
                }
                (None, None) => self.need(file, names[0])?.0,
            };
        }
        Ok(origin)
    }
}

/// Reads an ESRI ASCII grid as a surface.
///
/// # Errors
/// Missing or invalid header values, unreadable heights, wrong number of heights.
pub fn read_asc(file: &Path) -> Result<Surface, ReadError> {
    parse(file, &read_text(file, "ESRI ASCII grid")?)
}

fn parse(file: &Path, text: &str) -> Result<Surface, ReadError> {
    let mut head = Head::default();
    let mut lines = text.lines().enumerate().map(|(k, line)| (k + 1, line)).peekable();
    while let Some((line, words)) = lines.peek().map(|(n, l)| (*n, l.split_whitespace().collect::<Vec<_>>()))
    {
        if words.first().is_some_and(|w| number::looks_numeric(w) || is_no_number(w)) {
            break;
        }
        lines.next();
        if !words.is_empty() {
            head_line(file, line, &words, &mut head)?;
        }
    }
    let (columns, rows) = (head.count(file, "ncols")?, head.count(file, "nrows")?);
    let step = head.step(file)?;
    let origin = head.origin(file, step)?;
    let count = columns.checked_mul(rows).filter(|n| *n <= MOST_SAMPLES).ok_or_else(|| {
        let found = format!("{columns} times {rows} heights");
        ReadError::whole(file, "ncols and nrows", found, format!("at most {MOST_SAMPLES} in all"))
    })?;
    let absent = head.get("nodata_value").map_or(-9999.0, |(value, _)| value);
    let mut heights = Vec::new();
    for (line, body) in lines {
        for word in body.split_whitespace() {
            let value = number::real(word)
                .ok_or_else(|| ReadError::at(file, line, "height", format!("\"{word}\""), "a number"))?;
            if heights.len() == count {
                let expected = format!("the end after {columns} times {rows} heights");
                return Err(ReadError::at(file, line, "height", format!("\"{word}\""), expected));
            }
            // Some programs write NaN for cells without data.
            let there = value != absent && !value.is_nan();
            if there && value.is_infinite() {
                return Err(ReadError::at(file, line, "height", format!("\"{word}\""), "a finite number"));
            }
            heights.push(there.then_some(value));
        }
    }
    if heights.len() != count {
        let expected = format!("{columns} times {rows}, as in ncols and nrows");
        return Err(ReadError::whole(file, "heights", heights.len().to_string(), expected));
    }
    let corner = [origin[0], origin[1] + (rows - 1) as f64 * step[1]];
    Grid { columns, rows, corner, step, heights }.surface(file)
}

fn head_line(file: &Path, line: usize, words: &[&str], head: &mut Head) -> Result<(), ReadError> {
    let name = words[0].to_ascii_lowercase();
    let Some(place) = NAMES.iter().position(|n| *n == name) else {
        let found: String = words[0].chars().take(40).collect();
        return Err(ReadError::at(file, line, "head", format!("\"{found}\""), NAMES.join(", ")));
    };
    let value = match words {
        [_, value] => number::real(value).filter(|v| v.is_finite() || name == "nodata_value"),
        _ => None,
    };
    let Some(value) = value else {
        let found = format!("\"{}\"", words[1..].join(" "));
        return Err(ReadError::at(file, line, NAMES[place], found, "one finite number"));
    };
    if head.values[place].replace((value, line)).is_some() {
        return Err(ReadError::at(file, line, NAMES[place], "it again", "each name once"));
    }
    Ok(())
}

fn is_no_number(word: &str) -> bool {
    word.eq_ignore_ascii_case("nan")
}

#[cfg(test)]
#[path = "asc_tests.rs"]
mod tests;
