//! Parameter decks of two older programs: one value or list on each line, in a fixed order, with a comment in brackets
//! behind it that names the key.
//!
//! Both orders are in `keys`; `scene` says what becomes of each key. A key that is not used is named with the reason, in the
//! head of the scene and on the terminal.

mod keys;
mod rest;
mod scene;
mod values;

use super::options::Options;
use crate::failure::Failure;
use crate::write::{WriteError, atomic};
use std::path::Path;
use values::Deck;

/// Converts a deck to a scene.
///
/// # Errors
/// A line that is not what its place says, values out of range, files that a key needs.
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
