//! Unix systems: Linux, macOS, BSD.

#[cfg(target_os = "linux")]
use super::linux as kernel;
#[cfg(target_os = "macos")]
use super::macos as kernel;
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
use super::other as kernel;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use std::fs::{self, File, TryLockError};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, Command, ExitStatus};
use std::sync::Arc;

/// Always readable and empty.
pub const NULL_DEVICE: &str = "/dev/null";

/// Prepares the process, before other threads exist: malloc, file size limit, abort.
pub fn prepare() {
    kernel::prepare_memory();
    // Any handler prevents termination; the write then returns an error.
    drop(signal_hook::flag::register(SIGXFSZ, Arc::default()));
    end_at_abort();
}

/// Loads a shared library and resolves all its symbols.
///
/// # Errors
/// Message of the system, with the file.
pub fn open_library(path: &Path) -> Result<libloading::Library, String> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: initialisers run with the rights of the user who names the library.
    let library = unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) };
    library.map(Into::into).map_err(|error| super::reason(&error))
}

/// Makes an abort, such as a stack overflow, exit with code 3 and one line.
fn end_at_abort() {
    const LINE: &[u8] = b"error: memory: found none free, or a stack overflow. Reduce the scene, or raise the system limits (ulimit -v, ulimit -s).\n";
    let action = || {
        write_error(LINE);
        signal_hook::low_level::exit(3);
    };
    // SAFETY: the action only calls `write` and `_exit`, which are async-signal-safe.
    let registered = unsafe { signal_hook::low_level::register(libc::SIGABRT, action) };
    // Otherwise the abort signal ends the process.
    drop(registered);
}

/// Writes to standard error in one call, without allocation.
pub fn write_error(line: &[u8]) {
    // SAFETY: pointer and length of `line`.
    unsafe { libc::write(libc::STDERR_FILENO, line.as_ptr().cast(), line.len()) };
}

/// User and system, all threads [s].
pub fn cpu_seconds() -> Option<f64> {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `clock_gettime` only writes the given struct.
    let code = unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    (code == 0).then_some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Whether an error is the limit of open files.
pub fn lacks_files(error: &io::Error) -> bool {
    matches!(error.raw_os_error(), Some(libc::EMFILE | libc::ENFILE))
}

/// Whether a process exists.
pub fn is_running(process: u32) -> bool {
    let Some(process) = libc::pid_t::try_from(process).ok().filter(|process| *process > 0) else {
        return false;
    };
    // SAFETY: plain integers; signal 0 only checks.
    let code = unsafe { libc::kill(process, 0) };
    // Of another user.
    code == 0 || io::Error::last_os_error().raw_os_error() == Some(libc::EPERM)
}

/// Whether a process of this machine has ended and was reaped.
#[cfg(all(feature = "mpi", not(target_os = "linux")))]
pub fn has_ended(process: u32) -> bool {
    !is_running(process)
}

/// Signals that stop a run; SIGHUP unless ignored (`nohup`).
pub fn stop_signals() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    if !is_ignored(SIGHUP) {
        signals.push(SIGHUP);
    }
    signals
}

fn is_ignored(signal: i32) -> bool {
    // SAFETY: zeros are a valid value of this struct; null requests no change.
    let mut action: libc::sigaction = unsafe { std::mem::zeroed() };
    // SAFETY: `sigaction` only writes the given struct.
    let code = unsafe { libc::sigaction(signal, std::ptr::null(), &mut action) };
    code == 0 && action.sa_sigaction == libc::SIG_IGN
}

/// Locks a file for this process; the content stays readable.
pub fn try_lock(file: &File) -> Result<(), TryLockError> {
    file.try_lock()
}

/// Whether an open file is the one at `path`, which may have been replaced.
pub fn is_at(file: &File, path: &Path) -> bool {
    let (Ok(own), Ok(named)) = (file.metadata(), fs::metadata(path)) else { return false };
    (own.dev(), own.ino()) == (named.dev(), named.ino())
}

/// Separate process group: Ctrl-C arrives once, through this process.
pub fn set_apart(command: &mut Command) {
    command.process_group(0);
    kernel::tie(command);
}

/// Requests a checkpoint and stop.
pub fn interrupt(child: &Child) {
    if let Ok(process) = libc::pid_t::try_from(child.id()) {
        // SAFETY: plain integers. The child is not reaped, so its id is valid.
        unsafe { libc::kill(process, libc::SIGINT) };
    }
}

/// Signal that ended a process.
pub fn signal_of(status: ExitStatus) -> Option<i32> {
    status.signal()
}

/// Name of this machine, at most `name.len()` bytes.
#[cfg(feature = "mpi")]
pub fn host_name(name: &mut [u8]) {
    // SAFETY: pointer and length of `name`.
    unsafe { libc::gethostname(name.as_mut_ptr().cast(), name.len()) };
}

/// CPUs of this machine, whatever part this process is bound to.
#[cfg(feature = "mpi")]
pub fn processors() -> usize {
    // SAFETY: `sysconf` has no preconditions.
    usize::try_from(unsafe { libc::sysconf(libc::_SC_NPROCESSORS_ONLN) }).unwrap_or(1)
}
