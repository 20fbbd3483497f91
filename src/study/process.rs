//! Runs as separate processes.

use crate::program;
use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use trackbed_io::message::shown;
use trackbed_io::read::source;
use trackbed_io::system;

const LONGEST: usize = 400;

/// Start mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// From scratch, overwriting.
    Anew,
    /// From checkpoint.
    Resumed,
}

/// Starts a run, logging to `log`.
///
/// # Errors
/// I/O errors.
pub fn start(
    scene: &Path,
    out: &Path,
    set: &[String],
    threads: usize,
    beginning: Beginning,
    log: &Path,
) -> io::Result<Child> {
    let mut command = command("run", scene, out, set)?;
    command.args(["--quiet", "--threads", &threads.to_string()]);
    command.arg(if beginning == Beginning::Anew { "--force" } else { "--resume" });
    command.stderr(File::create(log)?);
    system::set_apart(&mut command);
    command.spawn()
}

/// Prepares a command of this program on a scene, without output.
///
/// # Errors
/// Executable path unknown.
pub fn command(verb: &str, scene: &Path, out: &Path, set: &[String]) -> io::Result<Command> {
    let mut command = program::command()?;
    command.arg(verb).arg(scene).arg("--out").arg(out);
    // Overrides may begin with a dash.
    command.args(set.iter().map(|assignment| format!("--set={assignment}")));
    command.stdin(Stdio::null()).stdout(Stdio::null());
    Ok(command)
}

/// Requests a checkpoint and stop.
pub fn interrupt(child: &Child) {
    system::interrupt(child);
}

/// Returns exit code (128 + signal number if killed) and reason of failure.
pub fn verdict(status: ExitStatus, log: &Path) -> (i32, String) {
    match (status.code(), system::signal_of(status)) {
        (Some(0), _) => (0, String::new()),
        (Some(code), _) => (code, reason(log)),
        (None, Some(signal)) => (128 + signal, format!("ended by signal {signal}")),
        (None, None) => (1, "ended without an exit code".into()),
    }
}

fn reason(log: &Path) -> String {
    let bytes = source::bytes(log, source::LARGEST_TEXT).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
    shown(last.strip_prefix("error: ").unwrap_or(last), LONGEST)
}
