//! Finds the visible object and depth of each sample of a tile.
//!
//! Spheres and tubes are intersected with each ray, exact at any size.

use super::bins::{Bins, Id, Kind, thing};
use super::camera::{Camera, V3};
use super::scene::{Scene, Sphere, Triangle, Tube};

/// Objects between updates of the farthest depth.
const LOOK: usize = 12;

pub struct Tile<'a> {
    pub origin: [usize; 2],
    pub side: usize,
    /// Depth [m], infinite for the background.
    pub depth: &'a mut [f32],
    pub id: &'a mut [Id],
}

impl Tile<'_> {
    pub fn draw(&mut self, scene: &Scene, fine: &Camera, bins: &Bins, tile: usize) {
        let mut farthest = f32::INFINITY;
        for (k, item) in bins.of(tile).enumerate() {
            if k % LOOK == LOOK - 1 {
                farthest = self.depth.iter().fold(0.0, |m, d| if *d > m { *d } else { m });
            }
            // Objects are sorted by depth.
            if item.near >= farthest {
                return;
            }
            let rect = [0, 1].map(|a| {
                let o = self.origin[a] as i32;
                [
                    (item.rect[a] - o).max(0) as usize,
                    (item.rect[a + 2] - o).min(self.side as i32 - 1) as usize,
                ]
            });
            let (kind, k) = thing(item.id);
            match kind {
                Kind::Sphere if fine.perspective => self.sphere(fine, &scene.spheres[k], item.id, rect),
                Kind::Sphere => self.ball(fine, &scene.spheres[k], item.id, rect),
                Kind::Triangle => self.triangle(fine, &scene.triangles[k], item.id, rect),
                Kind::Tube => self.tube(fine, &scene.tubes[k], item.id, rect),
            }
        }
    }

    fn middle(&self, x: usize, y: usize) -> [f32; 2] {
        [(self.origin[0] + x) as f32 + 0.5, (self.origin[1] + y) as f32 + 0.5]
    }

    fn columns(&self, low: f32, high: f32, within: [usize; 2]) -> std::ops::Range<usize> {
        let o = self.origin[0] as f32 + 0.5;
        let first = (low - o).ceil().max(within[0] as f32) as usize;
        let end = (high - o).floor() + 1.0;
        first..(end.max(0.0) as usize).min(within[1] + 1).max(first)
    }

    fn ball(&mut self, fine: &Camera, s: &Sphere, id: Id, [xs, ys]: [[usize; 2]; 2]) {
        let (c, rr) = (s.centre, s.radius * s.radius);
        for y in ys[0]..=ys[1] {
            let [_, sy] = fine.slopes(0.0, self.middle(0, y)[1]);
            let left = rr - (sy - c.y) * (sy - c.y);
            if left <= 0.0 {
                continue;
            }
            let half = left.sqrt();
            let at = |s: f32| fine.centre[0] + fine.focal * s;
            let span = self.columns(at(c.x - half), at(c.x + half), xs);
            let row = y * self.side;
            let x0 = self.middle(span.start, y)[0];
            let (depth, ids) = (&mut self.depth[row..], &mut self.id[row..]);
            for (k, x) in span.enumerate() {
                let dx = (x0 + k as f32 - fine.centre[0]) / fine.focal - c.x;
                let z = c.z - (left - dx * dx).max(0.0).sqrt();
                if z < depth[x] {
                    (depth[x], ids[x]) = (z, id);
                }
            }
        }
    }

    fn sphere(&mut self, fine: &Camera, s: &Sphere, id: Id, [xs, ys]: [[usize; 2]; 2]) {
        let (c, r) = (s.centre, s.radius);
        let rr = r * r;
        for y in ys[0]..=ys[1] {
            let [_, sy] = fine.slopes(0.0, self.middle(0, y)[1]);
            let Some([low, high]) = chord(&c, r, sy) else { continue };
            let at = |s: f32| fine.centre[0] + fine.focal * s;
            let span = self.columns(at(low), at(high), xs);
            let row = y * self.side;
            let x0 = self.middle(span.start, y)[0];
            let (depth, ids) = (&mut self.depth[row..], &mut self.id[row..]);
            let (m, e) = (c.y * sy + c.z, sy * sy + 1.0);
            let step = 1.0 / fine.focal;
            for (k, x) in span.enumerate() {
                let sx = (x0 + k as f32 - fine.centre[0]) * step;
                let over = 1.0 / (sx * sx + e);
                let t = (c.x * sx + m) * over;
                // Relative to the foot point on the ray: avoids cancellation of large squares.
                let (ox, oy, oz) = (sx * t - c.x, sy * t - c.y, t - c.z);
                let rest = rr - (ox * ox + oy * oy + oz * oz);
                let z = t - (rest.max(0.0) * over).sqrt();
                if z < depth[x] {
                    (depth[x], ids[x]) = (z, id);
                }
            }
        }
    }

    fn triangle(&mut self, fine: &Camera, t: &Triangle, id: Id, [xs, ys]: [[usize; 2]; 2]) {
        let p = t.corners.map(|c| fine.project(&c).map(f64::from));
        let area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        if area.abs() < 1e-12 {
            return;
        }
        let plane = Plane::of(fine, t);
        for y in ys[0]..=ys[1] {
            let sy = f64::from(self.middle(0, y)[1]);
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            for k in 0..3 {
                let (a, b) = (p[k], p[(k + 1) % 3]);
                // Inside if slope · x + rest ≥ 0.
                let slope = -(b[1] - a[1]) * area.signum();
                let rest = ((b[0] - a[0]) * (sy - a[1]) + (b[1] - a[1]) * a[0]) * area.signum();
                match slope {
                    s if s > 0.0 => low = low.max(-rest / s),
                    s if s < 0.0 => high = high.min(-rest / s),
                    _ if rest < 0.0 => low = f64::INFINITY,
                    _ => {}
                }
            }
            if low > high {
                continue;
            }
            // Shared edge samples leave no gaps by rounding.
            let span = self.columns((low - 1e-3) as f32, (high + 1e-3) as f32, xs);
            let row = y * self.side;
            for x in span {
                let z = plane.depth(fine, self.middle(x, y));
                if z < self.depth[row + x] {
                    (self.depth[row + x], self.id[row + x]) = (z, id);
                }
            }
        }
    }

    fn tube(&mut self, fine: &Camera, t: &Tube, id: Id, [xs, ys]: [[usize; 2]; 2]) {
        for y in ys[0]..=ys[1] {
            for x in xs[0]..=xs[1] {
                let [px, py] = self.middle(x, y);
                let at = y * self.side + x;
                if let Some(z) = tube(fine, t, px, py).filter(|z| *z < self.depth[at]) {
                    (self.depth[at], self.id[at]) = (z, id);
                }
            }
        }
    }
}

