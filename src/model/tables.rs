//! Grain tables: packings and sieve limits in CSV, libraries in TOML.

mod grading;
mod heading;

pub use grading::{Grading, gradation};
pub use heading::{Column, FACTOR, FORCE};

use crate::read::{ReadError, source};
use crate::scene::{Document, SceneError};
use std::io::{BufRead, BufReader};
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
    ReadError { line, ..ReadError::whole(file, key, found, expected) }
}

fn text(file: &Path, what: &str) -> Result<String, ReadError> {
    let mut text = String::new();
    each_line(file, what, |_, line| {
        text.push_str(line);
        text.push('\n');
        Ok(())
    })?;
    Ok(text)
}

/// Without byte order mark.
fn each_line(
    file: &Path,
    what: &str,
    mut take: impl FnMut(usize, &str) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let refused = |refusal: source::Refusal| {
        let (found, expected) = refusal.words(|e| e.to_string());
        fault(file, None, what, found, expected)
    };
    let mut reader = BufReader::new(source::open(file, source::LARGEST).map_err(refused)?);
    let (mut line, mut bytes) = (0, Vec::new());
    loop {
        bytes.clear();
        if reader.read_until(b'\n', &mut bytes).map_err(|e| refused(e.into()))? == 0 {
            return Ok(());
        }
        line += 1;
        let text = std::str::from_utf8(&bytes)
            .map_err(|_| fault(file, None, what, "bytes that are no UTF-8", "text"))?;
        take(line, text.strip_prefix('\u{feff}').filter(|_| line == 1).unwrap_or(text).trim_end())?;
    }
}

/// One extra field may be a decimal comma: `0,5` for 0.5.
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

/// Trimmed, unquoted fields; `None` for blank lines and comments.
fn fields(line: &str) -> Option<Vec<&str>> {
    let line = line.trim();
    let data = !line.is_empty() && !line.starts_with('#');
    data.then(|| line.split(',').map(|f| f.trim().trim_matches('"')).collect())
}

fn rows(content: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    (1..).zip(content.lines()).filter_map(|(i, line)| Some((i, fields(line)?)))
}

/// SI units below an optional heading; named columns come first.
fn numbers<const N: usize>(
    file: &Path,
    what: &str,
    columns: &[Column; N],
    mut take: impl FnMut(usize, [f64; N]) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let (mut first, mut heading, mut factors) = (true, None, [1.0; N]);
    let names = columns.iter().map(|column| column.name).collect::<Vec<_>>().join(", ");
    each_line(file, what, |line, text| {
        let Some(fields) = fields(text) else { return Ok(()) };
        if std::mem::take(&mut first) && fields[0].parse::<f64>().is_err() {
            // A heading may name further columns.
            heading = Some(fields.len()).filter(|width| *width >= N);
            factors = heading::factors(file, line, &fields, columns)?;
            return Ok(());
        }
        check_width(file, line, &fields, heading, &names, N)?;
        let mut value = [0.0; N];
        for (k, column) in columns.iter().enumerate() {
            let number = fields[k].parse::<f64>().ok().map(|v| v * factors[k]).filter(|v| v.is_finite());
            let wrong = || fault(file, Some(line), column.name, format!("\"{}\"", fields[k]), "a number");
            value[k] = number.ok_or_else(wrong)?;
        }
        take(line, value)
    })
}

fn table<const N: usize>(file: &Path, columns: &[Column; N]) -> Result<Vec<(usize, [f64; N])>, ReadError> {
    let mut table = Vec::new();
    numbers(file, "packing", columns, |line, row| {
        table.push((line, row));
        Ok(())
    })?;
    if table.is_empty() {
        return Err(fault(file, None, "packing", "no row", "at least one grain"));
    }
    Ok(table)
}

const X: Column = Column::length("x", &["x"]);
const Y: Column = Column::length("y", &["y"]);
const Z: Column = Column::length("z", &["z"]);

/// Reads spheres `x, y, z, r` [m], with optional heading.
///
/// # Errors
/// Missing file, or invalid rows.
pub fn packing(file: &Path) -> Result<Vec<([f64; 3], f64)>, ReadError> {
    let row = |(line, [x, y, z, r]): (usize, [f64; 4])| {
        if r > 0.0 {
            return Ok(([x, y, z], r));
        }
        Err(fault(file, Some(line), "r", r.to_string(), "a radius above 0"))
    };
    let radius = Column::length("r", &["r", "radius"]);
    table(file, &[X, Y, Z, radius])?.into_iter().map(row).collect()
}

