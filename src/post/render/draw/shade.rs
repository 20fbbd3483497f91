//! Shading.

use super::camera::{Camera, V3};
use super::scene::Colour;
use super::surface::Surface;

/// Lights in camera coordinates.
pub struct Lamps {
    key: V3,
    fill: V3,
    up: V3,
}

impl Lamps {
    /// Key light over the left shoulder, weak fill light at the right, ambient light stronger from above.
    pub fn new(eye: &Camera) -> Lamps {
        Lamps {
            key: V3::new(-0.42, 0.66, -0.62).normalize(),
            fill: V3::new(0.75, 0.1, -0.65).normalize(),
            up: eye.turn(&V3::z()),
        }
    }

    /// Shaded colour. `open` is the ambient light fraction; `relief` 0 disables shading.
    pub fn lit(&self, eye: &Camera, surface: &Surface, open: f32, relief: f32) -> Colour {
        let n = &surface.normal;
        let around = 0.46 + 0.14 * n.dot(&self.up);
        let key = n.dot(&self.key).max(0.0);
        let fill = n.dot(&self.fill).max(0.0);
        let facing = -n.dot(&eye.ray(&surface.place));
        let rim = 0.78 + 0.22 * smooth(facing / 0.5);
        let light = (around * open + (0.62 * key + 0.12 * fill) * (0.45 + 0.55 * open)) * rim;
        let gloss = 0.10 * libm::powf((n.dot(&self.half(eye, surface))).max(0.0), 24.0) * open;
        surface.colour.map(|c| (c * (1.0 + relief * (light - 1.0)) + relief * gloss).clamp(0.0, 1.0))
    }

    fn half(&self, eye: &Camera, surface: &Surface) -> V3 {
        (self.key - eye.ray(&surface.place)).normalize()
    }
}

fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
