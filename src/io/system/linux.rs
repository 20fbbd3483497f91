//! Linux: `/proc`, control groups, glibc.

use std::fs::{self, File};
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Starts the browser.
pub const BROWSER: &str = "xdg-open";

const STATUS: &str = "/proc/self/status";

/// Resident memory [bytes].
pub fn resident() -> Option<u64> {
    field(Path::new(STATUS), "VmRSS:")
}

/// Peak resident memory [bytes].
pub fn peak_memory() -> Option<u64> {
    field(Path::new(STATUS), "VmHWM:")
}

/// Free memory of the machine or control group [bytes].
pub fn available() -> Option<u64> {
    let machine = field(Path::new("/proc/meminfo"), "MemAvailable:");
    let number = |file: &str| fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let group = number("/sys/fs/cgroup/memory.max")
        .zip(number("/sys/fs/cgroup/memory.current"))
        .map(|(max, current)| max.saturating_sub(current));
    match (machine, group) {
        (Some(m), Some(g)) => Some(m.min(g)),
        (one, other) => one.or(other),
    }
}

/// Status file entry in kB [bytes].
fn field(file: &Path, name: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|l| l.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}

/// Current path of an open file.
pub fn path_of(file: &File) -> Option<PathBuf> {
    fs::read_link(format!("/proc/self/fd/{}", file.as_raw_fd())).ok()
}

/// Interrupts a child if this process is killed.
pub(super) fn tie(command: &mut Command) {
    // SAFETY: after fork only async-signal-safe functions are called; `prctl` is one.
    unsafe {
        command.pre_exec(|| match libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGTERM as libc::c_ulong) {
            0 => Ok(()),
            _ => Err(io::Error::last_os_error()),
        });
    }
}

/// Address space per malloc arena [bytes]; 64 MiB are reserved.
#[cfg(target_env = "gnu")]
const ARENA: u64 = 1 << 30;

/// Limits malloc arenas under an address space limit: threads without an arena would allocate by mmap, 100
/// times slower.
pub(super) fn prepare_memory() {
    #[cfg(target_env = "gnu")]
    {
        let mut limit = libc::rlimit { rlim_cur: libc::RLIM_INFINITY, rlim_max: libc::RLIM_INFINITY };
        // SAFETY: `getrlimit` only writes the given struct.
        let code = unsafe { libc::getrlimit(libc::RLIMIT_AS, &mut limit) };
        if code == 0 && limit.rlim_cur != libc::RLIM_INFINITY {
            let arenas = (limit.rlim_cur / ARENA).clamp(1, 1024) as libc::c_int;
            // SAFETY: set before other threads exist.
            unsafe { libc::mallopt(libc::M_ARENA_MAX, arenas) };
        }
    }
}

/// Whether a process of this machine has ended, reaped or not.
#[cfg(feature = "mpi")]
pub fn has_ended(process: u32) -> bool {
    // State Z: ended, not yet reaped.
    let state = |text: String| text.rsplit(')').next().and_then(|rest| rest.trim_start().chars().next());
    fs::read_to_string(format!("/proc/{process}/stat"))
        .map_or(true, |text| matches!(state(text), Some('Z' | 'X')))
}
