//! Solid for Tecplot: ASCII `.dat` file, one FEBRICK zone.
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
use trackbed_fem::mesh::Mesh;

use crate::read::degenerate::to_brick;

use super::atomic;
use super::error::{WriteError, check_field};
use super::frame::{Frame, SolidFrame};
use super::writer::{Format, Mark, Part, Writer};

const VARIABLES: &str = "\"x\" \"y\" \"z\" \"ux\" \"uy\" \"uz\" \"u\" \"sxx\" \"syy\" \"szz\" \"sxy\" \"syz\" \"szx\" \
     \"von_mises\" \"eps_p\"";

/// Point values: x y z, ux uy uz, six stresses, equivalent plastic strain.
type Values = [f64; 13];

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
        write_solid(&file, solid, "solid", frame.time, 1)
    }
}

/// Writes the solid at `time` [s] as `zone`; files of one `strand` (≥ 1) form a time series.
///
/// # Errors
/// Wrong field length, non-finite values; I/O errors.
pub fn write_solid(
    file: &Path,
    frame: &SolidFrame,
    zone: &str,
    time: f64,
    strand: u32,
) -> Result<(), WriteError> {
    let n = frame.mesh.node_count();
    check_field(file, "time", &[time], 1, 1)?;
    check_field(file, "coordinates", frame.mesh.coordinates.as_flattened(), 3, n)?;
    check_field(file, "displacement", frame.displacement, 3, n)?;
    check_field(file, "stress", frame.stress.as_flattened(), 6, n)?;
    check_field(file, "von_mises", frame.von_mises, 1, n)?;
    check_field(file, "equivalent_plastic_strain", frame.equivalent_plastic_strain, 1, n)?;
    let (bricks, extra) = split(frame);
    let zone = zone.replace('"', "'");
    atomic::write(file, |out| {
        write_text(out, frame, &zone, time, strand, &bricks, &extra).map_err(WriteError::io(file))
    })
}

fn write_text(
    out: &mut dyn Write,
    frame: &SolidFrame,
    zone: &str,
    time: f64,
    strand: u32,
    bricks: &[[usize; 8]],
    extra: &[Values],
) -> std::io::Result<()> {
    let n = frame.mesh.node_count();
    writeln!(out, "# SI units; coordinates undeformed; stress tension positive.")?;
    writeln!(
        out,
        "# Each 20-node element is split into 8 bricks; points 1 to {n} are the nodes, the rest are"
    )?;
    writeln!(out, "# face and body centres, interpolated with the shape functions of the 20-node element.")?;
    writeln!(out, "TITLE = \"{zone}\"")?;
    writeln!(out, "VARIABLES = {VARIABLES}")?;
    writeln!(out, "ZONE T=\"{zone}\", N={}, E={},", n + extra.len(), bricks.len())?;
    writeln!(out, "DATAPACKING=POINT, ZONETYPE=FEBRICK, STRANDID={strand}, SOLUTIONTIME={time:e}")?;
    for node in 0..n {
        write_point(out, &values(frame, node), frame.von_mises[node])?;
    }
    for point in extra {
        write_point(out, point, von_mises(point))?;
    }
    for brick in bricks {
        let line = brick.iter().map(|p| (p + 1).to_string()).collect::<Vec<_>>().join(" ");
        writeln!(out, "{line}")?;
    }
    Ok(())
}

fn write_point(out: &mut dyn Write, v: &Values, von_mises: f64) -> std::io::Result<()> {
    let total = (v[3] * v[3] + v[4] * v[4] + v[5] * v[5]).sqrt();
    let mut line = String::with_capacity(256);
    for value in v[..6].iter().chain([&total]).chain(&v[6..12]).chain([&von_mises, &v[12]]) {
        line += &format!("{value:.9e} ");
    }
    writeln!(out, "{}", line.trim_end())
}

fn values(frame: &SolidFrame, node: usize) -> Values {
    let (x, u, s) = (frame.mesh.coordinates[node], &frame.displacement[3 * node..], frame.stress[node]);
    let eps = frame.equivalent_plastic_strain[node];
    [x[0], x[1], x[2], u[0], u[1], u[2], s[0], s[1], s[2], s[3], s[4], s[5], eps]
}

fn von_mises(v: &Values) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = [v[6], v[7], v[8], v[9], v[10], v[11]];
    let deviatoric = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * deviatoric + 3.0 * (xy * xy + yz * yz + zx * zx)).sqrt()
}

/// Small bricks (point indices from 0, nodes first) and additional points.
fn split(frame: &SolidFrame) -> (Vec<[usize; 8]>, Vec<Values>) {
    let mesh: &Mesh = frame.mesh;
    let n = mesh.node_count();
    let mut extra = Vec::new();
    let mut centres: HashMap<[u32; 4], usize> = HashMap::new();
    let mut bricks = Vec::with_capacity(8 * mesh.element_count());
    for (element, &kind) in mesh.connectivity.iter().zip(mesh.connectivity.kinds()) {
        if kind != ElementKind::Hex20 {
            let brick = to_brick(kind.linear(), &element[..kind.corner_count()]);
            bricks.push(std::array::from_fn(|c| brick[c] as usize));
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
                extra.push(combine(frame, face[..4].iter().map(corner).chain(face[4..].iter().map(middle))));
                n + extra.len() - 1
            });
        }
        let weight = |(local, node): (usize, &u32)| (*node as usize, if local < 8 { -0.25 } else { 0.25 });
        extra.push(combine(frame, element.iter().enumerate().map(weight)));
        points[26] = n + extra.len() - 1;
        bricks.extend(LOWEST.map(|low| BRICK.map(|corner| points[LATTICE[low + corner]])));
    }
    (bricks, extra)
}

fn combine(frame: &SolidFrame, weights: impl Iterator<Item = (usize, f64)>) -> Values {
    let mut sum = [0.0; 13];
    for (node, weight) in weights {
        for (s, v) in sum.iter_mut().zip(values(frame, node)) {
            *s += weight * v;
        }
    }
    sum[12] = sum[12].max(0.0);
    sum
}

#[cfg(test)]
#[path = "tecplot_tests.rs"]
mod tests;
