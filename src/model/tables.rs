//! Tables that grains are made from: sphere packings and sieve limits in CSV, stone libraries in TOML.

mod grading;

pub use grading::{Grading, gradation};

use crate::read::{ReadError, source};
use crate::scene::{Document, SceneError};
use std::path::Path;
use trackbed_dem::insert::library::StoneLibrary;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::shape::cluster::Cluster;
use trackbed_dem::shape::dilated::Dilated;

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
    let bytes = source::bytes(file, source::LARGEST).map_err(|refusal| {
        let (found, expected) = refusal.words(|e| e.to_string());
        fault(file, None, what, found, expected)
    })?;
    String::from_utf8(bytes).map_err(|_| fault(file, None, what, "bytes that are no UTF-8", "text"))
}

/// Refuses a row that has not as many columns as the heading, or as there are names where there is none. One number
/// more may be the second half of another: `0,5` for 0.5.
fn check_width(
    file: &Path,
    line: usize,
    fields: &[&str],
    heading: Option<usize>,
    names: &str,
    count: usize,
) -> Result<(), ReadError> {
    let width = heading.unwrap_or(count);
    if fields.len() == width {
        return Ok(());
    }
    let of = if heading.is_some() { ", as in the heading" } else { "" };
    let hint = if fields.len() > width { "; decimals behind a point, not a comma" } else { "" };
    let expected = format!("{names}: {width} columns{of}{hint}");
    Err(fault(file, Some(line), "row", format!("{} columns", fields.len()), expected))
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

/// Rows of numbers under a heading that may be missing; each row starts with the columns named.
fn numbers<const N: usize>(file: &Path, columns: [&str; N]) -> Result<Vec<(usize, [f64; N])>, ReadError> {
    let content = text(file, "packing")?;
    let (mut table, mut heading) = (Vec::new(), None);
    for (n, (line, fields)) in rows(&content).enumerate() {
        if n == 0 && fields[0].parse::<f64>().is_err() {
            // A heading may name more columns, which are passed over.
            heading = Some(fields.len()).filter(|width| *width >= N);
            continue;
        }
        check_width(file, line, &fields, heading, &columns.join(", "), N)?;
        let mut value = [0.0; N];
        for (k, name) in columns.into_iter().enumerate() {
            value[k] = fields[k]
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite())
                .ok_or_else(|| fault(file, Some(line), name, format!("\"{}\"", fields[k]), "a number"))?;
        }
        table.push((line, value));
    }
    if table.is_empty() {
        return Err(fault(file, None, "packing", "no row", "at least one grain"));
    }
    Ok(table)
}

/// Spheres `x, y, z, r` [m] of a packing; a first row that is not numbers is a heading.
///
/// # Errors
/// The file is missing, a row has too few columns, or a value is no finite number.
pub fn packing(file: &Path) -> Result<Vec<([f64; 3], f64)>, ReadError> {
    let row = |(line, [x, y, z, r]): (usize, [f64; 4])| {
        if r > 0.0 {
            return Ok(([x, y, z], r));
        }
        Err(fault(file, Some(line), "r", r.to_string(), "a radius above 0"))
    };
    numbers(file, ["x", "y", "z", "r"])?.into_iter().map(row).collect()
}

/// A stone of a packing, a clump or a polyhedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedStone {
    /// Centre of mass [m].
    pub position: [f64; 3],
    /// Turns the stone's principal frame into the world's: w, x, y, z.
    pub orientation: [f64; 4],
    /// Factor on the lengths of the stone in its library.
    pub scale: f64,
    /// Number of the stone in its library, from 0.
    pub stone: usize,
}

