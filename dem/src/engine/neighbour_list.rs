//! Neighbour list with contact history, built from broad-phase candidate pairs.

use super::block_work::Candidates;
use super::broad_phase::{self, Listed};
use super::images::Repeated;
use super::model::Model;
use super::state::{BlockLists, State};
use super::walls;
use super::work::Work;
use super::workspace_layout::link;
use crate::bodies::block_slice::BlockSlice;
use crate::contact::narrow_phase::KINDS;
use crate::lanes::V3;
use crate::lanes::vec4::xyz;
use crate::pairs::cross::{self, Cross, ImageName};
use crate::pairs::patch_search as patches;
use crate::pairs::reach;
use crate::shape::cuboid;
use crate::spatial::surface::Surface;
use rayon::prelude::*;

pub(crate) fn update<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
    listed: Listed,
) {
    if !needs_rebuild(state) {
        return;
    }
    if state.stale {
        work.place_spheres(state);
    }
    adapt(model, state);
    work.searched.surface_travel += state.wall_travel;
    let mut approach = if state.stale || work.searched.listed != Some(listed) {
        f64::INFINITY
    } else {
        approach(model, state, work, moved2(state, work))
    };
    if exceeds_skin(model, state, approach) {
        broad_phase::search(model, state, work, surface, listed);
        approach = 0.0;
    }
    rebuild(model, state, work, surface, approach);
}

pub(crate) fn exceeds_skin(model: &Model, state: &State, approach: f64) -> bool {
    approach + state.near > model.skin
}

pub(crate) fn adapt(model: &Model, state: &mut State) {
    if exceeds_cutoff(state) {
        // A list that lasts about ten steps costs least; rebuild times do not affect results.
        if state.steps_since_search < 6 {
            state.near = (1.5 * state.near).min(0.5 * model.skin);
        } else if state.steps_since_search > 40 {
            state.near = (state.near / 1.2).max(0.02 * model.skin);
        }
    }
}

/// `approach`: bound on relative displacement since the search [m].
pub(crate) fn rebuild<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
    approach: f64,
) {
    make(model, state, work, surface, approach);
    finish_rebuild(state, work);
}

pub(crate) fn finish_rebuild(state: &mut State, work: &mut Work) {
    state.max_travel = 0.0;
    state.wall_travel = 0.0;
    state.steps_since_search = 0;
    state.stale = false;
    work.searched.refreshes += 1;
}

fn exceeds_cutoff(state: &State) -> bool {
    (2.0 * state.max_travel).max(state.max_travel + state.wall_travel) > state.near
}

pub(crate) fn needs_rebuild(state: &State) -> bool {
    state.stale || exceeds_cutoff(state)
}

/// Bound on squared displacement since the search [m²].
pub(crate) fn moved2(state: &State, work: &Work) -> f64 {
    let own = work.own.clone();
    let blocks = state.blocks[own.clone()].iter().zip(&work.members[own.clone()]).zip(&work.blocks[own]);
    let moved2 = blocks.map(|((block, members), w)| {
        let reference = &w.candidates.reference;
        let own = members.spheres(block);
        let moved = own[..members.count].iter().enumerate().map(|(k, p)| reference.moved2(k, &xyz(p)));
        let mut most = moved.fold(0.0, f64::max);
        for (k, half) in members.half.iter().enumerate() {
            let (x, q) = (xyz(&block.centre[k]), &block.rotation[k].orientation);
            for c in 0..8 {
                let now = x + q * cuboid::corner(half, c);
                most = most.max(reference.moved2(members.count + 8 * k + c, &now));
            }
        }
        most
    });
    moved2.fold(0.0, f64::max)
}

/// Bound on relative displacement since the search [m].
pub(crate) fn approach(model: &Model, state: &State, work: &Work, moved2: f64) -> f64 {
    let moved = moved2.sqrt();
    let planes = state.planes.iter().zip(&work.searched.planes);
    let wall = planes.map(|(m, x)| (m.offset - x).norm()).fold(work.searched.surface_travel, f64::max);
    let wall = wall.max(walls::max_displacement(model, state, &work.searched.walls));
    (2.0 * moved).max(moved + wall)
}

