//! System information on machine and process.

use std::io;
use std::path::Path;

/// Resident memory [bytes].
pub(crate) fn resident() -> Option<u64> {
    field(Path::new("/proc/self/status"), "VmRSS:")
}

/// CPU time, user and system, all threads [s].
#[cfg(unix)]
pub(crate) fn cpu_seconds() -> Option<f64> {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `clock_gettime` only writes the given struct.
    let code = unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    (code == 0).then_some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Unknown on this system.
#[cfg(not(unix))]
pub(crate) fn cpu_seconds() -> Option<f64> {
    None
}

/// Free memory of the machine or control group [bytes].
pub(crate) fn available() -> Option<u64> {
    let machine = field(Path::new("/proc/meminfo"), "MemAvailable:");
    let number = |file: &str| std::fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let group = number("/sys/fs/cgroup/memory.max")
        .zip(number("/sys/fs/cgroup/memory.current"))
        .map(|(max, current)| max.saturating_sub(current));
    match (machine, group) {
        (Some(m), Some(g)) => Some(m.min(g)),
        (one, other) => one.or(other),
    }
}

fn field(file: &Path, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find(|l| l.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}

#[cfg(unix)]
pub(crate) fn lacks_files(error: &io::Error) -> bool {
    matches!(error.raw_os_error(), Some(libc::EMFILE | libc::ENFILE))
}

/// Unknown on this system.
#[cfg(not(unix))]
pub(crate) fn lacks_files(_: &io::Error) -> bool {
    false
}

pub(crate) fn words(error: &io::Error) -> String {
    let remedy = if lacks_files(error) { "; raise the limit of open files (ulimit -n)" } else { "" };
    format!("{error}{remedy}")
}
