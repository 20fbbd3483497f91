//! Own column: runs of this program as separate processes.

use super::cell::{Cell, Column};
use super::file::Verb;
use super::plan::Row;
use crate::study;
use std::fs::{self, File};
use std::path::Path;
use std::time::Instant;
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Outcome of a run: wall time [s] or reason of failure.
type Outcome = Result<f64, String>;

/// Computes all rows below `dir`, one after another on one thread.
///
/// # Errors
/// I/O errors. A failed run is a failed cell.
pub fn column(rows: &[Row], dir: &Path, quiet: bool) -> Result<Column, Failure> {
    fs::create_dir_all(dir).map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
    let mut cells: Vec<Cell> = Vec::new();
    let mut outcomes: Vec<Outcome> = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let first = rows[..k].iter().position(|other| row.shares_run(other)).unwrap_or(k);
        let folder = dir.join(&rows[first].table.name);
        let outcome = match first == k {
            true => run(row, &folder)?,
            false => outcomes[first].clone(),
        };
        cells.push(cell(row, &folder, &outcome));
        outcomes.push(outcome);
        if !quiet {
            let mark = if cells[k].passed() == Some(true) { "passed" } else { "FAILED" };
            message::say(&format!("{} of {}: {}: {mark}", k + 1, rows.len(), row.table.name));
        }
    }
    let (name, version) = ("trackbed".to_string(), Some(env!("CARGO_PKG_VERSION").to_string()));
    Ok(Column { title: name.clone(), name, version, missing: None, cells })
}

fn cell(row: &Row, folder: &Path, outcome: &Outcome) -> Cell {
    let value = outcome.clone().and_then(|seconds| Ok((study::number(&row.quantity, folder)?, seconds)));
    match value {
        Ok((value, seconds)) => Cell::of(row, value, seconds),
        Err(reason) => Cell::Failed { reason },
    }
}

fn run(row: &Row, folder: &Path) -> Result<Outcome, Failure> {
    let failure = |e: std::io::Error| Failure::Other(format!("{}: {e}", folder.display()));
    let log = folder.with_extension("log");
    let mut command =
        study::command(row.table.command.word(), &row.scene, folder, &row.table.set).map_err(failure)?;
    match row.table.command {
        Verb::Run => command.args(["--quiet", "--force", "--threads", "1", "--set=output.vtk=false"]),
        Verb::Element => command.arg("--force"),
        Verb::Modal => command.args(["--threads", "1"]),
    };
    command.stderr(File::create(&log).map_err(failure)?);
    let start = Instant::now();
    let status = command.status().map_err(failure)?;
    Ok(match study::verdict(status, &log) {
        (0, _) => Ok(start.elapsed().as_secs_f64()),
        (_, reason) => Err(reason),
    })
}
