//! Motion JPEG in AVI with index (Microsoft, "AVI RIFF file reference"; one stream, one RIFF list, `idx1`).
//!
//! Frames are written one by one; lengths and index follow.

use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

use super::super::sheet::Picture;
use super::jpg;
use trackbed_io::write::{WriteError, atomic};

/// Largest RIFF list: readers use 31-bit lengths.
const MOST: u64 = (1 << 31) - (1 << 20);
/// Frame without predecessors.
const KEY_FRAME: u32 = 0x10;
const HAS_INDEX: u32 = 0x10;

/// Writes a video of `count` equal-sized pictures atomically.
///
/// # Errors
/// Errors of `frame`; too long video; I/O errors.
pub fn write<E: From<WriteError>>(
    file: &Path,
    size: [usize; 2],
    rate: f64,
    count: usize,
    mut frame: impl FnMut(usize) -> Result<Picture, E>,
) -> Result<(), E> {
    atomic::write_in_places(file, |out| {
        let mut lengths: Vec<u32> = Vec::with_capacity(count);
        let mut sum = 0;
        out.write_all(&head(size, rate, &[], 0)).map_err(WriteError::io(file))?;
        for k in 0..count {
            let jpeg = jpg(file, &frame(k)?)?;
            sum += jpeg.len() as u64 + 24;
            if sum > MOST {
                let found =
                    format!("more than 2 GiB after {k} frames, expected less: take fewer or smaller ones");
                return Err(WriteError::format(file, found).into());
            }
            one(out, &jpeg).map_err(WriteError::io(file))?;
            lengths.push(jpeg.len() as u32);
        }
        Ok(finish(out, size, rate, &lengths).map_err(WriteError::io(file))?)
    })
}

fn one(out: &mut impl Write, jpeg: &[u8]) -> std::io::Result<()> {
    out.write_all(b"00dc")?;
    out.write_all(&(jpeg.len() as u32).to_le_bytes())?;
    out.write_all(jpeg)?;
    out.write_all(&[0][..jpeg.len() % 2])
}

fn finish(
    out: &mut (impl Write + Seek),
    size: [usize; 2],
    rate: f64,
    lengths: &[u32],
) -> std::io::Result<()> {
    let index = index(lengths);
    out.write_all(&index)?;
    out.seek(SeekFrom::Start(0))?;
    out.write_all(&head(size, rate, lengths, index.len() as u32))
}

fn chunk(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let mut out = name.to_vec();
    out.extend((content.len() as u32).to_le_bytes());
    out.extend(content);
    out
}

fn list(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    chunk(b"LIST", &[name, content].concat())
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

fn data(lengths: &[u32]) -> u32 {
    lengths.iter().map(|l| 8 + l.next_multiple_of(2)).sum()
}

/// Header up to the first frame.
fn head([width, height]: [usize; 2], rate: f64, lengths: &[u32], index: u32) -> Vec<u8> {
    let [width, height] = [width as u32, height as u32];
    let micro = (1e6 / rate).round() as u32;
    let most = lengths.iter().copied().max().unwrap_or(0);
    let count = lengths.len() as u32;
    let second = (f64::from(most) * rate.ceil()) as u32;
    let main = words(&[micro, second, 0, HAS_INDEX, count, 0, 1, most, width, height, 0, 0, 0, 0]);
    let mut stream = b"vidsMJPG".to_vec();
    stream.extend(words(&[0, 0, 0, micro, 1_000_000, 0, count, most, u32::MAX, 0]));
    stream.extend([0_u16, 0, width as u16, height as u16].iter().flat_map(|v| v.to_le_bytes()));
    let mut form = words(&[40, width, height]);
    form.extend([1, 0, 24, 0]);
    form.extend(b"MJPG");
    form.extend(words(&[3 * width * height, 0, 0, 0, 0]));
    let streams = list(b"strl", &[chunk(b"strh", &stream), chunk(b"strf", &form)].concat());
    let head = list(b"hdrl", &[chunk(b"avih", &main), streams].concat());
    let movie = 4 + data(lengths);
    let mut out = b"RIFF".to_vec();
    out.extend((4 + head.len() as u32 + 8 + movie + index).to_le_bytes());
    out.extend(b"AVI ");
    out.extend(head);
    out.extend(b"LIST");
    out.extend(movie.to_le_bytes());
    out.extend(b"movi");
    out
}

/// Frame offsets from `movi`.
fn index(lengths: &[u32]) -> Vec<u8> {
    let mut content = Vec::with_capacity(16 * lengths.len());
    let mut at = 4;
    for length in lengths {
        content.extend(b"00dc");
        content.extend(words(&[KEY_FRAME, at, *length]));
        at += 8 + length.next_multiple_of(2);
    }
    chunk(b"idx1", &content)
}
