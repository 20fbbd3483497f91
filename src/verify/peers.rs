//! Columns of other programs, computed by Python scripts.
//!
//! `python3 SCRIPT MATRIX ROW…` prints one JSON object in the last line of its standard output: `version` and `rows`, by name `value`
//! (unit of the quantity) and `seconds`, or `error`; or `missing`, a text, if the program is not installed.

use super::cell::{Cell, Column};
use super::plan::{Peer, Row};
use serde_json::Value;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trackbed_io::message;

/// Longest run of a script.
const LONGEST: Duration = Duration::from_secs(900);
const POLL: Duration = Duration::from_millis(20);

/// Computes the column of a peer, with its output below `dir`; without `python`, no row of it.
pub fn column(peer: &Peer, (matrix, rows): (&Path, &[Row]), python: Option<&Path>, dir: &Path) -> Column {
    let name = &peer.table.name;
    let modelled: Vec<&str> =
        rows.iter().filter(|row| row.table.peers.contains(name)).map(|row| row.table.name.as_str()).collect();
    let reply = match python {
        Some(python) if !modelled.is_empty() => {
            run(peer, python, (matrix, &modelled), &dir.join(format!("{name}.log")))
        }
        Some(_) => Err("no row".into()),
        None => Err("without --peers".into()),
    };
    let (found, missing) = match reply {
        Ok(found) => (found, None),
        Err(reason) => (Value::Null, Some(reason)),
    };
    let cell = |row: &Row| {
        if !row.table.peers.contains(name) {
            let reason = row.table.not_modelled.get(name).unwrap_or(&peer.table.otherwise);
            return Cell::NotModelled { reason: reason.clone() };
        }
        if missing.is_some() {
            return Cell::Skipped;
        }
        of(row, &found["rows"][&row.table.name])
    };
    let cells = rows.iter().map(cell).collect();
    let version = found["version"].as_str().map(String::from);
    Column { name: name.clone(), title: peer.table.title.clone(), own: false, version, missing, cells }
}

fn of(row: &Row, found: &Value) -> Cell {
    match (found["value"].as_f64().filter(|v| v.is_finite()), found["seconds"].as_f64()) {
        (Some(value), Some(seconds)) => Cell::of(row, value, seconds),
        _ => Cell::Failed { reason: found["error"].as_str().unwrap_or("no value").into() },
    }
}

/// Reply of a script, or why there is none; its output is kept in `log`.
fn run(peer: &Peer, python: &Path, (matrix, rows): (&Path, &[&str]), log: &Path) -> Result<Value, String> {
    message::say(&format!("{}: {} rows", peer.table.title, rows.len()));
    let failure = |e: std::io::Error| format!("{}: {e}", python.display());
    let mut command = Command::new(python);
    command.arg(&peer.script).arg(matrix).args(rows).stdin(Stdio::null()).stderr(Stdio::null());
    command.stdout(File::create(log).map_err(failure)?);
    // One thread, as the own column.
    command.envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1")));
    let mut child = command.spawn().map_err(failure)?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(failure)? {
            break status;
        }
        if start.elapsed() > LONGEST {
            let _ = child.kill();
            let _ = child.wait();
            return Err(format!("no reply within {} s", LONGEST.as_secs()));
        }
        std::thread::sleep(POLL);
    };
    let text = String::from_utf8_lossy(&fs::read(log).map_err(failure)?).into_owned();
    let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("");
    let found: Value = serde_json::from_str(last)
        .map_err(|_| format!("{}: no reply, {status}", peer.table.script.display()))?;
    match found["missing"].as_str() {
        Some(reason) => Err(reason.into()),
        None => Ok(found),
    }
}
