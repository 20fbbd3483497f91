//! Broad-phase candidate pairs closer than the search skin, from cell grids and trees.

use super::block_work::{BlockWork, Candidates};
use super::clump_bounds::ClumpBounds;
use super::images::Repeated;
use super::model::Model;
use super::state::State;
use super::work::Work;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::bond::BondedPairs;
use crate::contact::narrow_phase::{Configuration, KINDS, Search};
use crate::lanes::vec4::{Vec4, xyz};
use crate::law::scarring::Scar;
use crate::pairs::cross::ImageName;
use crate::pairs::patch_search as patches;
use crate::shape::cuboid;
use crate::shape::plane::PlaneMotion;
use crate::spatial::cells::Cells;
use crate::spatial::patchwork::{WallView, Walls};
use crate::spatial::periodic::Space;
use crate::spatial::sheet::SheetFacet;
use crate::spatial::surface::Surface;
use rayon::prelude::*;
use std::ops::Range;

/// Locally listed contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Listed {
    All,
    /// Excludes planes and sphere pairs, except periodic ones: the back end lists these.
    Rest,
}

pub(crate) fn search<S: Surface>(model: &Model, state: &State, work: &mut Work, surface: &S, listed: Listed) {
    super::bonds::list_bonded_pairs(model, state, &mut work.held);
    let Work { members, blocks: works, parallel, held, walls: standing, sheet, own, halo, .. } = &mut *work;
    let all = All::new(model, state, members, held, (&*own, halo), listed);
    let kinds = model
        .solids
        .then(|| Search::new(configuration(model, state, members, (standing, sheet)), &model.patch_trees));
    let walls = model.walls.placed(&state.walls);
    let one = |(b, w): (usize, &mut BlockWork)| {
        let c = &mut w.candidates;
        if !all.own.contains(&b) {
            c.cross.clear();
            return;
        }
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
        match &model.images {
            None => {
                patches::candidates(&walls, own, model.skin, free, &mut c.row, &mut c.walls);
                patches::candidates(surface, own, model.skin, free, &mut c.row, &mut c.surface);
            }
            Some(images) => {
                let walls = Repeated { surface: &walls, images };
                patches::candidates(&walls, own, model.skin, free, &mut c.row, &mut c.walls);
                let surface = Repeated { surface, images };
                patches::candidates(&surface, own, model.skin, free, &mut c.row, &mut c.surface);
            }
        }
    };
    if *parallel {
        works.par_iter_mut().enumerate().for_each(one);
    } else {
        works.iter_mut().enumerate().for_each(one);
    }
    return_earlier_pairs(works, own);

    // Corners of bounding boxes are tracked as points.
    for b in own.clone() {
        let (own, block, w) = (&members[b], &state.blocks[b], &mut works[b]);
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
    searched.surface_travel = 0.0;
    searched.listed = Some(listed);
    searched.searches += 1;
}

fn return_earlier_pairs(works: &mut [BlockWork], own: &Range<usize>) {
    let (earlier, here) = works.split_at_mut(own.start);
    for (b, w) in own.clone().zip(here) {
        for &[block, i, j] in &w.candidates.earlier {
            earlier[block as usize].candidates.cross.push([i, b as u32, j]);
        }
    }
    earlier.iter_mut().for_each(|w| w.candidates.cross.sort_unstable());
}

/// Freed after the search.
struct All<'a> {
    model: &'a Model,
    state: &'a State,
    members: &'a [BlockBodies],
    held: &'a BondedPairs,
    own: &'a Range<usize>,
    points: Vec<Vec4>,
    /// Block and local index.
    names: Vec<[u32; 2]>,
    first: Vec<u32>,
    cells: Cells,
    space: Option<Space>,
    /// If most spheres are in clumps.
    clump_bounds: Option<ClumpBounds>,
    listed: Listed,
}

