//! The program: parse, run, say the error, exit code.

use clap::Parser;
use std::process::ExitCode;
use trackbed::failure::Failure;
use trackbed::{guard, message};

fn main() -> ExitCode {
    guard::install();
    // clap's own code for wrong usage is 2, which is the code for bad input here too.
    match guard::guarded(|| trackbed::commands::execute(trackbed::cli::Cli::parse().command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // What the user asked for is no error.
            let head = if matches!(failure, Failure::Interrupted(_)) { "" } else { "error: " };
            message::say(&format!("{head}{failure}"));
            ExitCode::from(failure.code())
        }
    }
}
