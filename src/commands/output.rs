//! What commands print.

use crate::failure::Failure;
use std::io::Write;

/// Prints to standard output; a reader that has gone away is no failure.
///
/// # Errors
/// The system refuses.
pub fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}
