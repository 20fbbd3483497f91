//! Grains for the page: body definitions once, position and orientation per frame.

use serde_json::json;

use super::chunk::{Chunk, Coding};
use trackbed_io::results::grains::{Bodies, GrainFile};

pub fn frame(file: &GrainFile, known: Option<&Bodies>, origin: [f64; 3], coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    let bodies = &file.bodies;
    let starts = || bodies.start[..bodies.id.len()].iter().map(|s| *s as usize);
    let own = !known.is_some_and(|known| file.are(known));
    chunk.meta("own", json!(own));
    if own {
        list(bodies, &mut chunk);
    }
    let place = starts().flat_map(|s| (0..3).map(move |k| (s, k)));
    let place: Vec<f64> = place.map(|(s, k)| file.centres()[3 * s + k] - origin[k]).collect();
    chunk.places("position", &place, 3);
    if bodies.clumps() {
        let turn: Vec<f64> = starts()
            .flat_map(|s| {
                let q = file.turn(s);
                [q.w, q.i, q.j, q.k]
            })
            .collect();
        chunk.numbers("orientation", &turn, 4);
    }
    chunk.finish()
}

/// Block common to all frames.
pub fn common(bodies: &Bodies, coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    list(bodies, &mut chunk);
    chunk.finish()
}

fn list(bodies: &Bodies, chunk: &mut Chunk) {
    chunk.indices("start", &bodies.start, 1);
    chunk.indices("id", &bodies.id, 1);
    chunk.exact("radius", &bodies.radius, 1);
    chunk.exact("diameter", &bodies.extents(), 1);
    if bodies.clumps() {
        let flat: Vec<f64> = bodies.offset.iter().flat_map(|o| [o.x, o.y, o.z]).collect();
        chunk.exact("offset", &flat, 3);
    }
}
