//! The program: parse, run, print the error, exit code.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    // clap's own code for wrong usage is 2, which is the code for bad input here too.
    match trackbed::commands::execute(trackbed::cli::Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.code())
        }
    }
}
