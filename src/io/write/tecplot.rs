//! Solid for Tecplot: ASCII `.dat` file, one FEBRICK zone in blocks, with the fields of the VTK files.
//!
//! Tecplot has no 20-node brick. Each hex20 becomes eight bricks; missing points follow from its shape
//! functions:
//!
//! - face centre: half the sum of the four mid-sides less a quarter of the sum of the four corners;
//! - body centre: a quarter of the sum of the twelve mid-sides less a quarter of the sum of the eight
//!   corners.
//!
//! `eps_p` is clipped at 0, since corner weights are negative. Other kinds become one brick with repeated
//! corners.
//!
//! Source of the format: Tecplot 360 Data Format Guide, ASCII data, finite-element zones.

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use trackbed_fem::ElementKind;
use trackbed_fem::element::hex20;
use trackbed_fem::stress;

use crate::read::degenerate::to_brick;

use super::atomic;
use super::choice::Choice;
use super::error::{WriteError, check_field};
use super::frame::{Frame, NodalValues, SolidFrame};
use super::writer::{Format, Mark, Part, Writer};

/// Short names of fields; others keep theirs, tensors with `_`.
const SHORT: [(&str, &str); 6] = [
    ("displacement", "u"),
    ("velocity", "v"),
    ("stress", "s"),
    ("strain", "e"),
    ("plastic_strain", "ep"),
    ("equivalent_plastic_strain", "eps_p"),
];

const AXES: [&str; 3] = ["x", "y", "z"];
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// Values per line, far below the limit of 32,000 characters.
const PER_LINE: usize = 8;

/// 3x3x3 lattice, first axis fastest: 0–19 nodes, 20–25 face centres, 26 body centre.
const LATTICE: [usize; 27] =
    [0, 8, 1, 11, 20, 9, 3, 10, 2, 16, 21, 17, 24, 26, 22, 19, 23, 18, 4, 12, 5, 15, 25, 13, 7, 14, 6];

const BRICK: [usize; 8] = [0, 1, 4, 3, 9, 10, 13, 12];

const LOWEST: [usize; 8] = [0, 1, 3, 4, 9, 10, 12, 13];

/// Solid, one file per frame.
pub const FORMAT: Format = Format {
    key: "tecplot",
    default: false,
    parts: &[Part::Solid],
    folder: "tecplot",
    endings: &["dat"],
    files: &[],
    begin,
};

struct Tecplot {
    folder: PathBuf,
}

fn begin(dir: &Path, _: Option<&Mark>) -> Result<Box<dyn Writer>, WriteError> {
    Ok(Box::new(Tecplot { folder: dir.join(FORMAT.folder) }))
}

impl Writer for Tecplot {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError> {
        let Some(solid) = &frame.solid else { return Ok(()) };
        let file = self.folder.join(format!("solid_{:05}.dat", frame.number));
        write_solid(&file, solid, frame.fields, ("solid", frame.time, 1))
    }
}

/// Writes the solid as a zone of name, time [s], strand; files of one strand (≥ 1) form a time series.
///
/// # Errors
/// Wrong field length, non-finite values; I/O errors.
pub fn write_solid(
    file: &Path,
    frame: &SolidFrame,
    choice: Choice<'_>,
    zone: (&str, f64, u32),
) -> Result<(), WriteError> {
    let n = frame.mesh.node_count();
    check_field(file, "time", &[zone.1], 1, 1)?;
    check_field(file, "coordinates", frame.mesh.coordinates.as_flattened(), 3, n)?;
    for &(name, ref values) in &frame.fields {
        match values {
            NodalValues::Numbers(values) => check_field(file, name, values, 1, n)?,
            NodalValues::Vectors(values) => check_field(file, name, values, 3, n)?,
            NodalValues::Tensors(values) => check_field(file, name, values.as_flattened(), 6, n)?,
        }
    }
    let (bricks, centres) = split(frame);
    let columns = columns(frame, choice, &centres);
    atomic::write(file, |out| write_text(out, frame, zone, &columns, &bricks).map_err(WriteError::io(file)))
}

/// Brick: point indices from 0, nodes first, and element.
type Brick = ([usize; 8], usize);

/// Nodes and weights of an additional point.
type Centre = Vec<(usize, f64)>;

struct Column {
    name: String,
    values: Vec<f64>,
}

