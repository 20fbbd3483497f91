//! The near list: candidates that touch or are within a small reach of it, with the memory of their contacts.
//!
//! It is made from the candidates whenever motion may have used its reach up, by a bound on the speeds; the
//! candidates themselves are searched anew when true displacements no longer leave room for the near list's
//! reach. Pairs are kept in the order of their spheres, and pairs that do not touch add nothing to any sum, so
//! neither the skin nor the reach nor the moment of a search changes a bit of the result.

use crate::contact::groups::Groups;
use crate::law::History;
use crate::model::Model;
use crate::periodic;
use crate::search::candidates::{self, spheres};
use crate::search::patches;
use crate::shape::cuboid;
use crate::state::{Block, Cross, ImageName, ImagePair, Lanes, State, xyz};
use crate::surface::Surface;
use crate::work::{BlockWork, Gather, Work};
use rayon::prelude::*;

/// Makes the near list anew when it is due. `surface_speed` is the bound of the external surface [m/s].
pub(crate) fn update<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    let due = (2.0 * state.drift).max(state.drift + state.wall_drift) > state.near;
    if !due && !state.stale {
        return;
    }
    if due {
        // A reach that lasts for some ten steps costs least.
        if state.lasted < 6 {
            state.near = (1.5 * state.near).min(0.5 * model.skin);
        } else if state.lasted > 40 {
            state.near = (state.near / 1.2).max(0.02 * model.skin);
        }
    }
    work.surface_drift += state.wall_drift;
    let mut approach = if state.stale || !work.listed { f64::INFINITY } else { approach(model, state, work) };
    if approach + state.near > model.skin {
        candidates::search(model, state, work, surface);
        approach = 0.0;
    }
    make(model, state, work, surface, approach);
    state.drift = 0.0;
    state.wall_drift = 0.0;
    state.lasted = 0;
    state.stale = false;
    work.refreshes += 1;
}

/// A bound on the way that any two partners have come together since the candidates were found [m].
fn approach(model: &Model, state: &State, work: &Work) -> f64 {
    let moved2 = state.blocks.iter().zip(&work.blocks).map(|(block, w)| {
        let own = spheres(block, w, model.rigid);
        let moved = own[..w.count].iter().enumerate().map(|(k, p)| w.reference.moved2(k, &xyz(p)));
        let mut most = moved.fold(0.0, f64::max);
        let boxes = (w.reference.len() - w.count) / 8;
        for k in 0..boxes {
            let (x, q) = (xyz(&block.centre[k]), &block.rotation[k].orientation);
            for c in 0..8 {
                let now = x + q * cuboid::corner(&w.half[k], c);
                most = most.max(w.reference.moved2(w.count + 8 * k + c, &now));
            }
        }
        most
    });
    let moved = moved2.fold(0.0, f64::max).sqrt();
    let walls = state.planes.iter().zip(&work.wall_reference);
    let wall = walls.map(|(m, x)| (m.offset - x).norm()).fold(work.surface_drift, f64::max);
    let wall = wall.max(crate::wall::advance::way(model, state, &work.wall_places));
    (2.0 * moved).max(moved + wall)
}

fn make<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S, approach: f64) {
    let State { blocks, cross, planes, walls: wall_states, near, .. } = &mut *state;
    let (near, planes, wall_states) = (*near, &*planes, &*wall_states);
    let (parallel, pool) = (work.parallel, &work.merging);

    // Contacts between blocks read positions of other blocks, so they come first and only read them.
    let (all, scratch) = (&*blocks, &work.blocks);
    let between = |(b, cross): (usize, &mut Cross)| {
        let mut merging = pool.take();
        let own = spheres(&all[b], &scratch[b], model.rigid);
        let close = |c: &[u32; 3]| {
            let p = &own[c[0] as usize];
            let q = &spheres(&all[c[1] as usize], &scratch[c[1] as usize], model.rigid)[c[2] as usize];
            let reach = p[3] + q[3] + near;
            (xyz(p) - xyz(q)).norm_squared() < reach * reach
        };
        merging.three.merge(&mut cross.spheres, scratch[b].cross.iter().copied(), close);
        let close = |c: &[u32; 3]| {
            let p = &own[c[0] as usize];
            let (block, k) = (&all[c[1] as usize], c[2] as usize);
            let local =
                block.rotation[k].orientation.inverse_transform_vector(&(xyz(p) - xyz(&block.centre[k])));
            cuboid::closest_point(&scratch[c[1] as usize].half[k], &local).2 < p[3] + near
        };
        merging.three.merge(&mut cross.boxes, scratch[b].boxed.iter().copied(), close);
        pool.give_back(merging);
        if let Some(periodic) = &model.periodic {
            let close = |c: &&ImageName| {
                let p = &own[c.i as usize];
                let other = c.block as usize;
                let q = &spheres(&all[other], &scratch[other], model.rigid)[c.j as usize];
                let reach = p[3] + q[3] + near;
                (xyz(p) - xyz(q) - periodic.way(&c.shift)).norm_squared() < reach * reach
            };
            periodic::merge(&mut cross.images, scratch[b].images.iter().filter(close).copied());
        }
    };
    let within = |(block, w): (&mut Block, &mut BlockWork)| {
        let Block { centre, pairs, planes: plane_pairs, walls: wall_pairs, surface: surface_pairs, .. } =
            block;
        let own = if model.rigid { &w.spheres[..] } else { &centre[..] };
        let mut merging = pool.take();
        let close = |c: &[u32; 2]| {
            let (p, q) = (&own[c[0] as usize], &own[c[1] as usize]);
            let reach = p[3] + q[3] + near;
            (xyz(p) - xyz(q)).norm_squared() < reach * reach
        };
        merging.two.merge(pairs, w.candidates.iter().map(|c| c.map(u32::from)), close);
        let close = |c: &[u32; 2]| {
            let plane = &model.planes[c[1] as usize];
            // Corners of boxes have no sphere here and are kept always.
            !planes[c[1] as usize].open
                && own.get(c[0] as usize).is_none_or(|p| {
                    (xyz(p) - plane.point - planes[c[1] as usize].offset).dot(&plane.normal) < p[3] + near
                })
        };
        merging.two.merge(plane_pairs, w.planes.iter().copied(), close);
        pool.give_back(merging);
        let walls = model.walls.placed(wall_states);
        patches::refresh(&walls, own, (near, approach), &w.walls, &mut w.patches, &mut wall_pairs.pairs);
        patches::refresh(
            surface,
            own,
            (near, approach),
            &w.surface,
            &mut w.patches,
            &mut surface_pairs.pairs,
        );
    };
    if parallel {
        cross.par_iter_mut().enumerate().with_max_len(1).for_each(between);
        blocks.par_iter_mut().zip(work.blocks.par_iter_mut()).with_max_len(1).for_each(within);
    } else {
        cross.iter_mut().enumerate().for_each(between);
        blocks.iter_mut().zip(work.blocks.iter_mut()).for_each(within);
    }
    // Lists are made once in some ten steps: not kept.
    work.merging.clear();
    link(state, work);
}