impl<'a> All<'a> {
    fn new(
        model: &'a Model,
        state: &'a State,
        members: &'a [BlockBodies],
        held: &'a BondedPairs,
        (own, halo): (&'a Range<usize>, &[[u32; 2]]),
        listed: Listed,
    ) -> All<'a> {
        let (mut points, mut names, mut cells) = (Vec::new(), Vec::new(), Cells::default());
        let mut first = Vec::with_capacity(members.len());
        let mut halo = halo.iter().peekable();
        for (b, (block, there)) in state.blocks.iter().zip(members).enumerate() {
            first.push(points.len() as u32);
            let mut put = |range: Range<u32>| {
                points.extend_from_slice(&there.spheres(block)[range.start as usize..range.end as usize]);
                names.extend(range.map(|k| [b as u32, k]));
            };
            if own.contains(&b) {
                put(0..there.count as u32);
            }
            while let Some([_, place]) = halo.next_if(|[block, _]| *block == b as u32) {
                put(there.of_body(*place as usize));
            }
        }
        let space = model.periodic.map(|p| Space::new(p, &points, model.radii.1));
        // With few clumps a second level does not pay.
        let in_clumps: usize = members[own.clone()].iter().map(BlockBodies::in_clumps).sum();
        let among_spheres = listed == Listed::All;
        let by_bodies = among_spheres && space.is_none() && 2 * in_clumps > points.len();
        let clump_bounds = by_bodies.then(|| {
            let body = |[block, sphere]: [u32; 2]| members[block as usize].body(sphere);
            ClumpBounds::new(
                &points,
                names.iter().map(|&name| (name[0], body(name))),
                members.len(),
                model.skin,
            )
        });
        if clump_bounds.is_none() && (among_spheres || space.is_some()) {
            cells.build(space.as_ref().map_or(&points, |s| &s.points), model.radii, model.skin);
        }
        All { model, state, members, held, own, points, names, first, cells, space, clump_bounds, listed }
    }

    fn of_block(&self, b: usize) -> &[Vec4] {
        &self.points[self.first[b] as usize..][..self.members[b].count]
    }

    fn body(&self, point: u32) -> (u32, u32) {
        let [block, sphere] = self.names[point as usize];
        (block, self.members[block as usize].body(sphere))
    }

    fn number(&self, (block, place): (u32, u32)) -> u32 {
        self.state.blocks[block as usize].bodies[place as usize]
    }

    fn still(&self, (block, place): (u32, u32)) -> bool {
        self.state.blocks[block as usize].velocity[place as usize][3] == 0.0
    }

    fn spheres(&self, b: usize, c: &mut Candidates) {
        c.pairs.clear();
        c.cross.clear();
        c.earlier.clear();
        c.images.clear();
        c.planes.clear();
        c.reference.start(self.of_block(b).first());
        if self.listed == Listed::Rest && self.space.is_none() {
            self.of_block(b).iter().for_each(|p| c.reference.push(&xyz(p)));
            return;
        }
        match &self.clump_bounds {
            Some(clump_bounds) => {
                let mut near = Vec::new();
                for body in clump_bounds.of_block(b) {
                    let me = self.body(clump_bounds.spheres(body).start);
                    self.nearby_clumps(clump_bounds, body, me, &mut near);
                    for global in clump_bounds.spheres(body) {
                        self.nearby_members(clump_bounds, &near, global, &mut c.row);
                        self.list(b, global, me, c);
                    }
                }
            }
            None => {
                for global in (self.first[b]..).take(self.members[b].count) {
                    let me = self.body(global);
                    self.list_candidates(global, global - self.first[b], me, c);
                    self.list(b, global, me, c);
                }
            }
        }
        c.images.sort_unstable();
    }

    fn list(&self, b: usize, global: u32, me: (u32, u32), c: &mut Candidates) {
        let (model, p, i) = (self.model, &self.points[global as usize], global - self.first[b]);
        c.reference.push(&xyz(p));
        if self.listed == Listed::Rest {
            return;
        }
        for &j in &c.row {
            let [block_j, j] = self.names[j as usize];
            if block_j == b as u32 {
                c.pairs.push([i as u16, j as u16]);
            } else if block_j < b as u32 {
                c.earlier.push([block_j, j, i]);
            } else {
                c.cross.push([i, block_j, j]);
            }
        }
        if !self.still(me) {
            for (k, plane) in model.planes.iter().enumerate() {
                let origin = plane.point + self.state.planes[k].offset;
                if (xyz(p) - origin).dot(&plane.normal) < p[3] + model.skin {
                    c.planes.push([i, k as u32]);
                }
            }
        }
    }

