//! Smaller, bidisperse, and triangle-floored beds.

use crate::bed::{Bed, WIDTH, of_spheres, tile};
use crate::grains;
use trackbed_dem::{BodyInput, Material, ModelInput, TimeStep, TriangleSurface, Vec3};

/// Cube of about `count` spheres, deposited again, then of `material`.
pub fn cut(count: usize, material: Material) -> Bed {
    let tile = tile();
    let side = WIDTH * (count as f64 / tile.len() as f64).cbrt();
    let inside = |b: &BodyInput| b.position.iter().all(|&x| x + b.scale < side);
    let bodies: Vec<_> = tile.into_iter().filter(inside).collect();
    let settled = Bed::at_rest(of_spheres(bodies.clone()), side, 20_000, grains::stone());
    let at_rest = bodies.into_iter().enumerate();
    let at_rest = at_rest.map(|(k, b)| BodyInput { position: settled.state.position(k), ..b });
    Bed::at_rest(of_spheres(at_rest.collect()), side, 300, material)
}

/// Size ratio 20: scaled copies of the bed fill the gaps without overlap. Deposition at 400 times gravity
/// keeps the ratio overlap/radius, until both sizes are in contact.
pub fn two_sizes() -> Bed {
    let (side, scale) = (0.042, 0.05);
    let tile = tile();
    let mut bodies: Vec<_> =
        tile.iter().filter(|b| b.position.iter().all(|&x| x + b.scale < side)).cloned().collect();
    let large = bodies.clone();
    let height = tile.iter().map(|b| b.position.z + b.scale).fold(0.0, f64::max);
    let tiles = Vec3::new(WIDTH, WIDTH, height) * scale;
    let count = tiles.map(|t| (side / t).ceil() as usize);
    for k in 0..count.x * count.y * count.z {
        let cell = [k % count.x, k / count.x % count.y, k / (count.x * count.y)];
        let corner = Vec3::from_fn(|d, _| cell[d] as f64 * tiles[d]);
        for b in &tile {
            let (position, r) = (corner + b.position * scale, b.scale * scale);
            let inside = position.iter().all(|&x| x + r <= side);
            if inside && large.iter().all(|b| (b.position - position).norm() > b.scale + r) {
                bodies.push(BodyInput { position, scale: r, ..BodyInput::default() });
            }
        }
    }
    // Step of the small spheres.
    let mut input = of_spheres(bodies);
    input.time_step = TimeStep::Auto { fraction: 0.8 };
    input.gravity *= 400.0;
    Bed::at_rest(input, side, 10_000, grains::stone())
}

/// Floor of 2 × 71 × 71 triangles.
pub fn triangles() -> Bed {
    let input = ModelInput { triangles: vec![floor(WIDTH, 71)], ..of_spheres(tile()) };
    Bed::at_rest(input, WIDTH, 300, grains::stone())
}

/// Halved squares over x, y in [0, width], `count` per side.
fn floor(width: f64, count: u32) -> TriangleSurface {
    let at = |k: u32| width * f64::from(k) / f64::from(count);
    let vertices = (0..=count).flat_map(|j| (0..=count).map(move |i| Vec3::new(at(i), at(j), 0.0))).collect();
    let square = |i: u32, j: u32| {
        let a = j * (count + 1) + i;
        let (b, c, d) = (a + 1, a + count + 2, a + count + 1);
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..count).flat_map(|j| (0..count).flat_map(move |i| square(i, j))).collect();
    TriangleSurface { vertices, triangles, material: 0, velocity: Vec3::zeros() }
}
