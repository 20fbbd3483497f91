//! Windows bitmaps: BITMAPFILEHEADER, BITMAPINFOHEADER, 24-bit rows from below, padded to four bytes
//! (Microsoft, "Bitmap storage").

use super::super::sheet::Picture;

/// Length of both headers [bytes].
const HEAD: u32 = 54;

pub fn bytes(picture: &Picture) -> Vec<u8> {
    let (width, height) = (picture.width, picture.height);
    let row = (3 * width).next_multiple_of(4);
    let size = (row * height) as u32;
    let mut out = Vec::with_capacity(HEAD as usize + row * height);
    out.extend(b"BM");
    for word in [HEAD + size, 0, HEAD, 40, width as u32, height as u32] {
        out.extend(word.to_le_bytes());
    }
    out.extend([1, 0, 24, 0]);
    for word in [0, size, 2835, 2835, 0, 0] {
        out.extend(u32::to_le_bytes(word));
    }
    for y in (0..height).rev() {
        let pixels = &picture.pixels[3 * width * y..3 * width * (y + 1)];
        out.extend(pixels.chunks_exact(3).flat_map(|p| [p[2], p[1], p[0]]));
        out.resize(out.len() + row - 3 * width, 0);
    }
    out
}
