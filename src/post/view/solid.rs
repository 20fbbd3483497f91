//! Solid for the page: skin once, displacements and fields per frame.

use super::chunk::{Chunk, Coding};
use super::lines::relative;
use trackbed_io::results::solid::Skin;

/// Block common to all frames.
pub fn common(skin: &Skin, origin: [f64; 3], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    chunk.places("points", &relative(&skin.points, origin), 3);
    chunk.indices("triangles", &skin.triangles, 3);
    chunk.indices("edges", &skin.edges, 2);
    chunk.indices("node_ids", &skin.node_ids, 1);
    chunk.indices("element_ids", &skin.element_ids, 1);
    chunk.finish()
}

pub fn displacement(values: &[f64], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    chunk.places("displacement", values, 3);
    chunk.finish()
}

/// Field block, also for grains.
pub fn field(values: &[f64], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    chunk.numbers("value", values, 1);
    chunk.finish()
}
