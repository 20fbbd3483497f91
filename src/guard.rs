//! Panics and aborts end a command like other failures.

use crate::failure::Failure;
use crate::machine;
use std::any::Any;
use std::fs::File;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};

static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Records panic locations; with `RUST_BACKTRACE`, also prints.
pub fn install() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        let place = panic.location().map(ToString::to_string);
        let mut noted = PLACE.lock().unwrap_or_else(PoisonError::into_inner);
        if noted.is_none() {
            *noted = place;
        }
        drop(noted);
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|v| v != "0") {
            usual(panic);
        }
    }));
}

/// Without viewer clients and study runs.
const FILES: usize = 16;

/// Checks the limit of open files before a run.
///
/// # Errors
/// Limit too low.
pub fn check_files() -> Result<(), Failure> {
    let mut open = Vec::with_capacity(FILES);
    while open.len() < FILES {
        match File::open("/dev/null") {
            Ok(file) => open.push(file),
            Err(error) if machine::lacks_files(&error) => {
                let found = open.len();
                let text = format!(
                    "open files: found a limit of {found}, expected {FILES} or more. Raise the system limit (ulimit -n)"
                );
                return Err(Failure::Other(text));
            }
            // Not available on this system.
            Err(_) => break,
        }
    }
    Ok(())
}

/// Address space per malloc arena [bytes]; 64 MiB are reserved.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const ARENA: u64 = 1 << 30;

/// Limits malloc arenas under an address space limit: threads without one allocate by mmap, 100 times slower.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub fn share_arenas() {
    let mut limit = libc::rlimit { rlim_cur: libc::RLIM_INFINITY, rlim_max: libc::RLIM_INFINITY };
    // SAFETY: `getrlimit` only writes the given struct.
    let code = unsafe { libc::getrlimit(libc::RLIMIT_AS, &mut limit) };
    if code == 0 && limit.rlim_cur != libc::RLIM_INFINITY {
        let arenas = (limit.rlim_cur / ARENA).clamp(1, 1024) as libc::c_int;
        // SAFETY: set before other threads exist.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, arenas) };
    }
}

/// Turns SIGXFSZ into an I/O error.
#[cfg(unix)]
pub fn report_large_files() {
    // Any handler prevents termination.
    drop(signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default()));
}

/// Makes an abort, such as a stack overflow, exit with code 3.
#[cfg(unix)]
pub fn end_at_abort() {
    const LINE: &[u8] = b"error: memory: found none free, or a stack overflow. Reduce the scene, or raise the system limits (ulimit -v, ulimit -s).\n";
    let action = || {
        // SAFETY: pointer and length of a constant.
        unsafe { libc::write(libc::STDERR_FILENO, LINE.as_ptr().cast(), LINE.len()) };
        signal_hook::low_level::exit(3);
    };
    // SAFETY: only calls `write` and `_exit`, which are async-signal-safe.
    let registered = unsafe { signal_hook::low_level::register(libc::SIGABRT, action) };
    // Otherwise the abort signal ends the process.
    drop(registered);
}

/// Runs `work`; panics, also in joined threads, become failures.
///
/// # Errors
/// Errors of `work`; panics.
pub fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let place = PLACE.lock().unwrap_or_else(PoisonError::into_inner).take();
        let place = place.map_or(String::new(), |place| format!(" ({place})"));
        let text = text(payload.as_ref());
        Err(Failure::Numerical(format!("internal error: {text}{place}; please report it with the scene")))
    })
}

fn text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no reason given").lines().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panic_is_one_line() {
        let parts = [1, 2, 3];
        let failure = guarded(|| Ok(parts[std::hint::black_box(3)])).unwrap_err();
        assert_eq!(failure.code(), 3);
        let text = failure.to_string();
        assert!(text.starts_with("internal error: index out of bounds"), "{text}");
        assert_eq!(text.lines().count(), 1);
        // In a pool thread.
        let failure = guarded(|| {
            rayon::join(|| panic!("two\nlines"), || ());
            Ok(())
        });
        assert!(failure.unwrap_err().to_string().starts_with("internal error: two lines"));
        assert_eq!(guarded(|| Ok(7)).unwrap(), 7);
    }
}
