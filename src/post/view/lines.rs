//! Force chains and walls for the page.

use super::chunk::{Chunk, Coding};
use trackbed_io::results::lines::{Chains, Walls};

pub fn relative(places: &[f64], origin: [f64; 3]) -> Vec<f64> {
    places.iter().enumerate().map(|(k, x)| x - origin[k % 3]).collect()
}

/// Chain block: both ends, forces, kinds.
pub fn chains(chains: &Chains, origin: [f64; 3], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    // Both ends share coordinate limits.
    chunk.numbers("ends", &relative(&chains.ends, origin), 3);
    for (name, values) in &chains.forces {
        chunk.numbers(name, values, 1);
    }
    for (name, values) in &chains.marks {
        chunk.small(name, values);
    }
    chunk.finish()
}

/// Wall block: points, triangles, edges, wall and kind per triangle.
pub fn walls(walls: &Walls, origin: [f64; 3], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    chunk.places("points", &relative(&walls.points, origin), 3);
    chunk.indices("triangles", &walls.triangles, 3);
    chunk.indices("edges", &walls.edges, 2);
    chunk.indices("id", &walls.id, 1);
    chunk.small("kind", &walls.kind);
    chunk.finish()
}
