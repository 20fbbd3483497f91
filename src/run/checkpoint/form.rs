//! Checkpoint file format.
//!
//! ```text
//! trackbed checkpoint N\n        format version
//! { header }\n                   JSON: program, scene, stage, step, time
//! body                           binary, bitwise exact
//! 8 bytes                        64-bit FNV-1a checksum of all before, low byte first
//! ```
//!
//! The body is a sequence of `postcard` parts (little endian, varint), read in writing order. Fields are
//! unnamed, so no type may skip a field (`skip_serializing_if`).

use super::origin::Origin;
use crate::hash::Hash;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use trackbed_io::failure::Failure;

pub(super) const MAGIC: &str = "trackbed checkpoint ";
/// Supported format version.
pub(super) const FORM: u32 = 26;
pub(super) const CHECKSUM: usize = 8;
const BUFFER: usize = 1 << 18;

/// Position of a checkpoint in the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Stage name, such as `run`.
    pub stage: String,
    /// Completed steps or windows of the stage.
    pub step: u64,
    /// Simulated time of the stage [s].
    pub time: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    /// The higher number of two slots is later.
    pub(super) number: u64,
    pub(super) moment: Moment,
    pub(super) origin: Origin,
}

pub(super) enum Unfit {
    /// Foreign format version.
    Form(String),
    /// Damaged.
    Damaged(String),
}

/// Also distinguishes a foreign format version from a damaged digit.
fn is_whole(bytes: &[u8]) -> bool {
    let end = bytes.len().saturating_sub(CHECKSUM);
    let mut hash = Hash::default();
    hash.add(&bytes[..end]);
    bytes[end..] == hash.value().to_le_bytes()
}

pub(super) fn read(bytes: Vec<u8>) -> Result<(Header, Loaded), Unfit> {
    let damaged = |text: &str| Unfit::Damaged(text.to_string());
    let line = |from: usize| bytes[from..].iter().position(|b| *b == b'\n').map(|n| from + n);
    let first = line(0).ok_or_else(|| damaged("no first line"))?;
    let form = std::str::from_utf8(&bytes[..first]).ok().and_then(|l| l.strip_prefix(MAGIC));
    match form.and_then(|f| f.parse::<u32>().ok()) {
        Some(other) if other != FORM && is_whole(&bytes) => {
            return Err(Unfit::Form(format!("found checkpoint format version {other}, expected {FORM}")));
        }
        Some(_) => {}
        None => return Err(damaged("no checkpoint header")),
    }
    if !is_whole(&bytes) {
        return Err(damaged("wrong checksum"));
    }
    let end = bytes.len().saturating_sub(CHECKSUM);
    let second = line(first + 1).ok_or_else(|| damaged("no header"))?;
    let header: Header =
        serde_json::from_slice(&bytes[first + 1..second]).map_err(|e| Unfit::Damaged(e.to_string()))?;
    let moment = header.moment.clone();
    Ok((header, Loaded { moment, at: second + 1, end, bytes }))
}

pub(super) fn write(
    out: &mut dyn Write,
    header: &Header,
    fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let header = serde_json::to_string(header).map_err(io::Error::other)?;
    let mut body = Body { out, hash: Hash::default(), buffer: Vec::with_capacity(BUFFER) };
    body.write_all(format!("{MAGIC}{FORM}\n{header}\n").as_bytes())?;
    fill(&mut body)?;
    body.finish()
}

/// Checkpoint body being written.
pub struct Body<'a> {
    out: &'a mut dyn Write,
    hash: Hash,
    buffer: Vec<u8>,
}

impl Body<'_> {
    /// Appends a part.
    ///
    /// # Errors
    /// I/O errors.
    pub fn put<T: Serialize + ?Sized>(&mut self, part: &T) -> io::Result<()> {
        postcard::to_io(part, self).map(|_| ()).map_err(io::Error::other)
    }

    fn pass(&mut self) -> io::Result<()> {
        self.hash.add(&self.buffer);
        self.out.write_all(&self.buffer)?;
        self.buffer.clear();
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        self.pass()?;
        self.out.write_all(&self.hash.value().to_le_bytes())
    }
}

impl Write for Body<'_> {
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= BUFFER {
            self.pass()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Checkpoint that was read.
pub struct Loaded {
    /// Position in the run.
    pub moment: Moment,
    bytes: Vec<u8>,
    at: usize,
    end: usize,
}

impl Loaded {
    /// Reads the next part.
    ///
    /// # Errors
    /// Part of another type, from a different build.
    pub fn take<T: DeserializeOwned>(&mut self) -> Result<T, Failure> {
        let (part, rest) = postcard::take_from_bytes(&self.bytes[self.at..self.end])
            .map_err(|e| Failure::Input(format!("--resume: found a checkpoint of another program: {e}")))?;
        self.at = self.end - rest.len();
        Ok(part)
    }
}
