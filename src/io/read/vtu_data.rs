//! Binary arrays of VTK XML files.

use base64::prelude::{BASE64_STANDARD, Engine};
use std::io::Read;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Coding {
    pub zlib: bool,
    pub wide: bool,
    pub big_endian: bool,
}

/// Largest compression of zlib (Deflate's longest match); damaged lengths exceed it.
const MOST_COMPRESSION: u64 = 1032;

struct Stream<'a> {
    bytes: &'a [u8],
    base64: bool,
    /// Decoded, unread bytes of the last base64 group.
    pending: Vec<u8>,
}

impl Stream<'_> {
    /// Fast path for base64 without white space or padding: files of a million grains have 100 MB.
    fn whole_groups(&mut self, count: usize) -> Option<Vec<u8>> {
        let letters = count.div_ceil(3) * 4;
        if !self.pending.is_empty() || letters > self.bytes.len() {
            return None;
        }
        let (head, rest) = self.bytes.split_at(letters);
        let mut out = BASE64_STANDARD.decode(head).ok()?;
        if out.len() < count {
            return None;
        }
        self.bytes = rest;
        self.pending = out.split_off(count);
        Some(out)
    }

    fn read(&mut self, count: usize) -> Result<Vec<u8>, String> {
        let ends = || "the end of the data".to_string();
        if count > self.bytes.len() + self.pending.len() {
            return Err(ends());
        }
        if !self.base64 {
            let (head, rest) = self.bytes.split_at(count);
            self.bytes = rest;
            return Ok(head.to_vec());
        }
        if let Some(out) = self.whole_groups(count) {
            return Ok(out);
        }
        let mut out = std::mem::take(&mut self.pending);
        while out.len() < count {
            // Padding may stand within the data after encoded lengths.
            let mut group = [0; 4];
            let mut filled = 0;
            while filled < 4 {
                let (letter, rest) = self.bytes.split_first().ok_or_else(ends)?;
                self.bytes = rest;
                if !letter.is_ascii_whitespace() {
                    group[filled] = *letter;
                    filled += 1;
                }
            }
            let mut bytes = [0; 3];
            let decoded = BASE64_STANDARD.decode_slice(group, &mut bytes);
            out.extend(&bytes[..decoded.map_err(|_| "letters that are not base64")?]);
        }
        self.pending = out.split_off(count);
        Ok(out)
    }
}

/// Decodes at most `most` numbers of type `kind`; the error states the value found.
pub(super) fn decode(
    bytes: &[u8],
    base64: bool,
    kind: &str,
    coding: Coding,
    most: u64,
) -> Result<Vec<f64>, String> {
    let mut stream = Stream { bytes, base64, pending: Vec::new() };
    let width = width(kind)?;
    let fits = |bytes: u64| match bytes / width as u64 {
        count if count > most => Err(format!("{count} numbers")),
        _ => Ok(()),
    };
    let data = match coding.zlib {
        true => inflate(&mut stream, coding, fits)?,
        false => plain(&mut stream, coding, fits)?,
    };
    numbers(&data, kind, width, coding.big_endian)
}

fn width(kind: &str) -> Result<usize, String> {
    match kind {
        "Int8" | "UInt8" => Ok(1),
        "Int16" | "UInt16" => Ok(2),
        "Int32" | "UInt32" | "Float32" => Ok(4),
        "Int64" | "UInt64" | "Float64" => Ok(8),
        _ => Err(format!("type \"{kind}\"")),
    }
}

fn length(stream: &mut Stream, coding: Coding) -> Result<u64, String> {
    let bytes = stream.read(if coding.wide { 8 } else { 4 })?;
    Ok(unsigned(&bytes, coding.big_endian))
}

fn unsigned(bytes: &[u8], big_endian: bool) -> u64 {
    let add = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
    if big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
}

fn plain(
    stream: &mut Stream,
    coding: Coding,
    fits: impl Fn(u64) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let count = length(stream, coding)?;
    fits(count)?;
    stream.read(usize::try_from(count).map_err(|_| format!("a length of {count}"))?)
}

/// Number of blocks, block length, length of a shorter last block, compressed lengths, blocks.
fn inflate(
    stream: &mut Stream,
    coding: Coding,
    fits: impl Fn(u64) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let blocks = length(stream, coding)?;
    let (size, last) = (length(stream, coding)?, length(stream, coding)?);
    let most = (stream.bytes.len() + stream.pending.len()) as u64;
    if blocks > most {
        return Err(format!("{blocks} blocks"));
    }
    let shorter = if last > 0 { last } else { size };
    fits(size.saturating_mul(blocks.saturating_sub(1)).saturating_add(shorter))?;
    let lengths: Vec<u64> = (0..blocks).map(|_| length(stream, coding)).collect::<Result<_, _>>()?;
    // Lengths are encoded separately: the remainder of their last group is padding.
    stream.pending.clear();
    let mut out = Vec::new();
    for (block, packed) in lengths.iter().enumerate() {
        let is_last = block as u64 + 1 == blocks;
        let expected = if is_last && last > 0 { last } else { size };
        if *packed > most || expected > packed.saturating_mul(MOST_COMPRESSION) {
            return Err(format!("a block of {packed} bytes for {expected}"));
        }
        let packed = stream.read(*packed as usize)?;
        let before = out.len();
        flate2::read::ZlibDecoder::new(&packed[..])
            .take(expected)
            .read_to_end(&mut out)
            .map_err(|_| "damaged compressed data".to_string())?;
        if (out.len() - before) as u64 != expected {
            return Err(format!("{} bytes in a block of {expected}", out.len() - before));
        }
    }
    Ok(out)
}

fn numbers(data: &[u8], kind: &str, width: usize, big_endian: bool) -> Result<Vec<f64>, String> {
    if !data.len().is_multiple_of(width) {
        return Err(format!("{} bytes of {kind}", data.len()));
    }
    if kind == "Float64" && !big_endian {
        let (groups, _) = data.as_chunks::<8>();
        return Ok(groups.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect());
    }
    let shift = 64 - 8 * width;
    let number = |bytes: &[u8]| -> f64 {
        let bits = unsigned(bytes, big_endian);
        match kind {
            "Float32" => f64::from(f32::from_bits(bits as u32)),
            "Float64" => f64::from_bits(bits),
            _ if kind.starts_with('U') => bits as f64,
            _ => (((bits << shift) as i64) >> shift) as f64,
        }
    };
    Ok(data.chunks_exact(width).map(number).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_with_padding_in_the_middle() {
        for text in ["AwAAAGFiYw==", "AwAAAA==YWJj", "  AwAA\nAGFiYw=="] {
            let mut stream = Stream { bytes: text.as_bytes(), base64: true, pending: Vec::new() };
            assert_eq!(plain(&mut stream, Coding::default(), |_| Ok(())).unwrap(), b"abc", "{text}");
        }
        for text in ["AwAAAGFi", "AwAAAGF!Yw==", "AwAA==FiYw=="] {
            let mut stream = Stream { bytes: text.as_bytes(), base64: true, pending: Vec::new() };
            assert!(plain(&mut stream, Coding::default(), |_| Ok(())).is_err(), "{text}");
        }
    }
}
