//! Windows.

use std::fs::{File, TryLockError};
use std::io;
use std::os::windows::io::AsRawHandle;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::ptr::null_mut;
use windows_sys::Win32::Foundation::{
    CloseHandle, ERROR_ACCESS_DENIED, ERROR_IO_PENDING, ERROR_LOCK_VIOLATION, ERROR_TOO_MANY_OPEN_FILES,
    FILETIME, STILL_ACTIVE,
};
use windows_sys::Win32::Storage::FileSystem::{
    LOCKFILE_EXCLUSIVE_LOCK, LOCKFILE_FAIL_IMMEDIATELY, LockFileEx, WriteFile,
};
use windows_sys::Win32::System::Console::{GetStdHandle, STD_ERROR_HANDLE};
use windows_sys::Win32::System::IO::OVERLAPPED;
use windows_sys::Win32::System::ProcessStatus::{K32GetProcessMemoryInfo, PROCESS_MEMORY_COUNTERS};
use windows_sys::Win32::System::SystemInformation::{GlobalMemoryStatusEx, MEMORYSTATUSEX};
use windows_sys::Win32::System::Threading::{
    GetCurrentProcess, GetExitCodeProcess, GetProcessTimes, OpenProcess, PROCESS_QUERY_LIMITED_INFORMATION,
};

/// Always readable and empty.
pub const NULL_DEVICE: &str = "NUL";
/// Starts the browser.
pub const BROWSER: &str = "explorer";

pub fn prepare() {}

/// Loads a shared library with all its symbols.
///
/// # Errors
/// Message of the system.
pub fn open_library(path: &Path) -> Result<libloading::Library, String> {
    // SAFETY: initialisers run with the rights of the user who names the library.
    unsafe { libloading::Library::new(path) }
        .map_err(|error| format!("{}: {}", path.display(), super::reason(&error)))
}

/// Writes to standard error in one call, without allocation.
pub fn write_error(line: &[u8]) {
    let mut written = 0;
    // SAFETY: pointer and length of `line`; an invalid handle is an error.
    unsafe {
        let handle = GetStdHandle(STD_ERROR_HANDLE);
        WriteFile(handle, line.as_ptr(), line.len() as u32, &mut written, null_mut());
    }
}

fn memory() -> Option<PROCESS_MEMORY_COUNTERS> {
    let size = size_of::<PROCESS_MEMORY_COUNTERS>() as u32;
    let mut counters = PROCESS_MEMORY_COUNTERS { cb: size, ..PROCESS_MEMORY_COUNTERS::default() };
    // SAFETY: at most `size` bytes of `counters` are written.
    let code = unsafe { K32GetProcessMemoryInfo(GetCurrentProcess(), &mut counters, size) };
    (code != 0).then_some(counters)
}

/// Resident memory [bytes].
pub fn resident() -> Option<u64> {
    memory().map(|counters| counters.WorkingSetSize as u64)
}

/// Peak resident memory [bytes].
pub fn peak_memory() -> Option<u64> {
    memory().map(|counters| counters.PeakWorkingSetSize as u64)
}

/// Free memory of the machine [bytes].
pub fn available() -> Option<u64> {
    let size = size_of::<MEMORYSTATUSEX>() as u32;
    let mut status = MEMORYSTATUSEX { dwLength: size, ..MEMORYSTATUSEX::default() };
    // SAFETY: only writes the given struct.
    let code = unsafe { GlobalMemoryStatusEx(&mut status) };
    (code != 0).then_some(status.ullAvailPhys)
}

/// User and system, all threads [s].
pub fn cpu_seconds() -> Option<f64> {
    let mut times = [FILETIME::default(); 4];
    let [begun, ended, system, user] = &mut times;
    // SAFETY: only writes the given structs.
    let code = unsafe { GetProcessTimes(GetCurrentProcess(), begun, ended, system, user) };
    // In units of 100 ns.
    let seconds =
        |t: &FILETIME| 1e-7 * ((u64::from(t.dwHighDateTime) << 32) | u64::from(t.dwLowDateTime)) as f64;
    (code != 0).then(|| seconds(&times[2]) + seconds(&times[3]))
}

/// Whether an error is the limit of open files.
pub fn lacks_files(error: &io::Error) -> bool {
    error.raw_os_error() == Some(ERROR_TOO_MANY_OPEN_FILES as i32)
}

/// Whether a process exists.
pub fn is_running(process: u32) -> bool {
    // SAFETY: plain integers.
    let handle = unsafe { OpenProcess(PROCESS_QUERY_LIMITED_INFORMATION, 0, process) };
    if handle.is_null() {
        // Of another user.
        return io::Error::last_os_error().raw_os_error() == Some(ERROR_ACCESS_DENIED as i32);
    }
    let mut code = 0;
    // SAFETY: the handle is open, and closed here.
    let known = unsafe {
        let known = GetExitCodeProcess(handle, &mut code);
        CloseHandle(handle);
        known
    };
    known != 0 && code == STILL_ACTIVE as u32
}

/// Signals that stop a run: Ctrl-C.
pub fn stop_signals() -> Vec<i32> {
    vec![signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM]
}

/// Locks a file for this process; the content stays readable, because the locked byte is beyond it.
pub fn try_lock(file: &File) -> Result<(), TryLockError> {
    let mut place = OVERLAPPED::default();
    place.Anonymous.Anonymous.OffsetHigh = 1 << 30;
    let flags = LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY;
    // SAFETY: the handle is open, and `place` outlives the call, which does not wait.
    let code = unsafe { LockFileEx(file.as_raw_handle(), flags, 0, 1, 0, &mut place) };
    if code != 0 {
        return Ok(());
    }
    let error = io::Error::last_os_error();
    let held = [ERROR_LOCK_VIOLATION, ERROR_IO_PENDING].map(|code| Some(code as i32));
    Err(if held.contains(&error.raw_os_error()) {
        TryLockError::WouldBlock
    } else {
        TryLockError::Error(error)
    })
}

/// An open file cannot be replaced by another process, only deleted.
pub fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

pub fn path_of(_: &File) -> Option<PathBuf> {
    None
}

/// Ctrl-C reaches all processes of a console.
pub fn set_apart(_: &mut Command) {}

/// Without signals a child ends by itself.
pub fn interrupt(_: &Child) {}

pub fn signal_of(_: ExitStatus) -> Option<i32> {
    None
}