fn chord(c: &V3, r: f32, sy: f32) -> Option<[f32; 2]> {
    let [cx, cy, cz, sy, r] = [c.x, c.y, c.z, sy, r].map(f64::from);
    let rest = cy * cy + cz * cz - r * r;
    let (k, m) = (cx * cx + rest, cy * sy + cz);
    let root = cx * cx * m * m + rest * (m * m - k * (sy * sy + 1.0));
    if root <= 0.0 || rest <= 0.0 {
        return None;
    }
    let root = root.sqrt();
    Some([((cx * m - root) / rest) as f32, ((cx * m + root) / rest) as f32])
}

/// Triangle depth: linear in parallel projection, reciprocal in perspective.
struct Plane {
    by: [f64; 3],
    ends: [f32; 2],
}

impl Plane {
    fn of(fine: &Camera, t: &Triangle) -> Plane {
        let [a, b, c] = t.corners.map(|c| c.cast::<f64>());
        let n = (b - a).cross(&(c - a));
        let h = n.dot(&a);
        let focal = f64::from(fine.focal);
        let by = match fine.perspective {
            true => [n.x / h, n.y / h, n.z / h],
            false => [-n.x / n.z, -n.y / n.z, h / n.z],
        };
        let [ox, oy] = fine.centre.map(f64::from);
        let by = [by[0] / focal, -by[1] / focal, by[2] - by[0] * ox / focal + by[1] * oy / focal];
        let z = t.corners.map(|c| c.z);
        Plane { by, ends: [z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2])] }
    }

    fn depth(&self, fine: &Camera, [x, y]: [f32; 2]) -> f32 {
        let v = self.by[0] * f64::from(x) + self.by[1] * f64::from(y) + self.by[2];
        let z = if fine.perspective { 1.0 / v } else { v };
        // Depth is undefined for a triangle seen edge-on.
        (z as f32).clamp(self.ends[0], self.ends[1])
    }
}

fn tube(fine: &Camera, t: &Tube, px: f32, py: f32) -> Option<f32> {
    let middle = 0.5 * (t.ends[0] + t.ends[1]);
    // From a nearby point: avoids cancellation of large squares.
    let from = fine.at(px, py, middle.z);
    let along = fine.ray(&from);
    let shift = from - along * ((from - middle).dot(&along));
    let axis = t.ends[1] - t.ends[0];
    let o = shift - t.ends[0];
    let (baba, bard, baoa) = (axis.dot(&axis), axis.dot(&along), axis.dot(&o));
    let (rdoa, oaoa, rr) = (along.dot(&o), o.dot(&o), t.radius * t.radius);
    let a = baba - bard * bard;
    let b = baba * rdoa - baoa * bard;
    let c = baba * oaoa - baoa * baoa - rr * baba;
    let h = b * b - a * c;
    if h < 0.0 {
        return None;
    }
    let mut best = None;
    if a > 1e-6 * baba {
        let t0 = (-b - h.sqrt()) / a;
        let y = baoa + t0 * bard;
        if y > 0.0 && y < baba {
            best = Some(t0);
        }
    }
    let found = best.or_else(|| {
        let y = baoa + (-b - h.sqrt()) / a.max(1e-30) * bard;
        let end = if y <= 0.0 { 0.0 } else { baba };
        let t = (end - baoa) / bard;
        (bard.abs() > 1e-12 && (b + a * t).abs() <= h.sqrt()).then_some(t)
    })?;
    Some((shift + along * found).z)
}