/// Clump or polyhedron of a packing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedStone {
    /// Centre of mass [m].
    pub position: [f64; 3],
    /// Quaternion, principal to world axes: w, x, y, z.
    pub orientation: [f64; 4],
    /// Scale relative to the library.
    pub scale: f64,
    /// Library index, from 0.
    pub stone: usize,
}

/// Reads grains `x, y, z` [m], `qw, qx, qy, qz`, `scale`, `stone` of a library of `stones`, with optional
/// heading.
///
/// # Errors
/// Missing file, or invalid rows.
pub fn stone_packing(file: &Path, stones: usize) -> Result<Vec<PlacedStone>, ReadError> {
    let [qw, qx] = [Column::number("qw", &["qw"]), Column::number("qx", &["qx"])];
    let [qy, qz] = [Column::number("qy", &["qy"]), Column::number("qz", &["qz"])];
    let [scale, stone] = [Column::number("scale", &["scale"]), Column::number("stone", &["stone"])];
    let columns = [X, Y, Z, qw, qx, qy, qz, scale, stone];
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
    table(file, &columns)?.into_iter().map(row).collect()
}

/// Reads time and `value` in SI units, with optional heading.
///
/// # Errors
/// Missing file, invalid rows, unordered times, wrong heading.
pub fn history(file: &Path, value: Column) -> Result<Vec<(f64, f64)>, ReadError> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let name = value.name;
    numbers(file, "history", &[heading::TIME, value], |line, [time, value]| {
        if let Some(&(before, _)) = points.last()
            && time <= before
        {
            let expected = format!("a time after {before} s");
            return Err(fault(file, Some(line), "time", time.to_string(), expected));
        }
        points.push((time, value));
        Ok(())
    })?;
    if points.is_empty() {
        let expected = format!("at least one row of time, {name}");
        return Err(fault(file, None, "history", "no row", expected));
    }
    points.shrink_to_fit();
    Ok(points)
}

/// Reads a library of clumps.
///
/// # Errors
/// Missing file, or other grains.
pub fn stones(file: &Path) -> Result<Vec<Clump>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .clumps()
        .map_err(|e| document.error("stones", e.to_string(), "connected spheres with positive radii"))
}

/// Reads a library of dilated polyhedra.
///
/// # Errors
/// Missing file, or other grains.
pub fn polyhedra(file: &Path) -> Result<Vec<Dilated>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .polyhedra()
        .map_err(|e| document.error("stones", e.to_string(), "convex `corners` and a positive `radius`"))
}

/// Reads a library of bonded clusters.
///
/// # Errors
/// Missing file, or other grains.
pub fn clusters(file: &Path) -> Result<Vec<Cluster>, SceneError> {
    let document = Document::open(file)?;
    let library: StoneLibrary = document.read()?;
    library
        .clusters()
        .map_err(|e| document.error("stones", e.to_string(), "spheres that bonds hold in one piece"))
}

/// Reads bonded pairs `a, b` of indices below `count`, with optional heading.
///
/// # Errors
/// Missing file, or invalid pairs.
pub fn pairs(file: &Path, count: usize) -> Result<Vec<[usize; 2]>, ReadError> {
    let row = |(line, v): (usize, [f64; 2])| {
        let good = |x: f64| x.fract() == 0.0 && (0.0..count as f64).contains(&x);
        if v.iter().all(|x| good(*x)) && v[0] != v[1] {
            return Ok(v.map(|x| x as usize));
        }
        let expected = format!("two different numbers of grains, 0 to {}", count.max(1) - 1);
        Err(fault(file, Some(line), "pair", format!("{}, {}", v[0], v[1]), expected))
    };
    let columns = [Column::number("a", &[]), Column::number("b", &[])];
    table(file, &columns)?.into_iter().map(row).collect()
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
    fn grade_is_mean_of_limits() {
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
        let error = gradation(&path, "X", "C").unwrap_err().to_string();
        let spelled = gradation(&path, " x", "a ").unwrap();
        assert_eq!(spelled.limits, grading.limits);
        assert!(error.contains("\"X\" \"C\", expected one of X A, X B"), "{error}");
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn bad_packing_reports_position() {
        let path = file("packing.csv", "x,y,z,r\n0,0,0,0.1\n0,zero,0,0.1\n");
        let error = packing(&path).unwrap_err().to_string();
        assert!(error.ends_with(":3: y: found \"zero\", expected a number"), "{error}");
        std::fs::remove_file(path).unwrap();
    }
}