/// Scratch for the near list of a block.
#[derive(Debug, Default)]
pub(crate) struct Merging {
    two: Merge<2>,
    three: Merge<3>,
}

/// Scratch for one list.
#[derive(Debug, Default)]
struct Merge<const N: usize> {
    keys: Vec<[u32; N]>,
    fresh: Groups<N>,
}

impl<const N: usize> Merge<N> {
    /// Replaces a list by those candidates (in ascending order) that are close, keeping the memory of contacts that were
    /// there.
    #[inline]
    fn merge(
        &mut self,
        list: &mut Groups<N>,
        candidates: impl ExactSizeIterator<Item = [u32; N]>,
        close: impl Fn(&[u32; N]) -> bool,
    ) {
        let Merge { keys, fresh } = self;
        // Written always and kept if close: whether it is cannot be foretold.
        keys.clear();
        keys.resize(candidates.len(), [0; N]);
        let mut count = 0;
        for key in candidates {
            keys[count] = key;
            count += usize::from(close(&key));
        }
        keys.truncate(count);
        let old = list.len();
        if count == old && keys.iter().enumerate().all(|(k, key)| list.name(k) == *key) {
            return;
        }
        fresh.clear();
        fresh.turning = list.turning;
        let mut k = 0;
        for key in keys {
            while k < old && list.name(k) < *key {
                k += 1;
            }
            let known = k < old && list.name(k) == *key;
            fresh.push(*key, &if known { list.history(k) } else { History::NONE });
        }
        list.copy_from(fresh);
    }
}

/// Gives each contact between blocks its slot and each body the list of slots it gathers, in one fixed order.
pub(crate) fn link(state: &State, work: &mut Work) {
    let mut counts = vec![0; state.blocks.len()];
    for (b, cross) in state.cross.iter().enumerate() {
        for list in [&cross.spheres, &cross.boxes] {
            counts[b] += list.len();
            (0..list.len()).for_each(|k| counts[list.name(k)[1] as usize] += 1);
        }
        counts[b] += cross.images.len();
        cross.images.iter().for_each(|p| counts[p.name.block as usize] += 1);
    }
    for (w, &count) in work.blocks.iter_mut().zip(&counts) {
        w.gather.clear();
        if w.gather.capacity() < count {
            w.gather = Vec::with_capacity(count);
        }
    }
    for b in 0..state.blocks.len() {
        let (cross, boxed) = (&state.cross[b].spheres, &state.cross[b].boxes);
        let images = &state.cross[b].images;
        let from = cross.len() + boxed.len();
        let (count, slots) = ((from + images.len()) * work.slot_width, &mut work.cross[b].slots);
        slots.clear();
        slots.reserve_exact(count);
        slots.resize(count, Lanes::default());
        for k in 0..from {
            let (block, slot) = (b as u32, k as u32);
            let boxes = k >= cross.len();
            let [i, to, j] = if boxes { boxed.name(k - cross.len()) } else { cross.name(k) };
            let place = work.blocks[b].body(i);
            work.blocks[b].gather.push(Gather::new(place, block, slot, true));
            let other = &mut work.blocks[to as usize];
            let place = if boxes { j } else { other.body(j) };
            other.gather.push(Gather::new(place, block, slot, false));
        }
        for (k, ImagePair { name, .. }) in images.iter().enumerate() {
            let (block, slot) = (b as u32, (from + k) as u32);
            let place = work.blocks[b].body(name.i);
            work.blocks[b].gather.push(Gather::new(place, block, slot, true));
            let other = &mut work.blocks[name.block as usize];
            let place = other.body(name.j);
            other.gather.push(Gather::new(place, block, slot, false));
        }
    }
}
