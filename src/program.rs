//! How the program is started again, for runs as processes of their own.

use std::ffi::OsString;
use std::io;
use std::process::Command;
use std::sync::OnceLock;

/// What a host has said.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Says with which words the program is started where it is part of another one, such as an interpreter; the first call counts.
pub fn started_by(words: Vec<OsString>) {
    let _ = WORDS.set(words);
}

/// The program, ready for its arguments.
///
/// # Errors
/// The system does not say which file is being executed.
pub(crate) fn command() -> io::Result<Command> {
    let Some((first, more)) = WORDS.get().and_then(|words| words.split_first()) else {
        return Ok(Command::new(std::env::current_exe()?));
    };
    let mut command = Command::new(first);
    command.args(more);
    Ok(command)
}
