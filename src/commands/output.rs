//! What commands print.

use crate::failure::Failure;
use std::io::Write;

/// Prints to standard output; a reader that has gone away is no failure.
///
/// # Errors
/// The system refuses.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    // What is left in a buffer would be lost in silence at the end.
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}
