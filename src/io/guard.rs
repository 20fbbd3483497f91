//! Panics and aborts end a command like other failures.

use crate::failure::Failure;
use crate::system;
use std::any::Any;
use std::fs::File;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Mutex, PoisonError};

static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Prepares the process, before other threads exist.
pub fn install() {
    system::prepare();
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

/// Number of files that can be opened, up to `most`; `most` if unknown.
pub fn free_files(most: usize) -> usize {
    let mut open = Vec::with_capacity(most);
    while open.len() < most {
        match File::open(system::NULL_DEVICE) {
            Ok(file) => open.push(file),
            Err(error) if system::lacks_files(&error) => return open.len(),
            // Not available on this system.
            Err(_) => return most,
        }
    }
    most
}

/// Checks the limit of open files before a run.
///
/// # Errors
/// Limit too low.
pub fn check_files() -> Result<(), Failure> {
    let found = free_files(FILES);
    if found < FILES {
        let expected = format!("{FILES} or more. Raise the system limit (ulimit -n)");
        return Err(Failure::Other(format!("open files: found a limit of {found}, expected {expected}")));
    }
    Ok(())
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
