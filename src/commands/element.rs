//! `trackbed element`: tests of constitutive laws at one stress point.

use super::output;
use crate::cli::ElementArgs;
use crate::element::{self, Finished};
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Runs the tests of a file and prints their figures and checks.
///
/// # Errors
/// Input and I/O errors, a step that does not converge, a failed check.
pub fn element(args: ElementArgs) -> Result<(), Failure> {
    let options = element::Options { out: args.out, set: args.set, force: args.force };
    let Finished { text, json, failure } = element::execute(&args.file, &options)?;
    // Results are saved, so output may fail.
    if let Err(failure) = output::print(if args.json { &json } else { &text }) {
        message::warn(&format!("standard output: {failure}"));
    }
    failure.map_or(Ok(()), Err)
}
