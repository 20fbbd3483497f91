//! Grain tables: packings and sieve limits in CSV, libraries in TOML.

mod grading;
mod heading;
mod separator;

pub use grading::{Grading, gradation};
pub use heading::{Column, FACTOR, FORCE};

use crate::scene::{Document, SceneError};
use heading::Heading;
use separator::Separators;
use std::io::{BufRead, BufReader};
use std::path::Path;
use trackbed_dem::insert::library::StoneLibrary;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::shape::cluster::Cluster;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_io::read::{FARTHEST, ReadError, number, source, unit};

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

/// Data below an optional heading, in SI units; named columns in any order.
struct Sheet<'a, const N: usize> {
    file: &'a Path,
    columns: &'a [Column; N],
    /// Names of columns that would be lost.
    unread: &'a [&'a str],
    separators: Option<Separators>,
    heading: Option<Heading<N>>,
    /// Line and fields of a comment that names all columns.
    stated: Option<(usize, Vec<String>)>,
    begun: bool,
}

impl<const N: usize> Sheet<'_, N> {
    fn fault(
        &self,
        line: usize,
        key: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> ReadError {
        fault(self.file, Some(line), key, found, expected)
    }

    /// Values of a row; `None` for blank lines, comments and headings.
    fn row(&mut self, line: usize, text: &str) -> Result<Option<[f64; N]>, ReadError> {
        let body = text.trim();
        if let Some(comment) = body.strip_prefix('#').filter(|_| !self.begun) {
            self.comment(line, comment)?;
        }
        if body.is_empty() || body.starts_with('#') {
            return Ok(None);
        }
        let first = self.separators.is_none();
        let mut separators = self.separators.unwrap_or_else(|| Separators::of(body));
        let fields = separators.fields(body);
        if first && !number::looks_numeric(fields[0]) {
            self.read_heading(line, &fields)?;
            self.separators = Some(separators);
            return Ok(None);
        }
        if !std::mem::replace(&mut self.begun, true)
            && self.heading.is_none()
            && let Some((line, names)) = self.stated.take()
            && names.len() == fields.len()
        {
            self.read_heading(line, &names.iter().map(String::as_str).collect::<Vec<_>>())?;
        }
        self.check_width(line, body, fields.len(), separators)?;
        let mut value = [0.0; N];
        for (k, column) in self.columns.iter().enumerate() {
            let (at, factor) = self.heading.map_or((k, 1.0), |heading| heading.columns[k]);
            let number = separators.number(fields[at]).map(|v| v * factor);
            let number = number.and_then(|v| if v.is_finite() { Ok(v) } else { Err("a number") });
            let wrong = |expected| self.fault(line, column.name, format!("\"{}\"", fields[at]), expected);
            value[k] = number.map_err(wrong)?;
        }
        self.separators = Some(separators);
        Ok(Some(value))
    }

    fn read_heading(&mut self, line: usize, fields: &[&str]) -> Result<(), ReadError> {
        self.heading = Some(Heading::read(self.file, line, fields, self.columns)?);
        let lost = |field: &&&str| self.unread.contains(&field.to_lowercase().as_str());
        match fields.iter().find(lost) {
            None => Ok(()),
            Some(field) => {
                let names = self.columns.iter().map(|column| column.name).collect::<Vec<_>>().join(", ");
                let expected =
                    format!("{names}, without motion, which is a key of [[grains]] such as `velocity`");
                Err(self.fault(line, "heading", format!("the column {field}"), expected))
            }
        }
    }

    /// A comment may state units or name the columns.
    fn comment(&mut self, line: usize, comment: &str) -> Result<(), ReadError> {
        let comment = comment.trim_start_matches('#').trim();
        let fields = Separators::of(comment).fields(comment);
        let found = match Heading::is_stated(&fields, self.columns) {
            true => None,
            false => heading::foreign_unit(&fields, self.columns).map(str::to_string),
        };
        if let Some(found) = found.or_else(|| unit::stated(comment)) {
            let expected = "SI units, or a heading without # that states the unit, such as \"time [ms]\"";
            return Err(self.fault(line, "unit of the comment", format!("\"{found}\""), expected));
        }
        if Heading::is_stated(&fields, self.columns) {
            self.stated = Some((line, fields.into_iter().map(String::from).collect()));
        }
        Ok(())
    }

    /// One extra field may be a decimal comma: `0,5` for 0.5.
    fn check_width(
        &self,
        line: usize,
        body: &str,
        found: usize,
        separators: Separators,
    ) -> Result<(), ReadError> {
        let width = self.heading.map_or(N, |heading| heading.width);
        if found == width {
            return Ok(());
        }
        let names = self.columns.iter().map(|column| column.name).collect::<Vec<_>>().join(", ");
        let of = if self.heading.is_some() { ", as in the heading" } else { "" };
        let hint = separators.hint(body, found > width);
        let columns = if found == 1 { "1 column".to_string() } else { format!("{found} columns") };
        Err(self.fault(line, "row", columns, format!("{names}: {width} columns{of}{hint}")))
    }
}

