//! Parameter decks of two older programs: one value or list per line, in fixed order, with the key in a
//! bracketed comment.

mod keys;
mod rest;
mod scene;
mod values;

use super::options::Options;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::write::{WriteError, atomic};
use values::Deck;

/// Converts a deck to a scene.
///
/// # Errors
/// Unexpected lines, values out of range, missing files.
pub fn convert(
    (file, text): (&Path, &str),
    output: &Path,
    options: &Options,
) -> Result<Vec<String>, Failure> {
    let deck = Deck::parse(file, text)?;
    let made = scene::scene(&deck, output, options)?;
    atomic::write(output, |out| out.write_all(made.text.as_bytes()).map_err(WriteError::io(output)))?;
    Ok(made.remarks)
}
