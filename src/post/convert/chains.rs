//! Force-chain files: contact partners and forces by frame.
//!
//! Header `3DF: TIME COUNT`, then COUNT rows `i j Fn Ft`: particle ids from 1 (0 for others), normal and
//! tangential force [N]. A preceding row index is accepted.

use super::animation;
use super::rows;
use std::path::Path;
use trackbed_io::columns::converted;
use trackbed_io::failure::Failure;
use trackbed_io::read::ReadError;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::{ChainFrame, WriteError, atomic};

/// Start of a frame.
pub const HEAD: &str = "3DF:";

const BETWEEN_GRAINS: u32 = 0;

/// Contact: partner ids from 1, 0 for others, and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chain {
    /// First particle.
    pub first: u32,
    /// Second particle.
    pub second: u32,
    /// Normal force [N].
    pub normal: f64,
    /// Tangential force [N].
    pub tangential: f64,
}

/// Contacts of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// Time [s] or step.
    pub time: f64,
    /// Contacts.
    pub chains: Vec<Chain>,
}

impl Moment {
    /// Converts to chains between `grains`; also returns the number dropped for unknown partners.
    pub fn frame(&self, grains: &animation::Moment) -> (ChainFrame, usize) {
        let mut frame = ChainFrame::default();
        let place = |number: u32| grains.position.get((number as usize).checked_sub(1)?);
        let mean = self.chains.iter().map(|c| c.normal).sum::<f64>() / self.chains.len().max(1) as f64;
        let mut lost = 0;
        for c in &self.chains {
            let (Some(a), Some(b)) = (place(c.first), place(c.second)) else {
                lost += 1;
                continue;
            };
            frame.ends.push([*a, *b]);
            frame.normal_force.push(c.normal);
            frame.tangential_force.push(c.tangential);
            frame.kind.push(BETWEEN_GRAINS);
            frame.strong.push(u32::from(c.normal > mean));
            frame.partners.push([c.first - 1, c.second - 1]);
        }
        (frame, lost)
    }
}

/// Reads all frames of a file.
///
/// # Errors
/// Damaged lines, no frame.
pub fn parse(file: &Path, text: &str) -> Result<Vec<Moment>, Failure> {
    let mut moments = Vec::new();
    for block in rows::blocks(file, text, HEAD, [4, 5])? {
        let mut chains = Vec::with_capacity(block.rows.len());
        for (line, row) in &block.rows {
            let [i, j, normal, tangential] = row[row.len() - 4..] else { unreachable!("widths are checked") };
            let number = |n: f64| {
                let fits = n >= 0.0 && n.fract() == 0.0 && n < f64::from(u32::MAX);
                let expected = "the number of a particle";
                if fits {
                    Ok(n as u32)
                } else {
                    Err(ReadError::at(file, *line, "particle", n.to_string(), expected))
                }
            };
            chains.push(Chain { first: number(i)?, second: number(j)?, normal, tangential });
        }
        moments.push(Moment { time: block.time, chains });
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
            writeln!(out, "{HEAD} {} {}", m.time, m.chains.len()).map_err(failed)?;
            for c in &m.chains {
                writeln!(out, "{} {} {} {}", c.first, c.second, c.normal, c.tangential).map_err(failed)?;
            }
        }
        Ok(())
    })?;
    Ok(vec![format!("{} moments", moments.len())])
}

const COLUMNS: [Field<(f64, Chain)>; 5] = [
    (converted::TIME, |(t, _)| *t),
    (converted::I, |(_, c)| f64::from(c.first)),
    (converted::J, |(_, c)| f64::from(c.second)),
    (converted::NORMAL_FORCE, |(_, c)| c.normal),
    (converted::TANGENTIAL_FORCE, |(_, c)| c.tangential),
];

/// Writes all frames as one table.
///
/// # Errors
/// I/O errors.
pub fn to_csv(moments: &[Moment], output: &Path) -> Result<Vec<String>, Failure> {
    write_table(output, &COLUMNS, moments.iter().flat_map(|m| m.chains.iter().map(|c| (m.time, *c))))?;
    Ok(vec![format!("{} moments", moments.len())])
}
