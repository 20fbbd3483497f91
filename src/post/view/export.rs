//! Page with all blocks as one HTML file.

use std::io::Write;
use std::path::Path;

use flate2::{Compression, write::ZlibEncoder};
use serde_json::json;

use super::chunk::Blocks;
use super::page;
use trackbed_io::failure::Failure;
use trackbed_io::write::{WriteError, atomic};

/// zlib level: higher levels take twice as long for a few per cent.
const LEVEL: u32 = 6;

/// Writes the page with all blocks.
///
/// # Errors
/// Damaged results; I/O errors.
pub fn export(file: &Path, title: &str, results: &impl Blocks) -> Result<(), Failure> {
    let names = results.names()?;
    let (head, tail) = page::pieces(title, &json!({ "served": false }));
    // Damaged results are input errors, not I/O errors.
    let mut damaged = None;
    let written = atomic::write(file, |out| {
        out.write_all(head.0.as_bytes()).map_err(WriteError::io(file))?;
        for name in &names {
            let block = match results.block(name) {
                Ok(Some(block)) => block,
                Ok(None) => continue,
                Err(failure) => {
                    damaged = Some(failure);
                    return Err(WriteError::format(file, "not written"));
                }
            };
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
            let deflated = encoder.write_all(&block).and_then(|()| encoder.finish());
            let text = page::embedded(name, &deflated.map_err(WriteError::io(file))?);
            out.write_all(text.0.as_bytes()).map_err(WriteError::io(file))?;
        }
        out.write_all(tail.0.as_bytes()).map_err(WriteError::io(file))
    });
    match damaged {
        Some(failure) => Err(failure),
        None => Ok(written?),
    }
}
