//! Candidates: everything within the skin of touching, found by cells and trees. Valid until motion has used the
//! skin up, which `near.rs` checks against the positions kept here.

use super::block_work::{BlockWork, Candidates};
use super::model::Model;
use super::state::State;
use super::work::Work;
use crate::bodies::members::Members;
use crate::bodies::part::Part;
use crate::bond::Held;
use crate::contact::kind::{KINDS, Now, Search};
use crate::lanes::record::{Record, xyz};
use crate::pairs::cross::ImageName;
use crate::pairs::patch_search as patches;
use crate::shape::cuboid;
use crate::spatial::cells::Cells;
use crate::spatial::periodic::Space;
use crate::spatial::surface::Surface;
use rayon::prelude::*;

/// Finds all candidates anew.
pub(crate) fn search<S: Surface>(model: &Model, state: &State, work: &mut Work, surface: &S) {
    super::bonds::hold(model, state, &mut work.held);
    let Work { members, blocks: works, parallel, held, .. } = &mut *work;
    let all = All::new(model, state, members, held);
    let kinds = model.solids.then(|| Search::new(now(model, state, members)));
    let walls = model.walls.placed(&state.walls);
    let one = |(b, w): (usize, &mut BlockWork)| {
        let c = &mut w.candidates;
        all.spheres(b, c);
        if let Some(kinds) = &kinds {
            c.kinds.resize_with(KINDS.len(), Vec::new);
            for (kind, list) in KINDS.iter().zip(&mut c.kinds) {
                kind.candidates(kinds, b, model.skin, &mut c.row, list);
            }
        }
        c.pairs.shrink_to_fit();
        c.cross.shrink_to_fit();
        c.planes.shrink_to_fit();
        let own = all.of_block(b);
        let free = |i: u32| state.blocks[b].velocity[all.members[b].body(i) as usize][3] > 0.0;
        patches::candidates(&walls, own, model.skin, free, &mut c.row, &mut c.walls);
        patches::candidates(surface, own, model.skin, free, &mut c.row, &mut c.surface);
    };
    if *parallel {
        works.par_iter_mut().enumerate().for_each(one);
    } else {
        works.iter_mut().enumerate().for_each(one);
    }

    // Corners of the boxes that hold bodies count as points that move.
    for (own, (block, w)) in members.iter().zip(state.blocks.iter().zip(works)) {
        for (k, half) in own.half.iter().enumerate() {
            let (x, q) = (xyz(&block.centre[k]), &block.rotation[k].orientation);
            (0..8).for_each(|c| w.candidates.reference.push(&(x + q * cuboid::corner(half, c))));
        }
    }
    let searched = &mut work.searched;
    searched.planes.clear();
    searched.planes.extend(state.planes.iter().map(|m| m.offset));
    searched.walls.clear();
    searched.walls.extend(state.walls.iter().map(|w| (w.offset, w.orientation)));
    searched.surface_drift = 0.0;
    searched.listed = true;
    searched.searches += 1;
}

/// All spheres of a state in cells; needed for the search only, which is rare: not kept.
struct All<'a> {
    model: &'a Model,
    state: &'a State,
    members: &'a [Members],
    held: &'a Held,
    points: Vec<Record>,
    /// Block and number there of each.
    names: Vec<[u32; 2]>,
    /// First sphere of each block.
    first: Vec<u32>,
    cells: Cells,
    space: Option<Space>,
}

impl<'a> All<'a> {
    fn new(model: &'a Model, state: &'a State, members: &'a [Members], held: &'a Held) -> All<'a> {
        let (mut points, mut names, mut cells) = (Vec::new(), Vec::new(), Cells::default());
        let mut first = Vec::with_capacity(members.len());
        for (b, (block, own)) in state.blocks.iter().zip(members).enumerate() {
            first.push(points.len() as u32);
            points.extend_from_slice(&own.spheres(block)[..own.count]);
            names.extend((0..own.count as u32).map(|k| [b as u32, k]));
        }
        let space = model.periodic.map(|p| Space::new(p, &points, model.radii.1));
        cells.build(space.as_ref().map_or(&points, |s| &s.points), model.radii, model.skin);
        All { model, state, members, held, points, names, first, cells, space }
    }

    /// The spheres of a block.
    fn of_block(&self, b: usize) -> &[Record] {
        &self.points[self.first[b] as usize..][..self.members[b].count]
    }

    /// Block and place of a sphere's body.
    fn body(&self, point: u32) -> (u32, u32) {
        let [block, sphere] = self.names[point as usize];
        (block, self.members[block as usize].body(sphere))
    }

    /// Number of a body in the model.
    fn number(&self, (block, place): (u32, u32)) -> u32 {
        self.state.blocks[block as usize].bodies[place as usize]
    }

    /// Whether a body keeps its velocity.
    fn still(&self, (block, place): (u32, u32)) -> bool {
        self.state.blocks[block as usize].velocity[place as usize][3] == 0.0
    }

    /// Partners of the spheres of a block: spheres and planes.
    fn spheres(&self, b: usize, c: &mut Candidates) {
        let (model, skin) = (self.model, self.model.skin);
        c.pairs.clear();
        c.cross.clear();
        c.images.clear();
        c.planes.clear();
        let own = self.of_block(b);
        c.reference.start(own.first());
        for (i, p) in (0..).zip(own) {
            let global = self.first[b] + i;
            c.reference.push(&xyz(p));
            let me = self.body(global);
            let fixed = self.still(me);
            self.round(global, i, me, c);
            for &j in &c.row {
                let [block_j, j] = self.names[j as usize];
                if block_j == b as u32 {
                    c.pairs.push([i as u16, j as u16]);
                } else {
                    c.cross.push([i, block_j, j]);
                }
            }
            if !fixed {
                for (k, plane) in model.planes.iter().enumerate() {
                    let origin = plane.point + self.state.planes[k].offset;
                    if (xyz(p) - origin).dot(&plane.normal) < p[3] + skin {
                        c.planes.push([i, k as u32]);
                    }
                }
            }
        }
        c.images.sort_unstable();
    }

    /// Later spheres near one, in `row`; images of them go to their own list.
    #[inline(always)]
    fn round(&self, global: u32, i: u32, me: (u32, u32), c: &mut Candidates) {
        let skin = self.model.skin;
        let fixed = self.still(me);
        let Candidates { row, images, .. } = c;
        row.clear();
        if let Some(space) = &self.space {
            space.near(&self.cells, global, skin, |j, shift| {
                let (other, [block, j_there]) = (self.body(j), self.names[j as usize]);
                if other == me || fixed && self.still(other) {
                } else if shift == [0; 3] {
                    row.push(j);
                } else {
                    images.push(ImageName { i, block, j: j_there, shift });
                }
            });
        } else {
            let p = &self.points[global as usize];
            self.cells.near(p, skin, |j| {
                let q = &self.points[j as usize];
                let reach = p[3] + q[3] + skin;
                if j > global && (xyz(p) - xyz(q)).norm_squared() < reach * reach {
                    let other = self.body(j);
                    let held = || self.held.has(self.number(me), self.number(other));
                    if other != me && !(fixed && self.still(other)) && !held() {
                        row.push(j);
                    }
                }
            });
        }
        row.sort_unstable();
    }
}

/// Bodies and planes as they are.
pub(crate) fn now<'a>(model: &'a Model, state: &'a State, members: &'a [Members]) -> Now<'a> {
    Now {
        blocks: Part { first: 0, list: &state.blocks },
        members: Part { first: 0, list: members },
        shapes: &model.shapes,
        planes: (&model.planes, &state.planes),
    }
}
