//! Candidates: everything within the skin of touching, found by cells and trees. Valid until motion has used the
//! skin up, which `near.rs` checks against the positions kept here.

use crate::Vec3;
use crate::model::{Kind, Model};
use crate::periodic::Space;
use crate::search::cells::Cells;
use crate::search::patches;
use crate::shape::cuboid;
use crate::state::{Block, ImageName, Lanes, State, xyz};
use crate::surface::Surface;
use crate::work::{BlockWork, Work};
use rayon::prelude::*;

/// Centre and radius of each sphere of a block.
#[inline(always)]
pub(crate) fn spheres<'a>(block: &'a Block, work: &'a BlockWork, rigid: bool) -> &'a [Lanes] {
    if rigid { &work.spheres } else { &block.centre }
}

/// Finds all candidates anew.
pub(crate) fn search<S: Surface>(model: &Model, state: &State, work: &mut Work, surface: &S) {
    work.held.update(model, state);
    // Needed for the search only, which is rare: not kept.
    let (mut points, mut names, mut cells) = (Vec::new(), Vec::new(), Cells::default());
    let Work { blocks, parallel, held, .. } = &mut *work;
    for (b, (block, w)) in state.blocks.iter().zip(blocks.iter()).enumerate() {
        let own = spheres(block, w, model.rigid);
        points.extend_from_slice(&own[..w.count]);
        names.extend((0..w.count as u32).map(|k| [b as u32, k]));
    }
    let space = model.periodic.map(|p| Space::new(p, &points, model.radii.1));
    cells.build(space.as_ref().map_or(&points, |s| &s.points), model.radii, model.skin);

    let walls = model.walls.placed(&state.walls);
    let boxes = boxes(model, state);
    let (points, names, cells, held) = (&points[..], &names[..], &cells, &*held);
    // First sphere of each block among all points.
    let first: Vec<u32> = blocks
        .iter()
        .scan(0, |next, w| {
            let first = *next;
            *next += w.count as u32;
            Some(first)
        })
        .collect();
    let owners: Vec<u32> = blocks.iter().flat_map(|w| w.owner.iter().copied()).collect();
    let body = |point: u32| {
        let [block, sphere] = names[point as usize];
        (block, if model.rigid { owners[point as usize] } else { sphere })
    };
    let number = |(block, place): (u32, u32)| state.blocks[block as usize].bodies[place as usize];
    let still = |(block, place): (u32, u32)| state.blocks[block as usize].velocity[place as usize][3] == 0.0;

    let one = |(b, w): (usize, &mut BlockWork)| {
        let block = &state.blocks[b];
        w.candidates.clear();
        w.cross.clear();
        w.boxed.clear();
        w.images.clear();
        w.planes.clear();
        w.reference.start((w.count > 0).then(|| &points[first[b] as usize]));
        for i in 0..w.count as u32 {
            let global = first[b] + i;
            let p = &points[global as usize];
            w.reference.push(&xyz(p));
            let me = body(global);
            let fixed = still(me);
            w.row.clear();
            if let Some(space) = &space {
                space.near(cells, global, model.skin, |j, shift| {
                    let (other, [block, j_there]) = (body(j), names[j as usize]);
                    if other == me || fixed && still(other) {
                    } else if shift == [0; 3] {
                        w.row.push(j);
                    } else {
                        w.images.push(ImageName { i, block, j: j_there, shift });
                    }
                });
            } else {
                cells.near(p, model.skin, |j| {
                    let q = &points[j as usize];
                    let reach = p[3] + q[3] + model.skin;
                    if j > global && (xyz(p) - xyz(q)).norm_squared() < reach * reach {
                        let other = body(j);
                        if other != me && !(fixed && still(other)) && !held.has(number(me), number(other)) {
                            w.row.push(j);
                        }
                    }
                });
            }
            w.row.sort_unstable();
            for &j in &w.row {
                let [block_j, j] = names[j as usize];
                if block_j == b as u32 {
                    w.candidates.push([i as u16, j as u16]);
                } else {
                    w.cross.push([i, block_j, j]);
                }
            }
            for bx in &boxes {
                let local = bx.orientation.inverse_transform_vector(&(xyz(p) - bx.centre));
                let distance = cuboid::closest_point(&bx.half, &local).2;
                if distance < p[3] + model.skin && !(fixed && bx.still) {
                    w.boxed.push([i, bx.block, bx.place]);
                }
            }
            if !fixed {
                for (k, plane) in model.planes.iter().enumerate() {
                    let origin = plane.point + state.planes[k].offset;
                    if (xyz(p) - origin).dot(&plane.normal) < p[3] + model.skin {
                        w.planes.push([i, k as u32]);
                    }
                }
            }
        }
        w.images.sort_unstable();
        // Boxes touch planes with their corners: few enough to try them all.
        if w.kind.first() == Some(&Kind::Box) {
            for (k, lanes) in block.velocity.iter().enumerate() {
                if lanes[3] > 0.0 {
                    let corners = 8 * k as u32..8 * (k as u32 + 1);
                    w.planes
                        .extend(corners.flat_map(|c| (0..model.planes.len() as u32).map(move |p| [c, p])));
                }
            }
        }
        let own = &points[first[b] as usize..first[b] as usize + w.count];
        let owner = &w.owner;
        let free = |i: u32| {
            let body = owner.get(i as usize).copied().unwrap_or(i);
            block.velocity[body as usize][3] > 0.0
        };
        w.candidates.shrink_to_fit();
        w.cross.shrink_to_fit();
        w.planes.shrink_to_fit();
        patches::candidates(&walls, own, model.skin, free, &mut w.row, &mut w.walls);
        patches::candidates(surface, own, model.skin, free, &mut w.row, &mut w.surface);
    };
    if *parallel {
        blocks.par_iter_mut().enumerate().for_each(one);
    } else {
        blocks.iter_mut().enumerate().for_each(one);
    }

    // Corners of boxes count as points that move.
    for bx in &boxes {
        let w = &mut work.blocks[bx.block as usize];
        for k in 0..8 {
            w.reference.push(&(bx.centre + bx.orientation * cuboid::corner(&bx.half, k)));
        }
    }
    work.wall_reference.clear();
    work.wall_reference.extend(state.planes.iter().map(|m| m.offset));
    work.wall_places.clear();
    work.wall_places.extend(state.walls.iter().map(|w| (w.offset, w.orientation)));
    work.surface_drift = 0.0;
    work.listed = true;
    work.searches += 1;
}

struct BoxBody {
    block: u32,
    place: u32,
    centre: Vec3,
    orientation: nalgebra::UnitQuaternion<f64>,
    half: Vec3,
    still: bool,
}

fn boxes(model: &Model, state: &State) -> Vec<BoxBody> {
    let mut out = Vec::new();
    for (b, block) in state.blocks.iter().enumerate() {
        for (k, &body) in block.bodies.iter().enumerate() {
            if model.bodies.kind(body as usize) == Kind::Box {
                out.push(BoxBody {
                    block: b as u32,
                    place: k as u32,
                    centre: xyz(&block.centre[k]),
                    orientation: block.rotation[k].orientation,
                    half: model.half(body as usize),
                    still: block.velocity[k][3] == 0.0,
                });
            }
        }
    }
    out
}
