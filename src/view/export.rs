//! The results of a run as one HTML file.

use std::io::Write;
use std::path::Path;

use flate2::{Compression, write::ZlibEncoder};
use serde_json::json;

use super::page;
use super::results::Results;
use crate::failure::Failure;
use crate::write::{WriteError, atomic};

/// zlib level: above it files shrink by per cents and take twice as long.
const LEVEL: u32 = 6;

/// Writes the page with all blocks of a run.
///
/// # Errors
/// A file of the results is damaged; the disk refuses.
pub fn export(file: &Path, title: &str, results: &Results) -> Result<(), Failure> {
    let names = results.names()?;
    let (head, tail) = page::pieces(title, &json!({ "served": false }));
    // A damaged result ends the writing; it is bad input, not a fault of the disk.
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
