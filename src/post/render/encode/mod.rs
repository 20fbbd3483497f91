//! Picture and video files.

mod avi;
mod bmp;

use std::path::Path;

use super::sheet::Picture;
use trackbed_io::write::{WriteError, atomic};

pub use avi::write as write_video;

/// Of 100; more is invisible.
const QUALITY: u8 = 92;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Png,
    Jpg,
    Bmp,
    Avi,
}

pub const ENDINGS: [(&str, Form); 5] =
    [("png", Form::Png), ("jpg", Form::Jpg), ("jpeg", Form::Jpg), ("bmp", Form::Bmp), ("avi", Form::Avi)];

impl Form {
    pub fn of(file: &Path) -> Option<Form> {
        let ending = file.extension()?.to_str()?.to_lowercase();
        ENDINGS.iter().find(|(e, _)| *e == ending).map(|(_, form)| *form)
    }
}

/// Writes a picture atomically.
///
/// # Errors
/// I/O errors.
pub fn write(file: &Path, form: Form, picture: &Picture) -> Result<(), WriteError> {
    let bytes = match form {
        Form::Png => png(file, picture)?,
        Form::Jpg => jpg(file, picture)?,
        Form::Bmp => bmp::bytes(picture),
        Form::Avi => {
            return write_video(file, [picture.width, picture.height], 1.0, 1, |_| Ok(picture.clone()));
        }
    };
    atomic::write(file, |out| out.write_all(&bytes).map_err(WriteError::io(file)))
}

fn png(file: &Path, picture: &Picture) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    let refused = |error: png::EncodingError| WriteError::format(file, error);
    let mut encoder = png::Encoder::new(&mut bytes, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&picture.pixels).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// Fails for pictures too large for JPEG.
pub fn jpg(file: &Path, picture: &Picture) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    let refused = |error: jpeg_encoder::EncodingError| WriteError::format(file, error);
    let side = |n: usize| u16::try_from(n).map_err(|_| WriteError::format(file, "a side above 65535 pixels"));
    let mut encoder = jpeg_encoder::Encoder::new(&mut bytes, QUALITY);
    // Thin lines keep their colours.
    encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::R_4_4_4);
    let (width, height) = (side(picture.width)?, side(picture.height)?);
    encoder.encode(&picture.pixels, width, height, jpeg_encoder::ColorType::Rgb).map_err(refused)?;
    Ok(bytes)
}
