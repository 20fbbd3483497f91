//! `trackbed life`: traffic and tampings over the life of a track.

use super::{check, output};
use crate::cli::LifeArgs;
use crate::life;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_post::preview::Source;
use trackbed_run::Interrupt;

/// Runs a life and prints its table.
///
/// # Errors
/// Input and I/O errors, interrupts, failed runs.
pub fn life(args: LifeArgs) -> Result<(), Failure> {
    let options = life::Options {
        out: args.out,
        threads: args.threads,
        resume: args.resume,
        force: args.force,
        plan: args.plan,
        quiet: args.quiet,
        interrupt: Interrupt::on_signals("the active runs have written checkpoints")?,
    };
    let check = |scene: &Path, set: &[String]| check::check(&Source::new(scene, set), None, false).map(drop);
    let text = life::execute(&args.life, &options, check)?;
    // Tables are saved, so output may fail.
    if !args.quiet
        && let Err(failure) = output::print(&text)
    {
        message::note(&format!("standard output: {failure}"));
    }
    Ok(())
}
