//! Lines of constant width on surfaces, such as element edges.

use super::camera::Camera;
use super::scene::{Line, Scene};

const HALF: f32 = 0.5;
/// Depth tolerance of the surface in front of a line [pixels].
const BEFORE: f32 = 2.5;

pub struct Lines {
    tiles: Vec<Vec<u32>>,
}

impl Lines {
    pub fn new(scene: &Scene, fine: &Camera, tiles: [usize; 2], side: usize, samples: usize) -> Lines {
        let mut sorted = vec![Vec::new(); tiles[0] * tiles[1]];
        let half = HALF * samples as f32;
        for (k, line) in scene.lines.iter().enumerate() {
            let [a, b] = line.ends.map(|e| fine.project(&e));
            let range = |c: usize| {
                let low = ((a[c].min(b[c]) - half) / side as f32).floor().max(0.0) as usize;
                let high = ((a[c].max(b[c]) + half) / side as f32).floor();
                low..if high < 0.0 { low } else { (high as usize + 1).min(tiles[c]) }
            };
            for y in range(1) {
                for x in range(0) {
                    // A long line misses most tiles of its box.
                    let middle = [x, y].map(|v| (v as f32 + 0.5) * side as f32);
                    let (far, _) = beside(a, b, middle);
                    if far <= half + 0.71 * side as f32 {
                        sorted[y * tiles[0] + x].push(k as u32);
                    }
                }
            }
        }
        Lines { tiles: sorted }
    }

    /// Marks samples on a line, if its own surface or nothing is in front.
    pub fn mark(
        &self,
        scene: &Scene,
        fine: &Camera,
        tile: usize,
        samples: usize,
        [origin, size]: [[usize; 2]; 2],
        at: impl Fn(usize, usize) -> (f32, Option<usize>),
        ink: &mut [bool],
    ) {
        let half = HALF * samples as f32;
        for k in &self.tiles[tile] {
            let line = &scene.lines[*k as usize];
            let [a, b] = line.ends.map(|e| fine.project(&e));
            let range = |c: usize| {
                let o = origin[c] as f32;
                let low = (a[c].min(b[c]) - half - o).max(0.0) as usize;
                let high = (a[c].max(b[c]) + half - o + 1.0).max(0.0) as usize;
                low..high.min(size[c])
            };
            for y in range(1) {
                for x in range(0) {
                    let place = [(origin[0] + x) as f32 + 0.5, (origin[1] + y) as f32 + 0.5];
                    let (far, t) = beside(a, b, place);
                    let (depth, look) = at(x, y);
                    if far > half || !depth.is_finite() {
                        continue;
                    }
                    let z = depth_at(fine, line, t);
                    let own = look == Some(usize::from(line.look));
                    let slack = if own { BEFORE * samples as f32 / fine.scale(z) } else { 0.0 };
                    if z <= depth + slack {
                        ink[y * size[0] + x] = true;
                    }
                }
            }
        }
    }
}

fn beside(a: [f32; 2], b: [f32; 2], p: [f32; 2]) -> (f32, f32) {
    let d = [b[0] - a[0], b[1] - a[1]];
    let v = [p[0] - a[0], p[1] - a[1]];
    let t = ((v[0] * d[0] + v[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]).max(1e-20)).clamp(0.0, 1.0);
    let (x, y) = (v[0] - t * d[0], v[1] - t * d[1]);
    ((x * x + y * y).sqrt(), t)
}

fn depth_at(fine: &Camera, line: &Line, t: f32) -> f32 {
    let [a, b] = line.ends.map(|e| e.z);
    if fine.perspective { 1.0 / ((1.0 - t) / a + t / b) } else { a + t * (b - a) }
}
