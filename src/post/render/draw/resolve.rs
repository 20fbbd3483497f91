//! Pixel colours from samples.

use super::bins::{self, Bins, Id, NONE};
use super::camera::Camera;
use super::lines::Lines;
use super::occlusion::Light;
use super::raster::Tile;
use super::scene::{Colour, Paint, Scene};
use super::shade::Lamps;
use super::surface::{self, surface};
use super::{Grid, TILE};

/// Colour factor next to an outline, by distance in samples.
const OUTLINE: [f32; 2] = [0.52, 0.76];
/// Depth step of an outline over the grain size.
const STEP: f32 = 0.06;
const INK: (Colour, f32) = ([0.08, 0.1, 0.14], 0.42);

pub struct Resolver<'a> {
    pub scene: &'a Scene,
    pub fine: &'a Camera,
    pub grid: &'a Grid,
    pub depth: &'a [f32],
    pub id: &'a [Id],
    pub light: &'a Light,
    pub lamps: &'a Lamps,
    pub lines: &'a Lines,
    pub glass: &'a [(usize, Bins)],
    pub background: Colour,
    /// Outline strength, lower for bodies of few pixels.
    pub outlines: f32,
}

struct Pane {
    opacity: f32,
    depth: Vec<f32>,
    id: Vec<Id>,
}

impl Resolver<'_> {
    pub fn tile(&self, tile: usize) -> Vec<u8> {
        let (n, side) = (self.grid.samples, self.grid.side);
        let area = side * side;
        let origin = self.grid.origin(tile);
        let own = tile * area..(tile + 1) * area;
        let (depth, id) = (&self.depth[own.clone()], &self.id[own]);
        let panes = self.panes(tile, origin, depth);
        let mut ink = vec![false; area];
        let nearest = |x: usize, y: usize| {
            let at = y * side + x;
            let pane = panes.iter().map(|p| (p.depth[at], p.id[at])).filter(|p| p.1 != NONE);
            let front = pane.chain([(depth[at], id[at])]).min_by(|a, b| a.0.total_cmp(&b.0));
            let (z, id) = front.unwrap_or((f32::INFINITY, NONE));
            (z, (id != NONE).then(|| bins::look(self.scene, id)))
        };
        self.lines.mark(self.scene, self.fine, tile, n, [origin, [side; 2]], nearest, &mut ink);
        let mut out = vec![0_u8; 3 * TILE * TILE];
        let [wide, high] = [0, 1].map(|k| TILE.min(self.grid.size[k] - origin[k] / n));
        let mut known: Vec<(Id, Colour)> = Vec::new();
        for py in 0..high {
            for px in 0..wide {
                known.clear();
                let mut sum = [0.0_f32; 3];
                for s in order(n) {
                    let (x, y) = (px * n + s % n, py * n + s / n);
                    let at = y * side + x;
                    let place = [origin[0] + x, origin[1] + y];
                    let mut colour = match id[at] {
                        NONE => self.background,
                        id => {
                            let c = self.colour(&mut known, id, place, depth[at]);
                            let left = self.outline(place, id, depth[at]);
                            c.map(|v| v * left)
                        }
                    };
                    colour = self.through(&panes, at, place, colour, &mut known);
                    if ink[at] {
                        colour = mix(colour, INK.0, INK.1);
                    }
                    (0..3).for_each(|k| sum[k] += colour[k]);
                }
                let at = 3 * (py * TILE + px);
                let share = 255.0 / (n * n) as f32;
                (0..3).for_each(|k| out[at + k] = (sum[k] * share + 0.5) as u8);
            }
        }
        out
    }

    /// Nearest surface of each transparent look in front of opaque ones.
    fn panes(&self, tile: usize, origin: [usize; 2], depth: &[f32]) -> Vec<Pane> {
        let of = |(look, bins): &(usize, Bins)| {
            let mut pane = Pane {
                opacity: self.scene.looks[*look].opacity,
                depth: depth.to_vec(),
                id: vec![NONE; depth.len()],
            };
            bins.of(tile).next()?;
            let (depth, id) = (&mut pane.depth, &mut pane.id);
            Tile { origin, side: self.grid.side, depth, id }.draw(self.scene, self.fine, bins, tile);
            Some(pane)
        };
        self.glass.iter().filter_map(of).collect()
    }

    /// Blends layers over a colour, farthest first.
    fn through(
        &self,
        panes: &[Pane],
        at: usize,
        place: [usize; 2],
        behind: Colour,
        known: &mut Vec<(Id, Colour)>,
    ) -> Colour {
        if panes.iter().all(|p| p.id[at] == NONE) {
            return behind;
        }
        let mut before: Vec<&Pane> = panes.iter().filter(|p| p.id[at] != NONE).collect();
        before.sort_by(|a, b| b.depth[at].total_cmp(&a.depth[at]));
        before.into_iter().fold(behind, |colour, pane| {
            let own = self.colour(known, pane.id[at], place, pane.depth[at]);
            mix(colour, own, pane.opacity)
        })
    }

    /// Object colour in a pixel, computed once except for banded contours.
    fn colour(&self, known: &mut Vec<(Id, Colour)>, id: Id, place: [usize; 2], depth: f32) -> Colour {
        if let Some((_, colour)) = known.iter().find(|k| k.0 == id) {
            return *colour;
        }
        let found = surface(self.scene, self.fine, id, place.map(|v| v as f32 + 0.5), depth);
        let look = &self.scene.looks[found.look];
        let [x, y] = place.map(|v| v / self.grid.samples);
        let open = self.light.at(x, y, depth);
        let colour = self.lamps.lit(self.fine, &found, open, look.relief);
        if !matches!(look.paint, Paint::Map { bands: 1.., .. }) {
            known.push((id, colour));
        }
        colour
    }

    /// Outline factor of a sample, cast by bodies in front.
    fn outline(&self, [x, y]: [usize; 2], id: Id, depth: f32) -> f32 {
        let own = surface::body(self.scene, id);
        let step = STEP * self.scene.grain;
        let size = self.grid.tiles.map(|t| t * self.grid.side);
        let other = |x: usize, y: usize| {
            let at = self.grid.place(x, y);
            let there = self.id[at];
            if there == id {
                return false;
            }
            // Bodies also end at the background.
            there == NONE || (self.depth[at] < depth - step && surface::body(self.scene, there) != own)
        };
        let reach = if self.grid.samples > 2 { 2 } else { 1 };
        for (k, left) in OUTLINE.iter().enumerate().take(reach) {
            let d = k + 1;
            let around = [(x.wrapping_sub(d), y), (x + d, y), (x, y.wrapping_sub(d)), (x, y + d)];
            if around.into_iter().any(|(x, y)| x < size[0] && y < size[1] && other(x, y)) {
                return 1.0 - self.outlines * (1.0 - left);
            }
        }
        1.0
    }
}

fn order(n: usize) -> impl Iterator<Item = usize> {
    let middle = n * n / 2;
    std::iter::once(middle).chain((0..n * n).filter(move |s| *s != middle))
}

fn mix(a: Colour, b: Colour, share: f32) -> Colour {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * share)
}
