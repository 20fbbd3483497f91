//! Flat device arrays of wall triangles and sphere–triangle pairs.

use super::bodies::Spheres;
use super::layout::{PATCH_WIDTH, SHAPE_WIDTH, WALL_WIDTH};
use crate::Vec3;
use crate::engine::model::Model;
use crate::engine::state::{BlockLists, State};
use crate::law::History;
use crate::pairs::patches::{PatchContact, PatchList};

/// Triangles of all walls, in the wall frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Triangles {
    /// Planes of triangle and edges, vertices.
    pub shapes: Vec<[f64; SHAPE_WIDTH]>,
    /// Wall, index of the plane shared by coplanar triangles, vertex indices.
    pub names: Vec<[u32; PATCH_WIDTH]>,
}

impl Triangles {
    pub fn of(model: &Model) -> Triangles {
        let mut out = Triangles::default();
        for (wall, flat, triangle) in model.walls.triangles() {
            let [a, b, c] = triangle.vertices;
            out.shapes.push(triangle.numbers());
            out.names.push([wall, flat, a, b, c]);
        }
        out
    }
}

/// Initial centre, displacement, orientation, velocity, angular velocity, rotated flag, material, 1/mass of
/// each wall.
pub(super) fn placed(model: &Model, state: &State) -> Vec<[f64; WALL_WIDTH]> {
    let walls = model.walls.walls.iter().zip(&state.walls);
    walls
        .map(|(wall, now)| {
            let mut out = [0.0; WALL_WIDTH];
            let [c, o, v, w] = [wall.centre, now.offset, now.velocity, now.spin];
            let q = &now.orientation;
            let inverse_mass = wall.body.as_ref().map_or(0.0, |b| b.inverse_mass);
            out[..3].copy_from_slice(c.as_slice());
            out[3..6].copy_from_slice(o.as_slice());
            out[6..10].copy_from_slice(&[q.i, q.j, q.k, q.w]);
            out[10..13].copy_from_slice(v.as_slice());
            out[13..16].copy_from_slice(w.as_slice());
            out[16..].copy_from_slice(&[f64::from(now.turned), f64::from(wall.material), inverse_mass]);
            out
        })
        .collect()
}

#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    pub ends: Vec<[u32; 2]>,
    /// First pair of each sphere that has any, with end.
    pub groups: Vec<u32>,
    /// Whether a contact of the last step lost its pair: the engine must record its energy.
    pub overflowed: bool,
}

impl Pairs {
    pub fn add(&mut self, block: usize, lists: &BlockLists, spheres: &Spheres) {
        for pairs in lists.walls.pairs.chunk_by(|a, b| a.i == b.i) {
            self.groups.push(self.ends.len() as u32);
            self.ends.extend(pairs.iter().map(|pair| [spheres.at(block, pair.i), pair.patch]));
        }
        self.overflowed |= overflowed(lists);
    }
}

pub(super) fn overflowed(lists: &BlockLists) -> bool {
    let alive = joined(&lists.walls).filter(Option::is_some).count();
    alive < lists.walls.live.len()
}

fn joined(list: &PatchList) -> impl Iterator<Item = Option<&PatchContact>> {
    let mut live = list.live.iter().peekable();
    list.pairs.iter().map(move |pair| {
        let name = (pair.i, pair.patch);
        while live.next_if(|c| (c.i, c.patch) < name).is_some() {}
        live.next_if(|c| (c.i, c.patch) == name)
    })
}

/// Pair data besides the law's history: remaining distance; in contact also point and overlap, normal and
/// side, wall velocity and a flag of 1.
#[derive(Clone, Debug, Default)]
pub(super) struct PatchHistory {
    pub spare: Vec<f64>,
    pub touch: Vec<[[f64; 4]; 3]>,
}

impl PatchHistory {
    pub fn zeros(pairs: usize) -> PatchHistory {
        PatchHistory { spare: vec![0.0; pairs], touch: vec![[[0.0; 4]; 3]; pairs] }
    }

    /// Appends pairs of a block; `f` gets their histories.
    pub fn add(&mut self, list: &PatchList, mut f: impl FnMut(History)) {
        self.spare.extend(list.pairs.iter().map(|pair| pair.spare));
        for contact in joined(list) {
            let four = |v: &Vec3, last: f64| [v.x, v.y, v.z, last];
            self.touch.push(contact.map_or([[0.0; 4]; 3], |c| {
                [four(&c.point, c.overlap), four(&c.normal, c.side), four(&c.velocity, 1.0)]
            }));
            f(contact.map_or(History::NONE, |c| c.history));
        }
    }

    /// Writes from pair `at` on; `history(k)`: of pair `at` + k.
    pub fn put(&self, list: &mut PatchList, at: usize, history: impl Fn(usize) -> History) {
        list.live.clear();
        for (k, pair) in list.pairs.iter_mut().enumerate() {
            pair.spare = self.spare[at + k];
            let [point, normal, velocity] = self.touch[at + k];
            if velocity[3] == 0.0 {
                continue;
            }
            let vector = |[x, y, z, _]: [f64; 4]| Vec3::new(x, y, z);
            list.live.push(PatchContact {
                i: pair.i,
                patch: pair.patch,
                point: vector(point),
                normal: vector(normal),
                velocity: vector(velocity),
                overlap: point[3],
                side: normal[3],
                history: history(k),
            });
        }
    }
}
