//! The program: parse, run, say the error, exit code.

use clap::Parser;
use std::process::ExitCode;
use trackbed::failure::Failure;
use trackbed::{guard, message};

fn main() -> ExitCode {
    guard::install();
    #[cfg(unix)]
    guard::end_at_abort();
    // clap's own code for wrong usage is 2, which is the code for bad input here too.
    match guard::guarded(|| trackbed::commands::execute(trackbed::cli::Cli::parse().command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            match failure {
                // What the user asked for is no error.
                Failure::Interrupted(_) => message::say(&failure.to_string()),
                _ => failure.sentences().iter().for_each(|sentence| message::error(sentence)),
            }
            ExitCode::from(failure.code())
        }
    }
}
