//! `trackbed completions` and `trackbed manual`: files for shells and packages.

use super::output::print;
use crate::cli::Cli;
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;

/// Prints a completion script.
///
/// # Errors
/// I/O errors.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "trackbed", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Pages of the same names that are no manual pages of the program.
fn foreign_page(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let of_command = name.strip_prefix("trackbed").is_some_and(|rest| rest.starts_with(['.', '-']));
        of_command
            && name.ends_with(".1")
            && !source::text(file).is_ok_and(|text| text.contains(".TH trackbed"))
    });
    files.into_iter().min()
}

/// Writes a manual page of each command (`trackbed-run.1`) into `folder`; overwrites such pages only.
///
/// # Errors
/// Existing file that is no such page; I/O errors.
pub fn manual(folder: &Path) -> Result<(), Failure> {
    if let Some(file) = foreign_page(folder) {
        let expected = "a manual page of trackbed, or a new file";
        return Err(Failure::Input(format!(
            "{}: found an existing file, expected {expected}",
            file.display()
        )));
    }
    let written =
        std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written.map_err(|e| {
        let found = trackbed_io::system::words(&e);
        Failure::Other(format!("{}: found {found}, expected a writable directory", folder.display()))
    })
}
