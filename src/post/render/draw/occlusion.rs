//! Ambient occlusion from picture depths.
//!
//! Source: McGuire, Mara and Luebke, Scalable ambient obscurance, High Performance Graphics 2012, eq. 10.

use rayon::prelude::*;

use super::camera::{Camera, V3};

const TAPS: usize = 14;
/// Turns of the spiral, coprime to the taps.
const TURNS: f32 = 5.0;
const PATTERN: usize = 4;
const STRENGTH: f32 = 1.15;
/// Depth bias over the range, against self-occlusion.
const BIAS: f32 = 0.02;
/// Least and largest tap distance [pixels].
const REACH: [f32; 2] = [2.0, 72.0];

/// Depth (infinite for the background) and normal by pixel.
pub struct Surfaces {
    pub width: usize,
    /// Depth [m].
    pub depth: Vec<f32>,
    pub normal: Vec<V3>,
}

pub struct Light {
    width: usize,
    depth: Vec<f32>,
    share: Vec<f32>,
    reach: f32,
}

impl Light {
    /// `reach`: occlusion range [m].
    pub fn of(surfaces: Surfaces, eye: &Camera, reach: f32) -> Light {
        let Surfaces { width, depth, normal } = surfaces;
        let spiral: Vec<[f32; 2]> = (0..TAPS * PATTERN * PATTERN)
            .map(|k| {
                let (tap, cell) = (k % TAPS, k / TAPS);
                let share = (tap as f32 + 0.5) / TAPS as f32;
                // 7 is coprime to 16, so neighbours differ much.
                let turn = ((cell * 7) % (PATTERN * PATTERN)) as f32 / (PATTERN * PATTERN) as f32;
                let angle = std::f32::consts::TAU * (share * TURNS + turn);
                [share * libm::cosf(angle), share * libm::sinf(angle)]
            })
            .collect();
        let mut share = vec![1.0_f32; depth.len()];
        share.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, out) in row.iter_mut().enumerate() {
                let z = depth[y * width + x];
                if z.is_finite() {
                    let cell = (y % PATTERN) * PATTERN + x % PATTERN;
                    let taps = &spiral[cell * TAPS..(cell + 1) * TAPS];
                    *out = open(&depth, width, eye, [x, y], &normal[y * width + x], reach, taps);
                }
            }
        });
        Light { width, depth, share, reach }
    }

    /// Mean over neighbouring pixels of similar depth.
    pub fn at(&self, x: usize, y: usize, depth: f32) -> f32 {
        let height = self.depth.len() / self.width;
        let (mut sum, mut count) = (0.0, 0.0);
        for j in (y + 2).saturating_sub(PATTERN)..(y + 2).min(height) {
            let row = j * self.width;
            for i in (x + 2).saturating_sub(PATTERN)..(x + 2).min(self.width) {
                if (self.depth[row + i] - depth).abs() < 0.35 * self.reach {
                    sum += self.share[row + i];
                    count += 1.0;
                }
            }
        }
        if count > 0.0 { sum / count } else { 1.0 }
    }
}

fn open(
    depth: &[f32],
    width: usize,
    eye: &Camera,
    [x, y]: [usize; 2],
    n: &V3,
    reach: f32,
    taps: &[[f32; 2]],
) -> f32 {
    let height = depth.len() / width;
    let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
    let z = depth[y * width + x];
    let place = eye.at(px, py, z);
    let pixels = (reach * eye.scale(z)).clamp(REACH[0], REACH[1]);
    // Range limited by the largest tap distance.
    let reach = pixels / eye.scale(z);
    let over = 1.0 / reach;
    let mut sum = 0.0;
    for [dx, dy] in taps {
        let (i, j) = ((px + dx * pixels).floor(), (py + dy * pixels).floor());
        if i < 0.0 || j < 0.0 || i >= width as f32 || j >= height as f32 {
            continue;
        }
        let there = depth[j as usize * width + i as usize];
        if !there.is_finite() {
            continue;
        }
        let v = (eye.at(i + 0.5, j + 0.5, there) - place) * over;
        let vv = v.norm_squared();
        let near = (1.0 - vv).max(0.0);
        sum += near * near * near * ((v.dot(n) - BIAS) / (vv + 0.01)).max(0.0);
    }
    (1.0 - STRENGTH * 2.0 * sum / TAPS as f32).clamp(0.0, 1.0)
}
