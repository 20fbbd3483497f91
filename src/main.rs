//! The program: parse, run, print the error, exit code.

use clap::Parser;
use std::process::ExitCode;
use trackbed::failure::Failure;

fn main() -> ExitCode {
    // clap's own code for wrong usage is 2, which is the code for bad input here too.
    match trackbed::commands::execute(trackbed::cli::Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // What the user asked for is no error.
            let head = if matches!(failure, Failure::Interrupted(_)) { "" } else { "error: " };
            eprintln!("{head}{failure}");
            ExitCode::from(failure.code())
        }
    }
}
