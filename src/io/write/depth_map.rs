//! Depth map of a slide in plan, as VTK image (`.vti`) and picture (`.png`).
//!
//! Sources: VTK's User's Guide, "VTK XML formats", `ImageData`; hillshading: Horn, Proc. IEEE 69, 1981.

use std::path::Path;

use super::atomic;
use super::error::WriteError;
use super::vtk::{self, Fields};

/// Least size of the shorter side [px]; cells are whole pixels.
const PIXELS: usize = 400;
/// Largest cell [px].
const LARGEST: usize = 16;

const RAMP: [[f64; 3]; 5] = [
    [255.0, 245.0, 200.0],
    [254.0, 204.0, 92.0],
    [253.0, 141.0, 60.0],
    [227.0, 26.0, 28.0],
    [128.0, 0.0, 38.0],
];

/// Cells in plan, x fastest. All fields have the shape `[cells]`.
pub struct DepthMap<'a> {
    /// Lower corner; the third coordinate is the height of the image [m].
    pub low: [f64; 3],
    /// Side of a cell [m].
    pub cell: f64,
    /// Cells along x and y.
    pub counts: [usize; 2],
    /// Ground elevation [m].
    pub ground: &'a [f64],
    /// Deposit depth [m].
    pub depth: &'a [f64],
    /// Grain volume per area [m].
    pub solid: &'a [f64],
    /// Mean travel distance of grains [m].
    pub travel: &'a [f64],
    /// Whether the cell is part of the deposit.
    pub inside: &'a [bool],
}

/// Writes a VTK image with cell data `depth`, `solid`, `ground`, `travel`, `deposit`.
///
/// # Errors
/// Wrong field length, non-finite values; I/O errors.
pub fn write_vti(file: &Path, map: &DepthMap<'_>) -> Result<(), WriteError> {
    let mut fields = Fields::of_cells(file, map.counts[0] * map.counts[1]);
    fields.scalar("depth", map.depth)?;
    fields.scalar("solid", map.solid)?;
    fields.scalar("ground", map.ground)?;
    fields.scalar("travel", map.travel)?;
    let inside: Vec<u32> = map.inside.iter().map(|i| u32::from(*i)).collect();
    fields.ids("deposit", &inside)?;
    let extent = format!("0 {} 0 {} 0 0", map.counts[0], map.counts[1]);
    let [x, y, z] = map.low;
    let image = [
        ("WholeExtent", extent.clone()),
        ("Origin", format!("{x} {y} {z}")),
        ("Spacing", format!("{0} {0} {0}", map.cell)),
    ];
    vtk::write_with(file, ("ImageData", &image), &[("Extent", extent)], &[fields.finish()])
}

/// Writes a picture, north up: shaded ground, depth coloured up to `most` [m].
///
/// # Errors
/// I/O errors.
pub fn write_png(file: &Path, map: &DepthMap<'_>, most: f64) -> Result<(), WriteError> {
    let [nx, ny] = map.counts;
    let scale = PIXELS.div_ceil(nx.min(ny).max(1)).clamp(1, LARGEST);
    let (width, height) = (nx * scale, ny * scale);
    let mut pixels = Vec::with_capacity(3 * width * height);
    for row in 0..height {
        let j = ny - 1 - row / scale;
        for column in 0..width {
            let i = column / scale;
            let k = j * nx + i;
            let light = shade(map, i, j);
            let colour = if map.inside[k] { ramp(map.depth[k] / most) } else { [190.0; 3] };
            pixels.extend(colour.map(|c| (c * light).clamp(0.0, 255.0) as u8));
        }
    }
    atomic::write(file, |out| {
        let mut encoder = png::Encoder::new(out, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(|e| WriteError::format(file, e))?;
        writer.write_image_data(&pixels).map_err(|e| WriteError::format(file, e))?;
        writer.finish().map_err(|e| WriteError::format(file, e))
    })
}

fn shade(map: &DepthMap<'_>, i: usize, j: usize) -> f64 {
    let [nx, ny] = map.counts;
    let at = |i: usize, j: usize| map.ground[j * nx + i];
    let slope = |low: f64, high: f64, cells: usize| (high - low) / (cells.max(1) as f64 * map.cell);
    let (left, right) = (i.saturating_sub(1), (i + 1).min(nx - 1));
    let (below, above) = (j.saturating_sub(1), (j + 1).min(ny - 1));
    let dx = slope(at(left, j), at(right, j), right - left);
    let dy = slope(at(i, below), at(i, above), above - below);
    let sun = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
    let facing = (-dx * sun[0] - dy * sun[1] + sun[2]) / (dx * dx + dy * dy + 1.0).sqrt();
    0.35 + 0.65 * facing.clamp(0.0, 1.0)
}

fn ramp(share: f64) -> [f64; 3] {
    let at = share.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let below = (at as usize).min(RAMP.len() - 2);
    let part = at - below as f64;
    [0, 1, 2].map(|c| RAMP[below][c] + (RAMP[below + 1][c] - RAMP[below][c]) * part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample::folder;

    #[test]
    fn a_map_of_six_cells() {
        let dir = folder("depth_map");
        let depth = [0.0, 2.0, 0.0, 0.0, 0.0, 1.0];
        let map = DepthMap {
            low: [10.0, 20.0, 3.0],
            cell: 5.0,
            counts: [3, 2],
            ground: &[3.0; 6],
            depth: &depth,
            solid: &depth,
            travel: &[0.0; 6],
            inside: &depth.map(|d| d > 0.0),
        };
        write_vti(&dir.join("a.vti"), &map).unwrap();
        let text = std::fs::read_to_string(dir.join("a.vti")).unwrap();
        for part in
            ["WholeExtent=\"0 3 0 2 0 0\"", "Origin=\"10 20 3\"", "Spacing=\"5 5 5\"", "Name=\"depth\""]
        {
            assert!(text.contains(part), "{part}");
        }
        write_png(&dir.join("a.png"), &map, 2.0).unwrap();
        let decoder =
            png::Decoder::new(std::io::BufReader::new(std::fs::File::open(dir.join("a.png")).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let at = |column: usize, row: usize| [0, 1, 2].map(|c| pixels[3 * (row * 3 * LARGEST + column) + c]);
        let light = 0.35 + 0.65 * std::f64::consts::FRAC_1_SQRT_2;
        let lit = |colour: [f64; 3]| colour.map(|c| (c * light) as u8);
        assert_eq!(at(0, 0), lit([190.0; 3]));
        assert_eq!(at(2 * LARGEST, 0), lit(RAMP[2]));
        assert_eq!(at(LARGEST, LARGEST), lit(RAMP[4]));
    }
}
