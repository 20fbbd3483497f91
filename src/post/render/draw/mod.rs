//! Software renderer, bitwise reproducible for any number of threads.

mod bins;
mod camera;

mod lines;
mod occlusion;
mod raster;
mod resolve;
mod scene;
mod shade;
mod surface;

use rayon::prelude::*;

pub use camera::{Camera, Room, V3};
pub use scene::{Colour, Line, Look, Paint, Scene, Sphere, Triangle, Tube};

use bins::{Bins, NONE};
use lines::Lines;
use occlusion::{Light, Surfaces};
use raster::Tile;
use resolve::Resolver;
use shade::Lamps;

/// Tile side [pixels].
const TILE: usize = 16;
/// Pictures with more pixels have fewer samples, at eight bytes each.
const LARGE: usize = 6_000_000;
/// Least size for full outlines [pixels].
const OUTLINED: f32 = 26.0;
/// Range of ambient occlusion over the grain size.
const REACH: f32 = 0.55;

#[derive(Clone, Copy, Debug)]
struct Grid {
    size: [usize; 2],
    samples: usize,
    tiles: [usize; 2],
    side: usize,
}

impl Grid {
    fn new(size: [usize; 2]) -> Grid {
        let samples = if size[0] * size[1] > LARGE { 2 } else { 3 };
        Grid { size, samples, tiles: size.map(|n| n.div_ceil(TILE)), side: samples * TILE }
    }

    fn origin(&self, tile: usize) -> [usize; 2] {
        [tile % self.tiles[0] * self.side, tile / self.tiles[0] * self.side]
    }

    fn place(&self, x: usize, y: usize) -> usize {
        let tile = y / self.side * self.tiles[0] + x / self.side;
        (tile * self.side + y % self.side) * self.side + x % self.side
    }
}

/// Pixels of a scene: three bytes each, by rows from above.
pub fn draw(world: &Scene, eye: &Camera, size: [usize; 2], background: Colour) -> Vec<u8> {
    let grid = Grid::new(size);
    let fine = eye.finer(grid.samples);
    let scene = world.seen(eye);
    let opaque = |look: usize| scene.looks[look].opacity >= 1.0;
    let bins = Bins::new(&scene, &fine, grid.tiles, grid.side, opaque);
    let area = grid.side * grid.side;
    let count = grid.tiles[0] * grid.tiles[1];
    let mut depth = vec![f32::INFINITY; area * count];
    let mut id = vec![NONE; area * count];
    depth.par_chunks_mut(area).zip(id.par_chunks_mut(area)).enumerate().for_each(|(k, (depth, id))| {
        Tile { origin: grid.origin(k), side: grid.side, depth, id }.draw(&scene, &fine, &bins, k);
    });
    drop(bins);
    let light = surroundings(&scene, eye, &fine, &grid, &depth, &id);
    let glass: Vec<(usize, Bins)> = (0..scene.looks.len())
        .filter(|look| scene.looks[*look].opacity < 1.0)
        .map(|look| (look, Bins::new(&scene, &fine, grid.tiles, grid.side, |l| l == look)))
        .filter(|(_, bins)| !bins.items.is_empty())
        .collect();
    let lines = Lines::new(&scene, &fine, grid.tiles, grid.side, grid.samples);
    let lamps = Lamps::new(eye);
    let resolver = Resolver {
        scene: &scene,
        fine: &fine,
        grid: &grid,
        depth: &depth,
        id: &id,
        light: &light,
        lamps: &lamps,
        lines: &lines,
        glass: &glass,
        background,
        outlines: (scene.grain * eye.scale(eye.distance) / OUTLINED).clamp(0.25, 1.0),
    };
    let tiles: Vec<Vec<u8>> = (0..count).into_par_iter().map(|k| resolver.tile(k)).collect();
    let mut out = vec![0; 3 * size[0] * size[1]];
    for (k, tile) in tiles.iter().enumerate() {
        let [x0, y0] = grid.origin(k).map(|s| s / grid.samples);
        let wide = TILE.min(size[0] - x0);
        for y in y0..(y0 + TILE).min(size[1]) {
            let from = 3 * TILE * (y - y0);
            let to = 3 * (y * size[0] + x0);
            out[to..to + 3 * wide].copy_from_slice(&tile[from..from + 3 * wide]);
        }
    }
    out
}

fn surroundings(scene: &Scene, eye: &Camera, fine: &Camera, grid: &Grid, depth: &[f32], id: &[u32]) -> Light {
    let width = grid.size[0];
    let mut surfaces = vec![(f32::INFINITY, V3::zeros()); width * grid.size[1]];
    surfaces.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, out) in row.iter_mut().enumerate() {
            let s = [x, y].map(|v| v * grid.samples + grid.samples / 2);
            let at = grid.place(s[0], s[1]);
            if id[at] != NONE {
                let middle = s.map(|v| v as f32 + 0.5);
                *out = (depth[at], surface::surface(scene, fine, id[at], middle, depth[at]).normal);
            }
        }
    });
    let (depth, normal) = surfaces.into_iter().unzip();
    Light::of(Surfaces { width, depth, normal }, eye, REACH * scene.grain)
}
