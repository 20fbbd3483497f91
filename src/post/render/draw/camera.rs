//! Camera, parallel or perspective.
//!
//! In camera coordinates x points right, y up and z away from the eye [m]. Pixel centres lie at half
//! integers.

use nalgebra::Vector3;

/// Single precision suffices relative to the scene centre.
pub type V3 = Vector3<f32>;

/// Vertical field of view in perspective [rad]: 35°, as in the viewer.
const FIELD: f32 = 0.610_865_24;

#[derive(Clone, Copy, Debug, Default)]
pub struct Room {
    pub left: f32,
    pub right: f32,
    pub top: f32,
    pub bottom: f32,
}

#[derive(Clone, Debug)]
pub struct Camera {
    eye: V3,
    /// Right, up, away from the eye.
    pub axes: [V3; 3],
    pub perspective: bool,
    /// Pixels per metre; in perspective, at one metre from the eye.
    pub focal: f32,
    /// Pixel of the optical axis.
    pub centre: [f32; 2],
    /// Distance of the scene centre from the eye [m].
    pub distance: f32,
}

impl Camera {
    /// Camera in direction `towards` that shows all `corners`.
    pub fn showing(
        corners: &[V3],
        towards: V3,
        perspective: bool,
        size: [usize; 2],
        room: Room,
        zoom: f32,
    ) -> Camera {
        let away = -towards.normalize();
        let up = if away.z.abs() > 0.999 { V3::y() } else { V3::z() };
        let right = away.cross(&up).normalize();
        let up = right.cross(&away);
        let [low, high] = corners
            .iter()
            .fold([V3::repeat(f32::INFINITY), V3::repeat(-f32::INFINITY)], |b, c| [b[0].inf(c), b[1].sup(c)]);
        let middle = 0.5 * (low + high);
        let radius = (0.5 * (high - low).norm()).max(1e-9);
        let free = [
            (size[0] as f32 - room.left - room.right).max(1.0),
            (size[1] as f32 - room.top - room.bottom).max(1.0),
        ];
        let half = libm::tanf(0.5 * FIELD);
        let distance = match perspective {
            true => {
                let across = |c: &V3| {
                    let c = c - middle;
                    let size = (c.dot(&right).abs() * free[1] / free[0]).max(c.dot(&up).abs());
                    size / half - c.dot(&away)
                };
                corners.iter().map(across).fold(1.05 * radius, f32::max)
            }
            false => 2.0 * radius,
        };
        let eye = middle - away * distance;
        let mut camera =
            Camera { eye, axes: [right, up, away], perspective, focal: 1.0, centre: [0.0; 2], distance };
        let seen: Vec<[f32; 2]> = corners.iter().map(|c| camera.project(&camera.view(c))).collect();
        let ends = |k: usize| {
            let of = |start: f32, f: fn(f32, f32) -> f32| seen.iter().map(|p| p[k]).fold(start, f);
            [of(f32::INFINITY, f32::min), of(f32::NEG_INFINITY, f32::max)]
        };
        let (x, y) = (ends(0), ends(1));
        let fit = (free[0] / (x[1] - x[0]).max(1e-9)).min(free[1] / (y[1] - y[0]).max(1e-9));
        camera.focal = fit * zoom;
        let place = |before: f32, free: f32, ends: [f32; 2]| {
            before + 0.5 * free - 0.5 * camera.focal * (ends[0] + ends[1])
        };
        camera.centre = [place(room.left, free[0], x), place(room.top, free[1], y)];
        camera
    }

    pub fn view(&self, place: &V3) -> V3 {
        let from = place - self.eye;
        V3::new(self.axes[0].dot(&from), self.axes[1].dot(&from), self.axes[2].dot(&from))
    }

    pub fn turn(&self, direction: &V3) -> V3 {
        V3::new(self.axes[0].dot(direction), self.axes[1].dot(direction), self.axes[2].dot(direction))
    }

    pub fn project(&self, seen: &V3) -> [f32; 2] {
        let scale = if self.perspective { self.focal / seen.z } else { self.focal };
        [self.centre[0] + scale * seen.x, self.centre[1] - scale * seen.y]
    }

    /// Pixels per metre at a depth.
    pub fn scale(&self, depth: f32) -> f32 {
        if self.perspective { self.focal / depth } else { self.focal }
    }

    pub fn near(&self) -> f32 {
        1e-3 * self.distance
    }

    /// Camera for `samples` times as many pixels per side.
    pub fn finer(&self, samples: usize) -> Camera {
        let n = samples as f32;
        Camera { focal: n * self.focal, centre: self.centre.map(|c| n * c), ..self.clone() }
    }

    /// Slopes of a pixel's ray in perspective, else its position [m].
    pub fn slopes(&self, x: f32, y: f32) -> [f32; 2] {
        [(x - self.centre[0]) / self.focal, (self.centre[1] - y) / self.focal]
    }

    /// Position at a depth on a pixel's ray, in camera coordinates.
    pub fn at(&self, x: f32, y: f32, depth: f32) -> V3 {
        let [sx, sy] = self.slopes(x, y);
        if self.perspective { V3::new(sx * depth, sy * depth, depth) } else { V3::new(sx, sy, depth) }
    }

    /// Unit ray direction through a position, away from the eye.
    pub fn ray(&self, seen: &V3) -> V3 {
        if self.perspective { seen.normalize() } else { V3::z() }
    }
}
