//! Objects to draw, in world [m] or camera coordinates.

use rayon::prelude::*;

use super::camera::{Camera, V3};

/// sRGB, 0 to 1.
pub type Colour = [f32; 3];

#[derive(Clone, Debug)]
pub enum Paint {
    /// Individual colour of spheres and tubes; this colour for triangles.
    Own(Colour),
    /// Value over a range, in `bands` steps unless 0.
    Map { table: Vec<Colour>, range: [f32; 2], bands: usize },
}

impl Paint {
    pub fn of(&self, value: f32) -> Colour {
        match self {
            Paint::Own(colour) => *colour,
            Paint::Map { table, range, bands } => {
                let mut t = ((value - range[0]) / (range[1] - range[0]).max(1e-30)).clamp(0.0, 1.0);
                if *bands > 0 {
                    let n = *bands as f32;
                    t = ((t.min(0.999_99) * n).floor() + 0.5) / n;
                }
                table[(t * 255.0 + 0.5) as usize]
            }
        }
    }
}

#[derive(Clone, Debug)]
pub struct Look {
    pub paint: Paint,
    /// 1 is opaque; below, only the nearest surface of the group is visible.
    pub opacity: f32,
    /// Shading strength; low for contours, which must match their legend.
    pub relief: f32,
}

#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub centre: V3,
    /// Radius [m].
    pub radius: f32,
    pub colour: Colour,
    pub look: u16,
    /// Outlines separate bodies.
    pub body: u32,
}

#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [V3; 3],
    pub values: [f32; 3],
    pub look: u16,
    pub body: u32,
}

#[derive(Clone, Copy, Debug)]
pub struct Tube {
    pub ends: [V3; 2],
    /// Radius [m].
    pub radius: f32,
    pub colour: Colour,
    pub look: u16,
}

/// Line of constant width on triangles of a look.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub ends: [V3; 2],
    pub look: u16,
}

#[derive(Clone, Debug, Default)]
pub struct Scene {
    pub looks: Vec<Look>,
    pub spheres: Vec<Sphere>,
    pub triangles: Vec<Triangle>,
    pub tubes: Vec<Tube>,
    pub lines: Vec<Line>,
    /// Grain size [m], the scale of ambient occlusion.
    pub grain: f32,
}

impl Scene {
    /// Adds a look; returns its index.
    pub fn look(&mut self, look: Look) -> u16 {
        self.looks.push(look);
        (self.looks.len() - 1) as u16
    }

    /// Scene in camera coordinates, clipped at the near plane.
    pub fn seen(&self, camera: &Camera) -> Scene {
        let near = camera.near();
        let spheres = self.spheres.par_iter().map(|s| Sphere { centre: camera.view(&s.centre), ..*s });
        let tubes = self.tubes.par_iter().map(|t| Tube { ends: t.ends.map(|e| camera.view(&e)), ..*t });
        let lines = self
            .lines
            .par_iter()
            .filter_map(|l| Line { ends: l.ends.map(|e| camera.view(&e)), ..*l }.cut(|x| x.z - near));
        let mut triangles = Vec::with_capacity(self.triangles.len());
        for t in &self.triangles {
            let corners = t.corners.map(|c| camera.view(&c));
            if corners.iter().all(|c| c.z >= near) {
                triangles.push(Triangle { corners, ..*t });
            } else {
                let seen = Triangle { corners, ..*t };
                triangles.extend(seen.cut(|c| c.z - near));
            }
        }
        Scene {
            looks: self.looks.clone(),
            spheres: spheres.filter(|s| s.centre.z - s.radius > near).collect(),
            triangles,
            tubes: tubes.filter(|t| t.ends.iter().all(|e| e.z - t.radius > near)).collect(),
            lines: lines.collect(),
            grain: self.grain,
        }
    }
}

impl Line {
    /// Clips to `side` ≥ 0, which is linear.
    pub fn cut(&self, side: impl Fn(&V3) -> f32) -> Option<Line> {
        let [a, b] = self.ends;
        let (da, db) = (side(&a), side(&b));
        let between = || a + (b - a) * (da / (da - db));
        let ends = match (da >= 0.0, db >= 0.0) {
            (true, true) => [a, b],
            (true, false) => [a, between()],
            (false, true) => [between(), b],
            (false, false) => return None,
        };
        Some(Line { ends, ..*self })
    }
}

impl Triangle {
    pub fn cut(&self, side: impl Fn(&V3) -> f32) -> Vec<Triangle> {
        let mut left: Vec<(V3, f32)> = Vec::with_capacity(4);
        for k in 0..3 {
            let (a, b) = (k, (k + 1) % 3);
            let (pa, pb) = (self.corners[a], self.corners[b]);
            let (da, db) = (side(&pa), side(&pb));
            if da >= 0.0 {
                left.push((pa, self.values[a]));
            }
            if (da >= 0.0) != (db >= 0.0) {
                let t = da / (da - db);
                left.push((pa + (pb - pa) * t, self.values[a] + (self.values[b] - self.values[a]) * t));
            }
        }
        let fan = |k: usize| {
            let corners = [left[0], left[k], left[k + 1]];
            Triangle { corners: corners.map(|c| c.0), values: corners.map(|c| c.1), ..*self }
        };
        (1..left.len().saturating_sub(1)).map(fan).collect()
    }
}