/// Rows of numbers in SI units; `unread`: names of columns that would be lost.
fn numbers<const N: usize>(
    file: &Path,
    key: &str,
    columns: &[Column; N],
    unread: &[&str],
    mut take: impl FnMut(usize, [f64; N]) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let mut sheet =
        Sheet { file, columns, unread, separators: None, heading: None, stated: None, begun: false };
    each_line(file, key, |line, text| match sheet.row(line, text)? {
        Some(row) => take(line, row),
        None => Ok(()),
    })
}

/// Motion of grains.
const MOTION: [&str; 16] = [
    "vx", "vy", "vz", "v_x", "v_y", "v_z", "wx", "wy", "wz", "w_x", "w_y", "w_z", "omega_x", "omega_y",
    "omega_z", "velocity",
];

fn table<const N: usize>(file: &Path, columns: &[Column; N]) -> Result<Vec<(usize, [f64; N])>, ReadError> {
    let mut table = Vec::new();
    numbers(file, "packing", columns, &MOTION, |line, row| {
        table.push((line, row));
        Ok(())
    })?;
    if table.is_empty() {
        return Err(fault(file, None, "packing", "no row", "at least one grain"));
    }
    Ok(table)
}

fn within_range(file: &Path, line: usize, values: &[f64]) -> Result<(), ReadError> {
    match values.iter().find(|v| v.abs() > FARTHEST) {
        None => Ok(()),
        Some(v) => {
            Err(fault(file, Some(line), "row", format!("{v:e}"), format!("lengths up to {FARTHEST:e} m")))
        }
    }
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
        within_range(file, line, &[x, y, z, r])?;
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
        within_range(file, line, &[v[0], v[1], v[2], v[7]])?;
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
/// Missing file, invalid rows, unordered times, heading without the columns.
pub fn history(file: &Path, value: Column) -> Result<Vec<(f64, f64)>, ReadError> {
    curve(file, "history", heading::TIME, value)
}

/// Reads heights over ascending positions, with optional heading [m].
///
/// # Errors
/// Missing file, invalid rows, unordered positions, heading without the columns.
pub fn profile(file: &Path) -> Result<Vec<(f64, f64)>, ReadError> {
    let position = Column::length("position", &["position", "x", "distance", "chainage"]);
    curve(file, "profile", position, Column::length("height", &["height", "z", "irregularity"]))
}

/// Values over an ascending first column.
fn curve(file: &Path, what: &str, over: Column, value: Column) -> Result<Vec<(f64, f64)>, ReadError> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let ([first, second], unit) = ([over.name, value.name], over.si_unit());
    numbers(file, what, &[over, value], &[], |line, [x, value]| {
        if let Some(&(before, _)) = points.last()
            && x <= before
        {
            let expected = format!("a {first} after {before} {unit}");
            return Err(fault(file, Some(line), first, x.to_string(), expected));
        }
        points.push((x, value));
        Ok(())
    })?;
    if points.is_empty() {
        let expected = format!("at least one row of {first}, {second}");
        return Err(fault(file, None, what, "no row", expected));
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
    let columns = [Column::number("a", &["a"]).of_any_name(), Column::number("b", &["b"]).of_any_name()];
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
        let german = "Standard;grade;sieve_mm;passing_lo_pct;passing_hi_pct\nX;A;63,0;100;100\nX;A;50,0;70;90\nX;A;31,5;0;0\n";
        std::fs::write(&path, german).unwrap();
        assert_eq!(gradation(&path, "X", "A").unwrap().limits, grading.limits);
        std::fs::write(&path, german.replace(';', ",")).unwrap();
        let error = gradation(&path, "X", "A").unwrap_err().to_string();
        assert!(
            error.contains(":2: columns: found 6, expected 5, as in the heading; decimals behind"),
            "{error}"
        );
        std::fs::write(&path, german.replace("sieve_mm", "sieve")).unwrap();
        let error = gradation(&path, "X", "A").unwrap_err().to_string();
        assert!(error.contains(":1: sieve_mm: found columns Standard, grade, sieve, passing"), "{error}");
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn bad_packing_reports_position() {
        let path = file("packing.csv", "x,y,z,r\n0,0,0,0.1\n0,zero,0,0.1\n");
        let error = packing(&path).unwrap_err().to_string();
        assert!(error.ends_with(":3: y: found \"zero\", expected a number"), "{error}");
        std::fs::remove_file(path).unwrap();
    }

    fn points(content: &str, value: Column) -> Result<Vec<(f64, f64)>, String> {
        static NUMBER: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);
        let number = NUMBER.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let path = file(&format!("history-{number}.csv"), content);
        let points = history(&path, value).map_err(|e| e.to_string());
        std::fs::remove_file(&path).unwrap();
        points.map_err(|e| e.replace(&*path.to_string_lossy(), "f.csv"))
    }

    #[test]
    fn history_reads_named_columns_and_separators() {
        for content in [
            "time,displacement,force\n0,0.001,1000\n0.5,0.002,5000\n",
            "displacement;force [kN];time\n0,001;1,0;0,0\n0,002;5,0;0,5\n",
            "time\tforce\n0\t1000\n0.5\t5000\n",
            "0;1000\n0,5;5000\n",
            "# force [kN],time [ms]\n1,0\n5,500\n",
            "\u{feff}# measured at km 4, 20 mm below the rail\n# units: s, N\ntime,force\n0,1000\n0.5,5000\n",
            "time,force\n# time in milliseconds of the recorder below\n0,1000\n0.5,5000\n# units: ms\n",
        ] {
            assert_eq!(points(content, FORCE).unwrap(), [(0.0, 1000.0), (0.5, 5000.0)], "{content}");
        }
    }

    #[test]
    fn history_rejects_other_columns_and_units() {
        for (content, message) in [
            (
                "time,displacement,stress\n0,1,2\n",
                "f.csv:1: heading: found columns time, displacement, stress, expected a column of force",
            ),
            ("# time in milliseconds\n0,1\n", "f.csv:1: unit of the comment: found \"time in milliseconds\""),
            ("time,force\n# units: ms, kN\n0,1\n", "f.csv:2: unit of the comment: found \"ms\""),
            (
                "# force [t],time\n1,0\n",
                "f.csv:1: force: found \"force [t]\", expected one of the units N, kN, MN",
            ),
            ("time;force\n0,5;1000\n0.7;2000\n", "f.csv:3: time: found \"0.7\", expected decimal points or"),
            (
                "time\tforce\n0,5\t1000\n",
                "f.csv:2: time: found \"0,5\", expected a number with a decimal point",
            ),
            (
                "time,force\n0;1000\n",
                "f.csv:2: row: found 1 column, expected time, force: 2 columns, as in the heading, between commas",
            ),
            (
                "0 1000\n",
                "f.csv:1: row: found 1 column, expected time, force: 2 columns, between commas, semicolons or",
            ),
        ] {
            let error = points(content, FORCE).unwrap_err();
            assert!(error.starts_with(message), "{content}: {error}");
        }
    }

    #[test]
    fn packing_names_lost_motion() {
        let path = file("far.csv", "x,y,z,r\n1e300,0,0,0.1\n");
        let error = packing(&path).unwrap_err().to_string();
        assert!(error.ends_with(":2: row: found 1e300, expected lengths up to 1e15 m"), "{error}");
        std::fs::remove_file(path).unwrap();
        let path = file("motion.csv", "id,z,y,x,radius,note\n7,3,2,1,0.5,a\n");
        assert_eq!(packing(&path).unwrap(), [([1.0, 2.0, 3.0], 0.5)]);
        std::fs::write(&path, "x,y,z,r,vx\n1,2,3,0.5,2\n").unwrap();
        let error = packing(&path).unwrap_err().to_string();
        assert!(
            error.contains("heading: found the column vx, expected x, y, z, r, without motion"),
            "{error}"
        );
        std::fs::remove_file(path).unwrap();
    }
}
