//! What is drawn, in the world [m], and as the eye sees it.

use rayon::prelude::*;

use super::camera::{Camera, V3};

/// A colour: red, green, blue from 0 to 1, as a screen takes them.
pub type Colour = [f32; 3];

/// Colours from values.
#[derive(Clone, Debug)]
pub enum Paint {
    /// The colour of each sphere or tube; of triangles this one.
    Own(Colour),
    /// A value over a range; `bands` above 0 has so many steps.
    Map {
        /// 256 colours from the lowest value to the highest.
        table: Vec<Colour>,
        /// Values of the first colour and of the last.
        range: [f32; 2],
        /// Number of steps.
        bands: usize,
    },
}

impl Paint {
    /// The colour of a value.
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

/// How a group of things looks.
#[derive(Clone, Debug)]
pub struct Look {
    /// Its colours.
    pub paint: Paint,
    /// 1 hides what is behind; below, the nearest surface of the group alone is seen, as glass.
    pub opacity: f32,
    /// Share of light and shade: less for contours, whose colours must be found in the legend again.
    pub relief: f32,
}

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre.
    pub centre: V3,
    /// Radius [m].
    pub radius: f32,
    /// Colour.
    pub colour: Colour,
    /// Its look.
    pub look: u16,
    /// What it belongs to: outlines are between bodies.
    pub body: u32,
}

/// A triangle, seen from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Corners.
    pub corners: [V3; 3],
    /// Values at the corners.
    pub values: [f32; 3],
    /// Its look.
    pub look: u16,
    /// As of [`Sphere`].
    pub body: u32,
}

/// A cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Tube {
    /// Ends of its axis.
    pub ends: [V3; 2],
    /// Radius [m].
    pub radius: f32,
    /// Colour.
    pub colour: Colour,
    /// Its look.
    pub look: u16,
}

/// A line of even width on the triangles of a look.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Ends.
    pub ends: [V3; 2],
    /// Look of the surface that it lies on.
    pub look: u16,
}

/// Everything.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Looks, by number.
    pub looks: Vec<Look>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
    /// Triangles.
    pub triangles: Vec<Triangle>,
    /// Tubes.
    pub tubes: Vec<Tube>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Size of what is small and of interest, such as a stone [m]: how far corners are darkened.
    pub grain: f32,
}

impl Scene {
    /// Adds a look; its number.
    pub fn look(&mut self, look: Look) -> u16 {
        self.looks.push(look);
        (self.looks.len() - 1) as u16
    }

    /// The same as the eye sees it: what lies before the near plane is cut off.
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
    /// What is left of it where `side` is not negative, which is linear in the place.
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
    /// What is left of it where `side` is not negative, which is linear in the place.
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
