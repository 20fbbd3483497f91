//! CPU part of a step with a back end for spheres.

use super::block_work::BlockWork;
use super::model::Model;
use super::state::{BlockLists, State};
use super::work::Work;
use super::{applied, broad_phase, step};
use crate::base::balance_terms::BalanceTerms;
use crate::bodies::block_slice::BlockSlice;
use crate::bodies::sums::ForceTorque;
use crate::contact::dispatch;
use crate::contact::narrow_phase;
use crate::contact::scalar::StepContext;
use crate::integrate::leapfrog;
use crate::pairs::cross::{Cross, CrossForces, Slots};
use crate::pairs::list::PairList;
use crate::pairs::patches::PatchList;
use crate::spatial::surface::Surface;
use rayon::prelude::*;

pub(crate) fn any(model: &Model) -> bool {
    model.solids || model.surface_material.is_some() || walls(model)
}

pub(crate) fn walls(model: &Model) -> bool {
    !model.walls.triangulated() || model.walls.walls.iter().any(|w| w.servo.is_some())
}

/// Resets block totals. The neighbour list must be valid.
pub(crate) fn forces<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    let setting = StepContext { laws: &model.laws, simd: work.simd, dt: state.step_size.kick() };
    let travel_since_search = state.max_travel + state.wall_travel;
    let State { blocks, lists, cross, planes, scars, walls: moved, .. } = &mut *state;
    let (blocks, planes) = (&blocks[..], &planes[..]);
    let Work { members, blocks: works, cross: slots, walls: standing, sheet, parallel, .. } = work;
    let members = &members[..];
    let bodies = (BlockSlice { first: 0, list: blocks }, BlockSlice { first: 0, list: members });
    let now = broad_phase::block_configuration(model, bodies, planes, (standing, sheet), scars);
    let placed = walls(model).then(|| model.walls.placed(moved));
    let between = |(b, (pairs, out)): (usize, (&mut Cross, &mut CrossForces))| {
        out.clear_totals();
        narrow_phase::forces(&setting, &now, b, pairs, out);
    };
    let own = |(b, (list, w)): (usize, (&mut BlockLists, &mut BlockWork))| {
        w.totals.balance = BalanceTerms::default();
        w.totals.failure = None;
        w.patches.contacts.clear();
        let bodies = (&blocks[b], &members[b]);
        if placed.is_some() || !list.surface.is_empty() {
            w.totals.sums.clear();
            w.totals.sums.resize(blocks[b].bodies.len(), ForceTorque::default());
        }
        if let Some(walls) = &placed {
            w.patches.wall_sums.clear();
            w.patches.aside.clear();
            if !list.walls.is_empty() {
                step::on_walls(model, &setting, (walls, travel_since_search), &mut list.walls, bodies, w);
                w.patches.set_aside(&mut w.totals);
            }
        }
        if !list.surface.is_empty() {
            step::on_surface(model, &setting, (surface, travel_since_search), &mut list.surface, bodies, w);
        }
    };
    if *parallel {
        cross.par_iter_mut().zip(slots).enumerate().for_each(between);
        lists.par_iter_mut().zip(works).enumerate().for_each(own);
    } else {
        cross.iter_mut().zip(slots).enumerate().for_each(between);
        lists.iter_mut().zip(works).enumerate().for_each(own);
    }
}

/// Contact history before a step, for repeating it.
#[derive(Debug, Default)]
pub(crate) struct SavedHistory {
    blocks: Vec<SavedBlockHistory>,
}

#[derive(Debug, Default)]
struct SavedBlockHistory {
    kinds: Vec<PairList>,
    /// Walls, external surface.
    patches: [PatchList; 2],
}

impl SavedHistory {
    pub fn keep(&mut self, state: &State) {
        self.blocks.resize_with(state.blocks.len(), SavedBlockHistory::default);
        for (kept, (cross, lists)) in self.blocks.iter_mut().zip(state.cross.iter().zip(&state.lists)) {
            copy_kinds(&mut kept.kinds, &cross.kinds);
            let [walls, surface] = &mut kept.patches;
            walls.copy_from(&lists.walls);
            surface.copy_from(&lists.surface);
        }
    }

    pub fn restore(&self, state: &mut State) {
        for (kept, (cross, lists)) in self.blocks.iter().zip(state.cross.iter_mut().zip(&mut state.lists)) {
            copy_kinds(&mut cross.kinds, &kept.kinds);
            let [walls, surface] = &kept.patches;
            lists.walls.copy_from(walls);
            lists.surface.copy_from(surface);
        }
    }
}

fn copy_kinds(to: &mut Vec<PairList>, from: &[PairList]) {
    to.resize_with(from.len(), PairList::default);
    to.iter_mut().zip(from).for_each(|(to, from)| to.copy_from(from));
}

pub(crate) fn motion(model: &Model, state: &mut State, work: &mut Work) {
    let drive = step::drive(model, state.step_size);
    let Work { members, blocks: works, cross, applied, simd, .. } = work;
    let slots = Slots { own: BlockSlice { first: 0, list: &cross[..] }, beyond: &[] };
    let blocks = state.blocks.iter_mut().zip(members).zip(works).enumerate();
    for (b, ((block, members), w)) in blocks.filter(|(_, ((_, members), _))| members.solid()) {
        let totals = &mut w.totals;
        totals.sums.clear();
        totals.sums.resize(block.bodies.len(), ForceTorque::default());
        dispatch::gather(*simd, &w.shares, &mut totals.sums, slots);
        leapfrog::advance(*simd, &drive, block, members, totals, applied::of_block(applied, b));
    }
}
