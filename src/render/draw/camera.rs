//! From the world to the picture: a direction of sight, parallel or perspective.
//!
//! Seen from the eye, x points right, y up and z away from it [m]. A pixel has its centre at half numbers; y of the picture
//! points down.

use nalgebra::Vector3;

/// A place or direction, in single precision: places are relative to the middle of the scene.
pub type V3 = Vector3<f32>;

/// Field of view of a perspective picture over its height [rad]: 35°, that of the viewer.
const FIELD: f32 = 0.610_865_24;

/// Room around what is shown [pixels].
#[derive(Clone, Copy, Debug, Default)]
pub struct Room {
    /// At the left edge.
    pub left: f32,
    /// At the right edge: legends.
    pub right: f32,
    /// At the upper edge: the caption.
    pub top: f32,
    /// At the lower edge.
    pub bottom: f32,
}

/// An eye.
#[derive(Clone, Debug)]
pub struct Camera {
    eye: V3,
    /// Right, up, away from the eye.
    pub axes: [V3; 3],
    /// Whether what is far is small.
    pub perspective: bool,
    /// Pixels per metre; in perspective, per metre at one metre from the eye.
    pub focal: f32,
    /// Pixel that the axis of sight goes through.
    pub centre: [f32; 2],
    /// Distance of the middle of what is shown from the eye [m].
    pub distance: f32,
}

impl Camera {
    /// An eye that looks along `-towards` (which points from the scene to the eye) and shows all `corners`.
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
        // The box as it is seen with one pixel per metre decides scale and place.
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

    /// A place as the eye sees it.
    pub fn view(&self, place: &V3) -> V3 {
        let from = place - self.eye;
        V3::new(self.axes[0].dot(&from), self.axes[1].dot(&from), self.axes[2].dot(&from))
    }

    /// A direction as the eye sees it.
    pub fn turn(&self, direction: &V3) -> V3 {
        V3::new(self.axes[0].dot(direction), self.axes[1].dot(direction), self.axes[2].dot(direction))
    }

    /// The pixel of a place seen from the eye; it lies before it.
    pub fn project(&self, seen: &V3) -> [f32; 2] {
        let scale = if self.perspective { self.focal / seen.z } else { self.focal };
        [self.centre[0] + scale * seen.x, self.centre[1] - scale * seen.y]
    }

    /// Pixels that a metre takes at a depth.
    pub fn scale(&self, depth: f32) -> f32 {
        if self.perspective { self.focal / depth } else { self.focal }
    }

    /// Smallest depth that is drawn [m].
    pub fn near(&self) -> f32 {
        1e-3 * self.distance
    }

    /// The same eye for a picture with `samples` times as many pixels along each side.
    pub fn finer(&self, samples: usize) -> Camera {
        let n = samples as f32;
        Camera { focal: n * self.focal, centre: self.centre.map(|c| n * c), ..self.clone() }
    }

    /// Slopes of the ray through a pixel in perspective, its place [m] else.
    pub fn slopes(&self, x: f32, y: f32) -> [f32; 2] {
        [(x - self.centre[0]) / self.focal, (self.centre[1] - y) / self.focal]
    }

    /// The place at a depth on the ray through a pixel, seen from the eye.
    pub fn at(&self, x: f32, y: f32, depth: f32) -> V3 {
        let [sx, sy] = self.slopes(x, y);
        if self.perspective { V3::new(sx * depth, sy * depth, depth) } else { V3::new(sx, sy, depth) }
    }

    /// Direction of the ray through a place that is seen, away from the eye, of length one.
    pub fn ray(&self, seen: &V3) -> V3 {
        if self.perspective { seen.normalize() } else { V3::z() }
    }
}
