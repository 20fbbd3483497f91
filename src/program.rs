//! Restart of the program for separate runs.

use std::ffi::OsString;
use std::io;
use std::process::Command;
use std::sync::OnceLock;

static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Sets the start command of an embedding program; the first call counts.
pub fn started_by(words: Vec<OsString>) {
    let _ = WORDS.set(words);
}

/// Command for this program.
///
/// # Errors
/// Executable path unknown.
pub(crate) fn command() -> io::Result<Command> {
    let Some((first, more)) = WORDS.get().and_then(|words| words.split_first()) else {
        return Ok(Command::new(std::env::current_exe()?));
    };
    let mut command = Command::new(first);
    command.args(more);
    Ok(command)
}