fn make<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S, approach: f64) {
    let State { blocks, lists, cross, planes, walls, near, scars, .. } = &mut *state;
    let (blocks, near, planes) = (&*blocks, *near, &*planes);
    let walls = model.walls.placed(walls);
    let Work { members, blocks: works, merging: pool, parallel, walls: standing, sheet, .. } = &mut *work;
    let (members, pool) = (&*members, &*pool);
    let spheres = |b: u32| members[b as usize].spheres(&blocks[b as usize]);
    let bodies = (BlockSlice { first: 0, list: blocks }, BlockSlice { first: 0, list: members });
    let now = broad_phase::block_configuration(model, bodies, planes, (standing, sheet), scars);

    let between = |(b, (cross, c)): (usize, (&mut Cross, &Candidates))| {
        let mut merging = pool.take();
        let own = spheres(b as u32);
        let close = |c: &[u32; 3]| {
            let (p, q) = (&own[c[0] as usize], &spheres(c[1])[c[2] as usize]);
            reach::spheres(V3::from_vec(&(xyz(p) - xyz(q))), (p[3], q[3]), near)
        };
        merging.three.merge(&mut cross.spheres, c.cross.iter().copied(), close);
        pool.give_back(merging);
        for (kind, (list, candidates)) in KINDS.iter().zip(cross.kinds.iter_mut().zip(&c.kinds)) {
            kind.refresh(&now, b, near, candidates, list);
        }
        if let Some(periodic) = &model.periodic {
            let close = |c: &&ImageName| {
                let (p, q) = (&own[c.i as usize], &spheres(c.block)[c.j as usize]);
                let between = xyz(p) - xyz(q) - periodic.image_offset(&c.shift);
                reach::spheres(V3::from_vec(&between), (p[3], q[3]), near)
            };
            cross::merge(&mut cross.images, c.images.iter().filter(close).copied());
        }
    };
    let within = |(b, (lists, c)): (usize, (&mut BlockLists, &mut Candidates))| {
        let BlockLists { pairs, planes: plane_pairs, walls: wall_pairs, surface: surface_pairs, .. } = lists;
        let own = spheres(b as u32);
        let mut merging = pool.take();
        let close = |c: &[u32; 2]| {
            let (p, q) = (&own[c[0] as usize], &own[c[1] as usize]);
            reach::spheres(V3::from_vec(&(xyz(p) - xyz(q))), (p[3], q[3]), near)
        };
        merging.two.merge(pairs, c.pairs.iter().map(|c| c.map(u32::from)), close);
        let close = |c: &[u32; 2]| {
            let plane = &model.planes[c[1] as usize];
            let (p, offset) = (&own[c[0] as usize], planes[c[1] as usize].offset);
            let (from, normal) = (xyz(p) - plane.point - offset, V3::from_vec(&plane.normal));
            !planes[c[1] as usize].open && reach::plane(V3::from_vec(&from), normal, p[3], near)
        };
        merging.two.merge(plane_pairs, c.planes.iter().copied(), close);
        pool.give_back(merging);
        let reach = (near, approach);
        let (wall_pairs, surface_pairs) = (&mut wall_pairs.pairs, &mut surface_pairs.pairs);
        match &model.images {
            None => {
                patches::refresh(&walls, own, reach, &c.walls, &mut c.patches, wall_pairs);
                patches::refresh(surface, own, reach, &c.surface, &mut c.patches, surface_pairs);
            }
            Some(images) => {
                let walls = Repeated { surface: &walls, images };
                patches::refresh(&walls, own, reach, &c.walls, &mut c.patches, wall_pairs);
                let surface = Repeated { surface, images };
                patches::refresh(&surface, own, reach, &c.surface, &mut c.patches, surface_pairs);
            }
        }
    };
    if *parallel {
        let candidates = works.par_iter().map(|w| &w.candidates);
        cross.par_iter_mut().zip(candidates).enumerate().with_max_len(1).for_each(between);
        let candidates = works.par_iter_mut().map(|w| &mut w.candidates);
        lists.par_iter_mut().zip(candidates).enumerate().with_max_len(1).for_each(within);
    } else {
        cross.iter_mut().zip(works.iter().map(|w| &w.candidates)).enumerate().for_each(between);
        lists.iter_mut().zip(works.iter_mut().map(|w| &mut w.candidates)).enumerate().for_each(within);
    }
    // Rarely used: memory is released.
    work.merging.clear();
    link(model, state, work);
}
