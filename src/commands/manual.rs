//! `trackbed completions` and `trackbed manual`: files for shells and packages.

use super::output::print;
use crate::cli::Cli;
use crate::failure::Failure;
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::Path;

/// Prints a completion script.
///
/// # Errors
/// I/O errors.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "trackbed", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Writes a manual page of each command (`trackbed-run.1`) into `folder`.
///
/// # Errors
/// I/O errors.
pub fn manual(folder: &Path) -> Result<(), Failure> {
    let written =
        std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written.map_err(|e| {
        let found = crate::system::words(&e);
        Failure::Other(format!("{}: found {found}, expected a writable directory", folder.display()))
    })
}
