//! Reader of GeoTIFF heights (`.tif`, `.tiff`).
//!
//! One unrotated band; the raster type places samples at cell centres or corners.
//!
//! Source: OGC GeoTIFF standard 1.1 (19-008r4). Decoding: crate `tiff`.
//! Limits: first image only, plane coordinates in metres.

use std::io::Cursor;
use std::path::Path;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::error::ReadError;
use super::grid::{Grid, MOST_SAMPLES};
use super::mesh_file::read_bytes;
use super::surface::Surface;

const MODEL_TYPE: u64 = 1024;
const RASTER_TYPE: u64 = 1025;
const GEOGRAPHIC: u64 = 2;
const PIXEL_IS_POINT: u64 = 2;

type Source = Decoder<Cursor<Vec<u8>>>;

/// Reads a GeoTIFF as a surface.
///
/// # Errors
/// Damaged or other files, several bands, missing position, rotated grids, degrees.
pub fn read_geotiff(file: &Path) -> Result<Surface, ReadError> {
    let bytes = read_bytes(file, "GeoTIFF")?;
    let broken =
        |e: tiff::TiffError| ReadError::whole(file, "GeoTIFF", e.to_string(), "a TIFF that can be read");
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MOST_SAMPLES;
    let mut source = Decoder::new(Cursor::new(bytes)).map_err(broken)?.with_limits(limits);
    let (columns, rows) = source.dimensions().map_err(broken)?;
    let (columns, rows) = (columns as usize, rows as usize);
    if columns < 2 || rows < 2 || columns.checked_mul(rows).is_none_or(|n| n > MOST_SAMPLES) {
        let expected = format!("2 or more each way, at most {MOST_SAMPLES} in all");
        return Err(ReadError::whole(file, "size", format!("{columns} times {rows} samples"), expected));
    }
    let (corner, step) = place(file, &mut source)?;
    let absent = absent(&mut source);
    let values = values(file, source.read_image().map_err(broken)?)?;
    if values.len() != columns * rows {
        let found = format!("{} values for {columns} times {rows} samples", values.len());
        return Err(ReadError::whole(file, "bands", found, "one band"));
    }
    let mut heights = Vec::with_capacity(values.len());
    for value in values {
        let there = !value.is_nan() && Some(value) != absent;
        if there && value.is_infinite() {
            return Err(ReadError::whole(file, "height", value.to_string(), "finite numbers"));
        }
        heights.push(there.then_some(value));
    }
    Grid { columns, rows, corner, step, heights }.surface(file)
}

fn place(file: &Path, source: &mut Source) -> Result<([f64; 2], [f64; 2]), ReadError> {
    let keys = source.get_tag_u64_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    let key = |id: u64| keys.chunks_exact(4).skip(1).find(|k| k[0] == id && k[1] == 0).map(|k| k[3]);
    if key(MODEL_TYPE) == Some(GEOGRAPHIC) {
        let expected = "metres on a plane: project it first, for example with gdalwarp -t_srs";
        return Err(ReadError::whole(file, "coordinates", "degrees", expected));
    }
    let numbers = |source: &mut Source, tag| source.get_tag_f64_vec(tag).unwrap_or_default();
    let scale = numbers(source, Tag::ModelPixelScaleTag);
    let tie = numbers(source, Tag::ModelTiepointTag);
    let matrix = numbers(source, Tag::ModelTransformationTag);
    let (origin, step) = match (scale.as_slice(), tie.as_slice(), matrix.as_slice()) {
        ([dx, dy, ..], [i, j, _, x, y, ..], _) => ([x - i * dx, y + j * dy], [*dx, *dy]),
        (_, _, [a, b, _, x, d, e, _, y, ..]) => {
            if *b != 0.0 || *d != 0.0 {
                return Err(ReadError::whole(file, "transformation", "a rotated grid", "rows along x"));
            }
            ([*x, *y], [*a, -e])
        }
        _ => {
            let expected = "a pixel scale with a tie point, or a transformation";
            return Err(ReadError::whole(file, "place", "none", expected));
        }
    };
    if !step.iter().all(|s| *s > 0.0 && s.is_finite()) || !origin.iter().all(|x| x.is_finite()) {
        let found = format!("steps ({}, {}) from ({}, {})", step[0], step[1], origin[0], origin[1]);
        return Err(ReadError::whole(file, "place", found, "finite places, steps above 0, north up"));
    }
    // Area samples lie at cell centres.
    let shift = if key(RASTER_TYPE) == Some(PIXEL_IS_POINT) { 0.0 } else { 0.5 };
    Ok(([origin[0] + shift * step[0], origin[1] - shift * step[1]], step))
}

fn absent(source: &mut Source) -> Option<f64> {
    source.get_tag_ascii_string(Tag::GdalNodata).ok()?.trim().trim_end_matches('\0').parse().ok()
}

fn values(file: &Path, image: DecodingResult) -> Result<Vec<f64>, ReadError> {
    Ok(match image {
        DecodingResult::U8(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::U16(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::U32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I8(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I16(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::F32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::F64(v) => v,
        _ => {
            let expected = "whole numbers of 8 to 32 bits or real numbers of 32 or 64 bits";
            return Err(ReadError::whole(file, "samples", "another kind of number", expected));
        }
    })
}

#[cfg(test)]
#[path = "geotiff_tests.rs"]
mod tests;
