//! macOS: Mach and libproc.

use std::fs::File;
use std::os::fd::AsRawFd;
use std::os::unix::ffi::OsStringExt;
use std::path::PathBuf;
use std::process::Command;

/// Starts the browser.
pub const BROWSER: &str = "open";

/// Resident memory [bytes].
pub fn resident() -> Option<u64> {
    // SAFETY: zeros are a valid value of this struct of integers.
    let mut info: libc::proc_taskinfo = unsafe { std::mem::zeroed() };
    let size = size_of::<libc::proc_taskinfo>() as libc::c_int;
    let process = std::process::id() as libc::c_int;
    // SAFETY: at most `size` bytes of `info` are written.
    let written =
        unsafe { libc::proc_pidinfo(process, libc::PROC_PIDTASKINFO, 0, (&raw mut info).cast(), size) };
    (written == size).then_some(info.pti_resident_size)
}

/// Peak resident memory [bytes].
pub fn peak_memory() -> Option<u64> {
    // SAFETY: zeros are a valid value of this struct of integers.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: `getrusage` only writes the given struct.
    let code = unsafe { libc::getrusage(libc::RUSAGE_SELF, &mut usage) };
    u64::try_from(usage.ru_maxrss).ok().filter(|_| code == 0)
}

/// Free memory of the machine [bytes].
#[allow(deprecated, reason = "mach_host_self has not moved to another dependency of this program")]
pub fn available() -> Option<u64> {
    // SAFETY: zeros are a valid value of this struct of integers.
    let mut pages: libc::vm_statistics64 = unsafe { std::mem::zeroed() };
    let mut count = libc::HOST_VM_INFO64_COUNT;
    // SAFETY: at most `count` integers of `pages` are written.
    let code = unsafe {
        let host = libc::mach_host_self();
        libc::host_statistics64(host, libc::HOST_VM_INFO64, (&raw mut pages).cast(), &mut count)
    };
    // SAFETY: `sysconf` has no preconditions.
    let bytes = u64::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).ok()?;
    let (free, inactive, purgeable) = (pages.free_count, pages.inactive_count, pages.purgeable_count);
    let free = u64::from(free) + u64::from(inactive) + u64::from(purgeable);
    (code == libc::KERN_SUCCESS).then_some(free * bytes)
}

/// Current path of an open file.
pub fn path_of(file: &File) -> Option<PathBuf> {
    let mut path = vec![0_u8; libc::PATH_MAX as usize];
    // SAFETY: F_GETPATH writes at most PATH_MAX bytes.
    let code = unsafe { libc::fcntl(file.as_raw_fd(), libc::F_GETPATH, path.as_mut_ptr()) };
    path.truncate(path.iter().position(|byte| *byte == 0)?);
    (code == 0).then(|| PathBuf::from(std::ffi::OsString::from_vec(path)))
}

pub(super) fn tie(_: &mut Command) {}

pub(super) fn prepare_memory() {}
