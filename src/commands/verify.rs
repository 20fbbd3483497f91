//! `trackbed verify`: the verification matrix.

use super::output;
use crate::cli::VerifyArgs;
use crate::verify::{self, Finished, Place};
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Computes the matrix and prints it.
///
/// # Errors
/// Input and I/O errors, own rows beyond their tolerance.
pub fn verify(args: VerifyArgs) -> Result<(), Failure> {
    let places = args.gpu.then_some(Place::Gpu).into_iter().chain(args.ranks.map(Place::Ranks)).collect();
    let options = verify::Options {
        places,
        matrix: args.matrix,
        out: args.out,
        only: args.only,
        python: args.peers.then_some(args.python),
        page: args.page,
        quiet: args.quiet,
    };
    let Finished { text, failure } = verify::execute(&options)?;
    // Results are saved, so output may fail.
    if !args.quiet
        && let Err(failure) = output::print(&text)
    {
        message::warn(&format!("standard output: {failure}"));
    }
    failure.map_or(Ok(()), Err)
}