    /// Excludes fixed pairs and bonds.
    fn may_touch(&self, me: (u32, u32), other: (u32, u32)) -> bool {
        let both_still = self.still(me) && self.still(other);
        !both_still && !self.held.has(self.number(me), self.number(other))
    }

    fn nearby_clumps(&self, clump_bounds: &ClumpBounds, body: u32, me: (u32, u32), near: &mut Vec<u32>) {
        let (skin, p) = (self.model.skin, &clump_bounds.around[body as usize]);
        let before = clump_bounds.of_block(self.own.start).start;
        near.clear();
        clump_bounds.cells.neighbours(p, skin, |other| {
            let q = &clump_bounds.around[other as usize];
            let reach = p[3] + q[3] + skin;
            if (other > body || other < before)
                && (xyz(p) - xyz(q)).norm_squared() < reach * reach
                && self.may_touch(me, self.body(clump_bounds.spheres(other).start))
            {
                near.push(other);
            }
        });
        near.sort_unstable();
    }

    #[inline(always)]
    fn nearby_members(&self, clump_bounds: &ClumpBounds, near: &[u32], global: u32, row: &mut Vec<u32>) {
        let (skin, p) = (self.model.skin, &self.points[global as usize]);
        let close = |q: &Vec4| {
            let reach = p[3] + q[3] + skin;
            (xyz(p) - xyz(q)).norm_squared() < reach * reach
        };
        row.clear();
        for &body in near {
            if close(&clump_bounds.around[body as usize]) {
                row.extend(clump_bounds.spheres(body).filter(|&j| close(&self.points[j as usize])));
            }
        }
    }

    /// Image pairs go to a separate list.
    #[inline(always)]
    fn list_candidates(&self, global: u32, i: u32, me: (u32, u32), c: &mut Candidates) {
        let skin = self.model.skin;
        let fixed = self.still(me);
        let Candidates { row, images, .. } = c;
        row.clear();
        if let Some(space) = &self.space {
            space.neighbours(&self.cells, global, skin, |j, shift| {
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
            let before = self.first.get(self.own.start).copied().unwrap_or(0);
            self.cells.neighbours(p, skin, |j| {
                let q = &self.points[j as usize];
                let reach = p[3] + q[3] + skin;
                if (j > global || j < before) && (xyz(p) - xyz(q)).norm_squared() < reach * reach {
                    let other = self.body(j);
                    if other != me && self.may_touch(me, other) {
                        row.push(j);
                    }
                }
            });
        }
        row.sort_unstable();
    }
}

pub(crate) fn configuration<'a>(
    model: &'a Model,
    state: &'a State,
    members: &'a [BlockBodies],
    standing: (&'a [WallView], &'a [SheetFacet]),
) -> Configuration<'a> {
    let bodies = (BlockSlice { first: 0, list: &state.blocks[..] }, BlockSlice { first: 0, list: members });
    block_configuration(model, bodies, &state.planes, standing, &state.scars)
}

pub(crate) fn block_configuration<'a>(
    model: &'a Model,
    (blocks, members): (BlockSlice<'a, Block>, BlockSlice<'a, BlockBodies>),
    planes: &'a [PlaneMotion],
    (walls, sheet): (&'a [WallView], &'a [SheetFacet]),
    scars: &'a [Scar],
) -> Configuration<'a> {
    Configuration {
        blocks,
        members,
        shapes: &model.shapes,
        cores: &model.cores,
        planes: (&model.planes, planes),
        walls: Walls { patches: &model.patches, walls },
        sheet: model.sheet_at(sheet),
        periodic: model.periodic.as_ref(),
        scars,
    }
}

#[cfg(test)]
#[path = "broad_phase_tests.rs"]
mod tests;
