//! Beds that are smaller, of two sizes, or on triangles.

use crate::bed::{Bed, WIDTH, of_spheres, tile};
use crate::grains;
use trackbed_dem::{BodyInput, ModelInput, TimeStep, TriangleSurface, Vec3};

/// A cube of about `count` spheres cut from the bed, settled anew.
pub fn cut(count: usize) -> Bed {
    let tile = tile();
    let side = WIDTH * (count as f64 / tile.len() as f64).cbrt();
    let inside = |b: &BodyInput| b.position.iter().all(|&x| x + b.scale < side);
    Bed::at_rest(of_spheres(tile.into_iter().filter(inside).collect()), side, 20_000, grains::stone())
}

/// Spheres 20 times smaller that fill the pores between those of a cube cut from the bed: face-centred cubic, in layers
/// that rest on each other.
pub fn two_sizes() -> Bed {
    let side = 0.06;
    let mut bodies: Vec<_> =
        tile().into_iter().filter(|b| b.position.iter().all(|&x| x + b.scale < side)).collect();
    let large = bodies.clone();
    let r = 0.0005;
    // Just touching.
    let d = 2.0 * r - 1e-8;
    let (n, layers) = ((side / d) as usize, (side / (d * 0.5_f64.sqrt())) as usize);
    for layer in 0..layers {
        let shift = 0.5 * (layer % 2) as f64;
        for k in 0..n * n {
            let x = [k % n, k / n].map(|c| (c as f64 + 0.5 + shift) * d);
            let position = Vec3::new(x[0], x[1], r + layer as f64 * d * 0.5_f64.sqrt());
            let inside = x.iter().all(|&x| x + r <= side);
            if inside && large.iter().all(|b| (b.position - position).norm() > b.scale + r) {
                bodies.push(BodyInput { position, scale: r, ..BodyInput::default() });
            }
        }
    }
    // The step of the small ones.
    let mut input = of_spheres(bodies);
    input.time_step = TimeStep::Auto { fraction: 0.2 };
    Bed::at_rest(input, side, 300, grains::stone())
}

/// The bed on a floor of 2 × 71 × 71 triangles.
pub fn triangles() -> Bed {
    let input = ModelInput { triangles: vec![floor(WIDTH, 71)], ..of_spheres(tile()) };
    Bed::at_rest(input, WIDTH, 300, grains::stone())
}

/// A level floor over x, y in [0, width]: squares, `count` to a side, halved.
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
