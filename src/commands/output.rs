//! Standard output of commands.

use std::io::Write;
use std::path::Path;
use trackbed_io::failure::Failure;

/// Rejects an existing file without `--force`.
///
/// # Errors
/// Input error.
pub fn refuse_existing(file: &Path, force: bool) -> Result<(), Failure> {
    if force || !file.exists() {
        return Ok(());
    }
    let expected = "a new file, or --force to overwrite it";
    Err(Failure::Input(format!("{}: found an existing file, expected {expected}", file.display())))
}

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
