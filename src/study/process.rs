//! Runs as processes of their own: none ends another, whatever becomes of it.

use crate::message::shown;
use crate::program;
use crate::read::source;
use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};

/// Longest reason in a table [characters].
const LONGEST: usize = 400;

/// How a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// Anew, replacing what is there.
    Anew,
    /// From its checkpoint.
    Resumed,
}

/// Starts a run of this program. What it says goes to the file `log`.
///
/// # Errors
/// What the system refuses.
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
    // Joined, for an override may begin with a dash.
    command.args(set.iter().map(|assignment| format!("--set={assignment}")));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(log)?);
    apart(&mut command);
    command.spawn()
}

/// Puts a process into a group of its own, so that Ctrl-C comes to it through the study alone, once; and lets the system interrupt
/// it when the study is killed.
#[cfg(unix)]
fn apart(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
    #[cfg(target_os = "linux")]
    // SAFETY: between fork and exec only functions that are safe in a signal handler may be called; `prctl` is one.
    unsafe {
        command.pre_exec(|| match libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGTERM as libc::c_ulong) {
            0 => Ok(()),
            _ => Err(io::Error::last_os_error()),
        });
    }
}

#[cfg(not(unix))]
fn apart(_: &mut Command) {}

/// Requests a run to write its checkpoint and stop.
#[cfg(unix)]
pub fn interrupt(child: &Child) {
    if let Ok(process) = i32::try_from(child.id()) {
        // SAFETY: the call reads two numbers. The process is a child that was not waited for, so its number is no other's.
        unsafe { libc::kill(process, libc::SIGINT) };
    }
}

/// Without signals a run goes on to its end, and the study waits for it.
#[cfg(not(unix))]
pub fn interrupt(_: &Child) {}

/// Exit code of a process, 128 and the number of the signal that ended it; and why it did not end well.
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

/// The error that a run has said last.
fn reason(log: &Path) -> String {
    let bytes = source::bytes(log, source::LARGEST_TEXT).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
    shown(last.strip_prefix("error: ").unwrap_or(last), LONGEST)
}