/// Stones `x, y, z` [m], `qw, qx, qy, qz`, `scale`, `stone` of a packing made of `stones` stones; a first row that is not
/// numbers is a heading.
///
/// # Errors
/// The file is missing, a row has too few columns, a value is no finite number, or out of range.
pub fn stone_packing(file: &Path, stones: usize) -> Result<Vec<PlacedStone>, ReadError> {
    let columns = ["x", "y", "z", "qw", "qx", "qy", "qz", "scale", "stone"];
    let row = |(line, v): (usize, [f64; 9])| {
        let orientation = [v[3], v[4], v[5], v[6]];
        let norm = orientation.iter().map(|q| q * q).sum::<f64>();
        if (norm - 1.0).abs() > 1e-6 {
            let found = format!("a norm of {}", norm.sqrt());
            return Err(fault(file, Some(line), "qw, qx, qy, qz", found, "a unit quaternion"));
        }
        if v[7] <= 0.0 {
            return Err(fault(file, Some(line), "scale", v[7].to_string(), "a factor above 0"));
        }
        if v[8].fract() != 0.0 || !(0.0..stones as f64).contains(&v[8]) {
            let expected = format!("the number of a stone of the library, 0 to {}", stones.max(1) - 1);
            return Err(fault(file, Some(line), "stone", v[8].to_string(), expected));
        }
        Ok(PlacedStone { position: [v[0], v[1], v[2]], orientation, scale: v[7], stone: v[8] as usize })
    };
    numbers(file, columns)?.into_iter().map(row).collect()
}

/// Rows `time, factor` [s, -] of a history; a first row that is not numbers is a heading.
///
/// # Errors
/// The file is missing, a row has too few columns, a value is no finite number, or times do not ascend.
pub fn history(file: &Path) -> Result<Vec<(f64, f64)>, ReadError> {
    let content = text(file, "history")?;
    let (mut points, mut heading): (Vec<(f64, f64)>, _) = (Vec::new(), None);
    for (n, (line, fields)) in rows(&content).enumerate() {
        if n == 0 && fields[0].parse::<f64>().is_err() {
            // As in `numbers`.
            heading = Some(fields.len()).filter(|width| *width >= 2);
            continue;
        }
        check_width(file, line, &fields, heading, "time, factor", 2)?;
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

/// The stones of a library file as dilated polyhedra.
///
/// # Errors
/// The file is missing or no library, or a stone is no dilated polyhedron.
pub fn polyhedra(file: &Path) -> Result<Vec<Dilated>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .polyhedra()
        .map_err(|e| document.error("stones", e.to_string(), "convex `corners` and a positive `radius`"))
}

/// The stones of a library file as bonded clusters.
///
/// # Errors
/// The file is missing or no library, or a stone is no cluster.
pub fn clusters(file: &Path) -> Result<Vec<Cluster>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .clusters()
        .map_err(|e| document.error("stones", e.to_string(), "spheres that bonds hold in one piece"))
}

/// Rows `a, b` of bonded pairs, numbers of grains from 0 to `count` − 1; a first row that is not numbers is a heading.
///
/// # Errors
/// The file is missing, or a row is not two different numbers of grains.
pub fn pairs(file: &Path, count: usize) -> Result<Vec<[usize; 2]>, ReadError> {
    let row = |(line, v): (usize, [f64; 2])| {
        let good = |x: f64| x.fract() == 0.0 && (0.0..count as f64).contains(&x);
        if v.iter().all(|x| good(*x)) && v[0] != v[1] {
            return Ok(v.map(|x| x as usize));
        }
        let expected = format!("two different numbers of grains, 0 to {}", count.max(1) - 1);
        Err(fault(file, Some(line), "pair", format!("{}, {}", v[0], v[1]), expected))
    };
    numbers(file, ["a", "b"])?.into_iter().map(row).collect()
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
        let grading = gradation(&path, "X", "A").unwrap();
        assert_eq!(grading.limits.len(), 3);
        assert!(grading.limits[1].iter().zip([0.05, 0.7, 0.9]).all(|(x, y)| (x - y).abs() < 1e-12));
        let curve = grading.curve;
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
