//! `ANIMATION_3D.DAT`: grain positions, radii and velocities by frame.
//!
//! Assumed: header `3D: TIME COUNT`, COUNT rows `x y z r vx vy vz`, optionally a part or fragment id.

use super::rows;
use std::path::Path;
use trackbed_io::columns::converted;
use trackbed_io::failure::Failure;
use trackbed_io::read::ReadError;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::{GrainFrame, Values, WriteError, atomic};

/// Start of a frame.
pub const HEAD: &str = "3D:";

/// Grains of a frame. Fields have the shape `[spheres]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// Time [s] or step.
    pub time: f64,
    /// Centres [m].
    pub position: Vec<[f64; 3]>,
    /// Radii [m].
    pub radius: Vec<f64>,
    /// Velocities [m/s].
    pub velocity: Vec<[f64; 3]>,
    /// Last column, if present.
    pub part: Option<Vec<f64>>,
}

impl Moment {
    /// Converts to a frame: spheres in order, parts numbered by value.
    pub fn frame(&self) -> GrainFrame {
        let count = self.position.len();
        let mut values = self.part.clone().unwrap_or_default();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        let place = |v: &f64| values.binary_search_by(|w| w.total_cmp(v)).unwrap_or(0) as u32;
        let whole = values.iter().all(|v| v.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(v));
        let number = |v: &f64| if whole { *v as u32 } else { place(v) };
        let part = self.part.as_ref().map_or_else(|| vec![0; count], |p| p.iter().map(number).collect());
        let none = || Values::Vectors(vec![[0.0; 3]; count]);
        let fields = vec![
            ("radius", Values::Numbers(self.radius.clone())),
            ("velocity", Values::Vectors(self.velocity.clone())),
            ("spin", none()),
            ("orientation", Values::Quaternions(vec![[1.0, 0.0, 0.0, 0.0]; count])),
            ("id", Values::Counts((0..count as u32).collect())),
            ("part", Values::Counts(part.clone())),
            ("mean_stress", Values::Numbers(vec![0.0; count])),
            ("force", none()),
            ("coordination", Values::Counts(vec![0; count])),
            ("fragment", Values::Counts(part)),
        ];
        GrainFrame { position: self.position.clone(), fields }
    }
}

/// Reads all frames of a file.
///
/// # Errors
/// Damaged lines, no frame, varying row widths.
pub fn parse(file: &Path, text: &str) -> Result<Vec<Moment>, Failure> {
    let mut moments = Vec::new();
    for block in rows::blocks(file, text, HEAD, [7, 8])? {
        let mut moment = Moment { time: block.time, ..Moment::default() };
        let with_part = block.rows.first().is_some_and(|(_, row)| row.len() == 8);
        let mut part = Vec::new();
        for (line, row) in &block.rows {
            if (row.len() == 8) != with_part {
                let expected = format!("{}, as in the row before", if with_part { 8 } else { 7 });
                return Err(ReadError::at(file, *line, "columns", row.len().to_string(), expected).into());
            }
            if row[3] <= 0.0 {
                return Err(ReadError::at(file, *line, "radius", row[3].to_string(), "above 0").into());
            }
            moment.position.push([row[0], row[1], row[2]]);
            moment.radius.push(row[3]);
            moment.velocity.push([row[4], row[5], row[6]]);
            part.extend(row.get(7));
        }
        moment.part = with_part.then_some(part);
        moments.push(moment);
    }
    if moments.is_empty() {
        return Err(ReadError::whole(file, "moments", "none", "at least one").into());
    }
    Ok(moments)
}

/// Writes frames in this format.
///
/// # Errors
/// I/O errors.
pub fn write(moments: &[Moment], output: &Path) -> Result<Vec<String>, Failure> {
    let failed = |error| WriteError::io(output)(error);
    atomic::write(output, |out| {
        for m in moments {
            writeln!(out, "{HEAD} {} {}", m.time, m.position.len()).map_err(failed)?;
            for (k, (([x, y, z], r), [u, v, w])) in
                m.position.iter().zip(&m.radius).zip(&m.velocity).enumerate()
            {
                let part = m.part.as_ref().map_or(String::new(), |p| format!(" {}", p[k]));
                writeln!(out, "{x} {y} {z} {r} {u} {v} {w}{part}").map_err(failed)?;
            }
        }
        Ok(())
    })?;
    Ok(vec![format!("{} moments", moments.len())])
}

type Row<'a> = (&'a Moment, usize);

/// Writes all frames as one table.
///
/// # Errors
/// I/O errors.
pub fn to_csv(moments: &[Moment], output: &Path) -> Result<Vec<String>, Failure> {
    let columns: [Field<Row<'_>>; 10] = [
        (converted::TIME, |(m, _)| m.time),
        (converted::ID, |(_, k)| *k as f64),
        (converted::X, |(m, k)| m.position[*k][0]),
        (converted::Y, |(m, k)| m.position[*k][1]),
        (converted::Z, |(m, k)| m.position[*k][2]),
        (converted::R, |(m, k)| m.radius[*k]),
        (converted::VX, |(m, k)| m.velocity[*k][0]),
        (converted::VY, |(m, k)| m.velocity[*k][1]),
        (converted::VZ, |(m, k)| m.velocity[*k][2]),
        (converted::PART, |(m, k)| m.part.as_ref().map_or(0.0, |p| p[*k])),
    ];
    let rows = moments.iter().flat_map(|m| (0..m.position.len()).map(move |k| (m, k)));
    write_table(output, &columns, rows)?;
    Ok(vec![format!("{} moments", moments.len())])
}
