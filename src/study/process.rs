//! Runs as separate processes.

use crate::message::shown;
use crate::program;
use crate::read::source;
use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};

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
    let mut command = program::command()?;
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["--quiet", "--threads", &threads.to_string()]);
    command.arg(if beginning == Beginning::Anew { "--force" } else { "--resume" });
    // Overrides may begin with a dash.
    command.args(set.iter().map(|assignment| format!("--set={assignment}")));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(log)?);
    apart(&mut command);
    command.spawn()
}

/// Separate process group: Ctrl-C arrives once, through the study. Interrupted if the study is killed.
#[cfg(unix)]
fn apart(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
    #[cfg(target_os = "linux")]
    // SAFETY: only async-signal-safe functions after fork; `prctl` is one.
    unsafe {
        command.pre_exec(|| match libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGTERM as libc::c_ulong) {
            0 => Ok(()),
            _ => Err(io::Error::last_os_error()),
        });
    }
}

#[cfg(not(unix))]
fn apart(_: &mut Command) {}

/// Requests a checkpoint and stop.
#[cfg(unix)]
pub fn interrupt(child: &Child) {
    if let Ok(process) = i32::try_from(child.id()) {
        // SAFETY: plain integers. The child is not reaped: its id is valid.
        unsafe { libc::kill(process, libc::SIGINT) };
    }
}

/// Without signals the study waits for the run.
#[cfg(not(unix))]
pub fn interrupt(_: &Child) {}

/// Returns exit code (128 + signal) and reason of failure.
pub fn verdict(status: ExitStatus, log: &Path) -> (i32, String) {
    match (status.code(), signal(status)) {
        (Some(0), _) => (0, String::new()),
        (Some(code), _) => (code, reason(log)),
        (None, Some(signal)) => (128 + signal, format!("ended by signal {signal}")),
        (None, None) => (1, "ended without an exit code".into()),
    }
}

#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

#[cfg(not(unix))]
fn signal(_: ExitStatus) -> Option<i32> {
    None
}

fn reason(log: &Path) -> String {
    let bytes = source::bytes(log, source::LARGEST_TEXT).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
    shown(last.strip_prefix("error: ").unwrap_or(last), LONGEST)
}