/// Variables at nodes, then at additional points.
fn columns(frame: &SolidFrame, choice: Choice<'_>, centres: &[Centre]) -> Vec<Column> {
    let n = frame.mesh.node_count();
    let column = |name: String, at: &dyn Fn(usize) -> f64| {
        let sum = |centre: &Centre| centre.iter().map(|(node, weight)| weight * at(*node)).sum::<f64>();
        Column { name, values: (0..n).map(at).chain(centres.iter().map(sum)).collect() }
    };
    let place = |axis: usize| column(AXES[axis].into(), &move |node| frame.mesh.coordinates[node][axis]);
    let mut all: Vec<Column> = (0..3).map(place).collect();
    let stress = frame.fields.iter().find_map(|field| match field {
        ("stress", NodalValues::Tensors(values)) => Some(&values[..]),
        _ => None,
    });
    for &(name, ref values) in &frame.fields {
        if !choice.has(name) {
            continue;
        }
        let short = SHORT.iter().find(|(long, _)| *long == name).map(|(_, short)| *short);
        match values {
            NodalValues::Vectors(values) => {
                let stem = short.map_or_else(|| format!("{name}_"), String::from);
                all.extend((0..3).map(|k| column(format!("{stem}{}", AXES[k]), &move |i| values[3 * i + k])));
                if name == "displacement" {
                    let first = all.len() - 3;
                    let length = |p: usize| (0..3).map(|k| all[first + k].values[p].powi(2)).sum::<f64>();
                    let values = (0..all[first].values.len()).map(|p| length(p).sqrt()).collect();
                    all.push(Column { name: stem, values });
                }
            }
            NodalValues::Tensors(values) => {
                let stem = short.map_or_else(|| format!("{name}_"), String::from);
                let of = |k: usize| column(format!("{stem}{}", COMPONENTS[k]), &move |i| values[i][k]);
                all.extend((0..6).map(of));
            }
            NodalValues::Numbers(values) => {
                let mut added = column(short.unwrap_or(name).into(), &|i| values[i]);
                for (value, centre) in added.values[n..].iter_mut().zip(centres) {
                    match (name, stress) {
                        // Not linear in the stress.
                        ("von_mises", Some(stress)) => *value = von_mises(stress, centre),
                        ("equivalent_plastic_strain", _) => *value = value.max(0.0),
                        _ => {}
                    }
                }
                all.push(added);
            }
        }
    }
    let ids = |node: usize| f64::from(frame.mesh.node_ids[node]);
    let none = std::iter::repeat_n(0.0, centres.len());
    all.push(Column { name: "node_id".into(), values: (0..n).map(ids).chain(none).collect() });
    all
}

fn von_mises(stress: &[[f64; 6]], centre: &Centre) -> f64 {
    let sum = |k: usize| centre.iter().map(|(node, weight)| weight * stress[*node][k]).sum();
    stress::von_mises(&std::array::from_fn(sum))
}

fn write_text(
    out: &mut dyn Write,
    frame: &SolidFrame,
    (zone, time, strand): (&str, f64, u32),
    columns: &[Column],
    bricks: &[Brick],
) -> std::io::Result<()> {
    let (n, zone) = (frame.mesh.node_count(), zone.replace('"', "'"));
    writeln!(out, "# SI units; coordinates undeformed; stress tension positive.")?;
    writeln!(
        out,
        "# Each 20-node element is split into 8 bricks; points 1 to {n} are the nodes, the rest are"
    )?;
    writeln!(out, "# face and body centres, interpolated with the shape functions of the 20-node element.")?;
    writeln!(out, "TITLE = \"{zone}\"")?;
    let cells = frame.element_fields();
    let names = columns.iter().map(|c| c.name.as_str()).chain(cells.iter().map(|(name, _)| *name));
    writeln!(out, "VARIABLES = {}", names.map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" "))?;
    let points = columns.first().map_or(0, |c| c.values.len());
    writeln!(out, "ZONE T=\"{zone}\", N={points}, E={},", bricks.len())?;
    writeln!(out, "DATAPACKING=BLOCK, ZONETYPE=FEBRICK, STRANDID={strand}, SOLUTIONTIME={time:e},")?;
    let first = columns.len() + 1;
    writeln!(out, "VARLOCATION=([{first}-{}]=CELLCENTERED)", columns.len() + cells.len())?;
    for column in columns {
        write_block(out, column.values.iter().map(|value| format!("{value:.9e}")))?;
    }
    for (_, values) in cells {
        write_block(out, bricks.iter().map(|(_, element)| values[*element].to_string()))?;
    }
    for (brick, _) in bricks {
        let line = brick.iter().map(|p| (p + 1).to_string()).collect::<Vec<_>>().join(" ");
        writeln!(out, "{line}")?;
    }
    Ok(())
}

fn write_block(out: &mut dyn Write, values: impl Iterator<Item = String>) -> std::io::Result<()> {
    let values: Vec<String> = values.collect();
    values.chunks(PER_LINE).try_for_each(|line| writeln!(out, "{}", line.join(" ")))
}

/// Small bricks and additional points.
fn split(frame: &SolidFrame) -> (Vec<Brick>, Vec<Centre>) {
    let mesh = frame.mesh;
    let n = mesh.node_count();
    let mut extra: Vec<Centre> = Vec::new();
    let mut centres: HashMap<[u32; 4], usize> = HashMap::new();
    let mut bricks = Vec::with_capacity(8 * mesh.element_count());
    for (at, (element, &kind)) in mesh.connectivity.iter().zip(mesh.connectivity.kinds()).enumerate() {
        if kind != ElementKind::Hex20 {
            let brick = to_brick(kind.linear(), &element[..kind.corner_count()]);
            bricks.push((std::array::from_fn(|c| brick[c] as usize), at));
            continue;
        }
        let mut points = [0; 27];
        for local in 0..hex20::NODES {
            points[local] = element[local] as usize;
        }
        for (side, face) in hex20::FACES.iter().enumerate() {
            let mut key = [0, 1, 2, 3].map(|c| element[face[c]]);
            key.sort_unstable();
            points[20 + side] = *centres.entry(key).or_insert_with(|| {
                let corner = |c: &usize| (element[*c] as usize, -0.25);
                let middle = |m: &usize| (element[*m] as usize, 0.5);
                extra.push(face[..4].iter().map(corner).chain(face[4..].iter().map(middle)).collect());
                n + extra.len() - 1
            });
        }
        let weight = |(local, node): (usize, &u32)| (*node as usize, if local < 8 { -0.25 } else { 0.25 });
        extra.push(element.iter().enumerate().map(weight).collect());
        points[26] = n + extra.len() - 1;
        bricks.extend(LOWEST.map(|low| (BRICK.map(|corner| points[LATTICE[low + corner]]), at)));
    }
    (bricks, extra)
}

#[cfg(test)]
#[path = "tecplot_tests.rs"]
mod tests;
