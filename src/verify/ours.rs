//! Own columns: runs of this program as separate processes.

use super::cell::{Cell, Column};
use super::file::Verb;
use super::plan::Row;
use crate::study;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;
use trackbed_dem::device::Cuda;
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Exit code for input that is not supported.
const INPUT: i32 = 2;
const NOT_SUPPORTED: &str = "not supported";

/// Where rows are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One thread of the CPU.
    Cpu,
    /// CUDA device.
    Gpu,
    /// Several processes.
    Ranks(u32),
}

impl Place {
    fn name(self) -> String {
        match self {
            Place::Cpu => "trackbed".into(),
            Place::Gpu => "trackbed_gpu".into(),
            Place::Ranks(n) => format!("trackbed_ranks_{n}"),
        }
    }

    fn title(self) -> String {
        match self {
            Place::Cpu => "trackbed".into(),
            Place::Gpu => "trackbed, GPU".into(),
            Place::Ranks(n) => format!("trackbed, {n} ranks"),
        }
    }

    /// Reason why it is not available.
    fn missing(self) -> Option<String> {
        match self {
            Place::Cpu => None,
            Place::Gpu => Cuda::missing().map(String::from),
            Place::Ranks(_) if cfg!(not(feature = "mpi")) => Some("built without the feature `mpi`".into()),
            Place::Ranks(_) => match Command::new("mpirun").arg("--version").output() {
                Ok(_) => None,
                Err(e) => Some(format!("mpirun: {e}")),
            },
        }
    }
}

/// Outcome of a run: wall time [s] or a cell without a value.
type Outcome = Result<f64, Cell>;

/// Computes all rows below `dir`, one after another.
///
/// # Errors
/// I/O errors. A failed run is a failed cell.
pub fn column(rows: &[Row], place: Place, dir: &Path, quiet: bool) -> Result<Column, Failure> {
    let (name, title) = (place.name(), place.title());
    if let Some(reason) = place.missing() {
        let cells = rows.iter().map(|_| Cell::Skipped).collect();
        return Ok(Column { title, name, own: true, version: None, missing: Some(reason), cells });
    }
    fs::create_dir_all(dir).map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
    let mut cells: Vec<Cell> = Vec::new();
    let mut outcomes: Vec<Outcome> = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let first = rows[..k].iter().position(|other| row.shares_run(other)).unwrap_or(k);
        let folder = dir.join(&rows[first].table.name);
        let outcome = match first == k {
            true => run(row, place, &folder)?,
            false => outcomes[first].clone(),
        };
        cells.push(cell(row, &folder, &outcome));
        outcomes.push(outcome);
        if !quiet {
            let mark = match cells[k].passed() {
                Some(true) => "passed",
                Some(false) => "FAILED",
                None => NOT_SUPPORTED,
            };
            message::say(&format!("{title}: {} of {}: {}: {mark}", k + 1, rows.len(), row.table.name));
        }
    }
    let version = Some(env!("CARGO_PKG_VERSION").to_string());
    Ok(Column { title, name, own: true, version, missing: None, cells })
}

fn cell(row: &Row, folder: &Path, outcome: &Outcome) -> Cell {
    match outcome {
        Ok(seconds) => match study::number(&row.quantity, folder) {
            Ok(value) => Cell::of(row, value, *seconds),
            Err(reason) => Cell::Failed { reason },
        },
        Err(cell) => cell.clone(),
    }
}

fn run(row: &Row, place: Place, folder: &Path) -> Result<Outcome, Failure> {
    if place != Place::Cpu && row.table.command != Verb::Run {
        return Ok(Err(Cell::NotModelled { reason: "no DEM steps".into() }));
    }
    let failure = |e: std::io::Error| Failure::Other(format!("{}: {e}", folder.display()));
    let log = folder.with_extension("log");
    let mut command =
        study::command(row.table.command.word(), &row.scene, folder, &row.table.set).map_err(failure)?;
    match row.table.command {
        Verb::Run => command.args(["--quiet", "--force", "--threads", "1", "--set=output.vtk=false"]),
        Verb::Element => command.arg("--force"),
        Verb::Modal => command.args(["--threads", "1"]),
    };
    match place {
        Place::Cpu => {}
        Place::Gpu => {
            command.args(["--device", "gpu"]);
        }
        Place::Ranks(n) => command = over(command, n),
    }
    command.stderr(File::create(&log).map_err(failure)?);
    let start = Instant::now();
    let status = command.status().map_err(failure)?;
    Ok(match study::verdict(status, &log) {
        (0, _) => Ok(start.elapsed().as_secs_f64()),
        (INPUT, reason) if place != Place::Cpu && reason.contains(NOT_SUPPORTED) => {
            Err(Cell::NotModelled { reason })
        }
        (_, reason) => Err(Cell::Failed { reason }),
    })
}

/// The same command on several processes.
fn over(command: Command, ranks: u32) -> Command {
    let mut whole = Command::new("mpirun");
    whole.args(["--oversubscribe", "--quiet", "-n", &ranks.to_string()]);
    whole.arg(command.get_program()).args(command.get_args());
    whole.stdin(Stdio::null()).stdout(Stdio::null());
    whole
}
