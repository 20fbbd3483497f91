//! Tables that grains are made from: sphere packings and sieve limits in CSV, stone libraries in TOML.

use crate::read::ReadError;
use crate::scene::{Document, SceneError};
use std::path::Path;
use trackbed_dem::insert::gradation::Gradation;
use trackbed_dem::insert::library::StoneLibrary;
use trackbed_dem::shape::clump::Clump;

fn fault(
    file: &Path,
    line: Option<usize>,
    key: &str,
    found: impl Into<String>,
    expected: impl Into<String>,
) -> ReadError {
    ReadError {
        file: file.to_path_buf(),
        line,
        key: key.into(),
        found: found.into(),
        expected: expected.into(),
    }
}

fn text(file: &Path, what: &str) -> Result<String, ReadError> {
    std::fs::read_to_string(file).map_err(|e| fault(file, None, what, e.to_string(), "a readable file"))
}

/// Rows of a CSV file that are neither empty nor comments, with their line numbers; fields trimmed, quotes kept off.
fn rows(content: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    content
        .lines()
        .enumerate()
        .map(|(i, l)| (i + 1, l.trim()))
        .filter(|(_, l)| !l.is_empty() && !l.starts_with('#'))
        .map(|(i, l)| (i, l.split(',').map(|f| f.trim().trim_matches('"')).collect()))
}

/// Spheres `x, y, z, r` [m] of a packing; a first row that is not numbers is a heading.
///
/// # Errors
/// The file is missing, a row has too few columns, or a value is no finite number.
pub fn packing(file: &Path) -> Result<Vec<([f64; 3], f64)>, ReadError> {
    let content = text(file, "packing")?;
    let mut spheres = Vec::new();
    for (n, (line, fields)) in rows(&content).enumerate() {
        if n == 0 && fields[0].parse::<f64>().is_err() {
            continue;
        }
        if fields.len() < 4 {
            return Err(fault(file, Some(line), "row", format!("{} columns", fields.len()), "x, y, z, r"));
        }
        let mut value = [0.0; 4];
        for (k, name) in ["x", "y", "z", "r"].into_iter().enumerate() {
            value[k] = fields[k]
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite())
                .ok_or_else(|| fault(file, Some(line), name, format!("\"{}\"", fields[k]), "a number"))?;
        }
        if value[3] <= 0.0 {
            return Err(fault(file, Some(line), "r", value[3].to_string(), "a radius above 0"));
        }
        spheres.push(([value[0], value[1], value[2]], value[3]));
    }
    if spheres.is_empty() {
        return Err(fault(file, None, "packing", "no row", "at least one sphere"));
    }
    Ok(spheres)
}

/// Rows `time, factor` [s, -] of a history; a first row that is not numbers is a heading.
///
/// # Errors
/// The file is missing, a row has too few columns, a value is no finite number, or times do not ascend.
pub fn history(file: &Path) -> Result<Vec<(f64, f64)>, ReadError> {
    let content = text(file, "history")?;
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (n, (line, fields)) in rows(&content).enumerate() {
        if n == 0 && fields[0].parse::<f64>().is_err() {
            continue;
        }
        if fields.len() < 2 {
            return Err(fault(file, Some(line), "row", format!("{} columns", fields.len()), "time, factor"));
        }
        let number = |k: usize, name: &str| {
            let value = fields[k].parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| fault(file, Some(line), name, format!("\"{}\"", fields[k]), "a number"))
        };
        let (time, factor) = (number(0, "time")?, number(1, "factor")?);
        if let Some(&(before, _)) = points.last()
            && time <= before
        {
            return Err(fault(
                file,
                Some(line),
                "time",
                time.to_string(),
                format!("a time after {before} s"),
            ));
        }
        points.push((time, factor));
    }
    if points.is_empty() {
        return Err(fault(file, None, "history", "no row", "at least one row of time, factor"));
    }
    Ok(points)
}

/// The middle of the limits of one grade of a sieve table.
///
/// # Errors
/// The file is missing, has no such grade, or its limits make no curve.
pub fn gradation(file: &Path, standard: &str, grade: &str) -> Result<Gradation, ReadError> {
    let content = text(file, "gradation")?;
    let mut columns: Option<[usize; 5]> = None;
    let mut table: Vec<[f64; 3]> = Vec::new();
    for (line, fields) in rows(&content) {
        let Some([s, g, size, low, high]) = columns else {
            let names = ["standard", "grade", "sieve_mm", "passing_lo_pct", "passing_hi_pct"];
            let mut found = [0; 5];
            for (k, name) in names.into_iter().enumerate() {
                found[k] = fields.iter().position(|f| *f == name).ok_or_else(|| {
                    fault(file, Some(line), name, "no such column", format!("columns {}", names.join(", ")))
                })?;
            }
            columns = Some(found);
            continue;
        };
        let field = |k: usize| fields.get(k).copied().unwrap_or_default();
        if field(s) != standard || field(g) != grade {
            continue;
        }
        let number = |k: usize, name: &str| {
            field(k)
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite())
                .ok_or_else(|| fault(file, Some(line), name, format!("\"{}\"", field(k)), "a number"))
        };
        table.push([
            1e-3 * number(size, "sieve_mm")?,
            1e-2 * number(low, "passing_lo_pct")?,
            1e-2 * number(high, "passing_hi_pct")?,
        ]);
    }
    if table.is_empty() {
        return Err(fault(
            file,
            None,
            "gradation",
            format!("no row of {standard} {grade}"),
            "rows of this grade",
        ));
    }
    table.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Sieves that everything passes carry no information beyond the first of them.
    let full = table.iter().position(|r| r[1] + r[2] >= 2.0).unwrap_or(table.len() - 1);
    table.truncate(full + 1);
    let column = |k: usize| table.iter().map(|r| r[k]).collect::<Vec<_>>();
    Gradation::from_limits(&column(0), &column(1), &column(2), None)
        .map_err(|e| fault(file, None, "gradation", e.to_string(), "limits that make a curve"))
}

/// The stones of a library file.
///
/// # Errors
/// The file is missing or no library, or a stone is no clump.
pub fn stones(file: &Path) -> Result<Vec<Clump>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .clumps()
        .map_err(|e| document.error("stones", e.to_string(), "connected spheres with positive radii"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, content: &str) -> std::path::PathBuf {
        let path = std::env::temp_dir().join(format!("trackbed-{}-{name}", std::process::id()));
        std::fs::write(&path, content).unwrap();
        path
    }

    #[test]
    fn a_grade_is_the_middle_of_its_limits() {
        let path = file(
            "sieves.csv",
            "# note\nstandard,grade,sieve_mm,passing_lo_pct,passing_hi_pct\nX,A,63,100,100\nX,A,50,70,90\nX,B,50,0,1\nX,A,31.5,0,0\n",
        );
        let curve = gradation(&path, "X", "A").unwrap();
        assert_eq!(curve.sizes().len(), 3);
        assert!((curve.passing_at(0.05) - 0.8).abs() < 1e-12);
        let error = gradation(&path, "X", "C").unwrap_err();
        assert!(error.to_string().contains("no row of X C"), "{error}");
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_bad_packing_names_line_and_column() {
        let path = file("packing.csv", "x,y,z,r\n0,0,0,0.1\n0,zero,0,0.1\n");
        let error = packing(&path).unwrap_err().to_string();
        assert!(error.ends_with(":3: y: found \"zero\", expected a number"), "{error}");
        std::fs::remove_file(path).unwrap();
    }
}
