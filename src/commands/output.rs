//! Standard output of commands.

use crate::failure::Failure;
use std::io::Write;

/// Prints text; a closed reader is no failure.
///
/// # Errors
/// I/O errors.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    // Otherwise buffered output could be lost silently.
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}
