//! A fault of the program itself ends a command as every other failure does: in one line, with an exit code, with what was
//! kept before.

use crate::failure::Failure;
use crate::machine;
use std::any::Any;
use std::fs::File;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};

/// Place of the first panic, until it is reported.
static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Notes where a panic is instead of printing it; with the variable `RUST_BACKTRACE` it is printed as well.
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

/// Files and connections that a command opens at a time, besides those of a viewer's clients and of the runs of a study.
const FILES: usize = 16;

/// Checks that as many files can be opened as a command needs: later the lack of one would be found in the middle of a run.
///
/// # Errors
/// The limit of open files, of this process or of the system, is too low.
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
            // A system without this file.
            Err(_) => break,
        }
    }
    Ok(())
}

/// Address space for one arena of the C library's allocator [bytes]: it reserves 64 MiB for each.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const ARENA: u64 = 1 << 30;

/// Under a limit of the address space has threads share arenas: a thread that gets none has each of its allocations mapped by the system, 100 times
/// slower.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub fn share_arenas() {
    let mut limit = libc::rlimit { rlim_cur: libc::RLIM_INFINITY, rlim_max: libc::RLIM_INFINITY };
    // SAFETY: the call fills the structure that it is given, and does nothing else.
    let code = unsafe { libc::getrlimit(libc::RLIMIT_AS, &mut limit) };
    if code == 0 && limit.rlim_cur != libc::RLIM_INFINITY {
        let arenas = (limit.rlim_cur / ARENA).clamp(1, 1024) as libc::c_int;
        // SAFETY: the call sets a parameter of the allocator, before there are other threads.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, arenas) };
    }
}

/// Has a file that grows beyond the limit of its size (SIGXFSZ) be an error of that file instead of the end of the process.
#[cfg(unix)]
pub fn report_large_files() {
    // Having any action, the signal does not end the process, and the system returns an error to the writer.
    drop(signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default()));
}

/// Has an abort of the process, such as one whose stack has overflowed, end it with exit code 3 and one line.
#[cfg(unix)]
pub fn end_at_abort() {
    const LINE: &[u8] = b"error: memory: found none free, or a stack overflow. Reduce the scene, or raise the system limits (ulimit -v, ulimit -s).\n";
    let action = || {
        // SAFETY: the bytes are those of a constant.
        unsafe { libc::write(libc::STDERR_FILENO, LINE.as_ptr().cast(), LINE.len()) };
        signal_hook::low_level::exit(3);
    };
    // SAFETY: the action calls `write` and `_exit` only, which are async-signal-safe.
    let registered = unsafe { signal_hook::low_level::register(libc::SIGABRT, action) };
    // Without it an abort ends the process by its signal.
    drop(registered);
}

/// Carries `work` out; a panic in it, or in a thread that it waits for, is a failure with exit code 3.
///
/// # Errors
/// Those of `work`, and a panic.
pub fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let place = PLACE.lock().unwrap_or_else(PoisonError::into_inner).take();
        let place = place.map_or(String::new(), |place| format!(" ({place})"));
        let text = text(payload.as_ref());
        Err(Failure::Numerical(format!("internal error: {text}{place}; please report it with the scene")))
    })
}

/// What a panic says, in one line.
fn text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no reason given").lines().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_one_line_with_exit_code_3() {
        let parts = [1, 2, 3];
        let failure = guarded(|| Ok(parts[std::hint::black_box(3)])).unwrap_err();
        assert_eq!(failure.code(), 3);
        let text = failure.to_string();
        assert!(text.starts_with("internal error: index out of bounds"), "{text}");
        assert_eq!(text.lines().count(), 1);
        // In a thread of the pool.
        let failure = guarded(|| {
            rayon::join(|| panic!("two\nlines"), || ());
            Ok(())
        });
        assert!(failure.unwrap_err().to_string().starts_with("internal error: two lines"));
        assert_eq!(guarded(|| Ok(7)).unwrap(), 7);
    }
}
