//! Main program: command line, errors, exit code.

use std::process::ExitCode;
use trackbed::failure::Failure;
use trackbed::{allocator, guard, message};

#[global_allocator]
static ALLOCATOR: allocator::Allocator = allocator::Allocator;

fn main() -> ExitCode {
    guard::install();
    // clap's exit code for wrong usage is also 2.
    let work = || {
        let command = trackbed::cli::Cli::read()?.command;
        guard::check_files()?;
        trackbed::commands::execute(command)
    };
    match guard::guarded(work) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            match failure {
                // Requested, hence no error.
                Failure::Interrupted(_) => message::say(&failure.to_string()),
                _ => failure.sentences().iter().for_each(|sentence| message::error(sentence)),
            }
            ExitCode::from(failure.code())
        }
    }
}
