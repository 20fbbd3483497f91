//! Layout of scratch data: constants in block order, contact slots and gather lists.

use super::block_layout;
use super::model::Model;
use super::state::State;
use super::wall_contacts::WallContacts;
use super::work::{Searched, Work};
use super::{bonds, broad_phase};
use crate::bodies::block_bodies::{BlockBodies, common};
use crate::bond::BondedPairs;
use crate::bond::pass::BondWork;
use crate::contact::narrow_phase::KINDS;
use crate::lanes::Simd;
use crate::pairs::buffers::Buffers;
use crate::pairs::cross::{CrossForces, Gather, ImagePair};

/// Spheres below which threading does not pay.
const PARALLEL: usize = 2500;

impl Work {
    /// Creates scratch data for a state.
    pub fn new(model: &Model, state: &State) -> Work {
        let mut work = Work {
            members: Vec::new(),
            blocks: Vec::new(),
            cross: Vec::new(),
            beyond: Vec::new(),
            bonds: BondWork::default(),
            held: BondedPairs::default(),
            applied: Vec::new(),
            surface_contacts: Vec::new(),
            buffers: Buffers::default(),
            merging: Buffers::default(),
            keep_forces: false,
            searched: Searched::default(),
            simd: Simd::best(),
            planes: Vec::new(),
            wall_contacts: WallContacts::default(),
            walls: Vec::new(),
            sheet: Vec::new(),
            ground: Vec::new(),
            heights: Vec::new(),
            material: None,
            plane_material: common(model.planes.iter().map(|p| p.material as u32)),
            parallel: model.sphere_count() >= PARALLEL,
            own: 0..0,
            halo: Vec::new(),
        };
        work.rebuild_layout(model, state);
        work
    }

    /// Attaches to another state of the same model, with bitwise identical results.
    pub fn follow(&mut self, model: &Model, state: &State) {
        self.rebuild_layout(model, state);
    }

    /// Updates clump spheres.
    pub(crate) fn place_spheres(&mut self, state: &State) {
        let blocks = self.members.iter_mut().zip(&state.blocks);
        for (members, block) in blocks.filter(|(members, _)| members.rigid) {
            for (k, (centre, rotation)) in block.centre.iter().zip(&block.rotation).enumerate() {
                members.place_spheres(k, centre, &rotation.orientation);
            }
        }
    }

    pub(crate) fn rebuild_layout(&mut self, model: &Model, state: &State) {
        self.searched.listed = None;
        self.own = 0..state.blocks.len();
        self.halo.clear();
        self.members.resize_with(state.blocks.len(), BlockBodies::default);
        self.blocks.resize_with(state.blocks.len(), Default::default);
        self.cross.resize_with(state.blocks.len(), CrossForces::default);
        for ((members, w), block) in self.members.iter_mut().zip(&mut self.blocks).zip(&state.blocks) {
            members.arrange(&model.bodies, &model.shapes, block);
            w.totals.sums = Vec::new();
            if model.acts_on_bodies() {
                w.body_forces.arrange(block, |b| model.volume(b));
            }
            w.patches.turning =
                model.laws.rolls_among(&block_layout::materials(block), &model.patch_materials);
        }
        self.material = common(self.members.iter().map(|m| m.material)).flatten();
        link(model, state, self);
        bonds::arrange(model, state, self);
    }
}

/// The order of summation is fixed.
pub(crate) fn link(model: &Model, state: &State, work: &mut Work) {
    let mut counts = vec![0; state.blocks.len()];
    let Work { members, blocks: works, cross: forces, walls, sheet, .. } = work;
    let now = broad_phase::configuration(model, state, members, (walls, sheet));
    for (b, cross) in state.cross.iter().enumerate() {
        counts[b] += cross.spheres.len();
        (0..cross.spheres.len()).for_each(|k| counts[cross.spheres.name(k)[1] as usize] += 1);
        for (kind, list) in KINDS.iter().zip(&cross.kinds) {
            kind.for_each_body(&now, b, list, &mut |_, [block, _], _| counts[block as usize] += 1);
        }
        counts[b] += cross.images.len();
        cross.images.iter().for_each(|p| counts[p.name.block as usize] += 1);
    }
    for (w, &count) in works.iter_mut().zip(&counts) {
        w.shares.list.clear();
        w.shares.wide = false;
        if w.shares.list.capacity() < count {
            w.shares.list = Vec::with_capacity(count);
        }
    }
    for b in 0..state.blocks.len() {
        let cross = &state.cross[b];
        forces[b].lay_out(cross, model.clumps);
        let (width, images_at) = (forces[b].width, forces[b].images_at);
        let mut share = |place: u32, of: usize, slot: (usize, usize), first: bool| {
            works[of].shares.push(Gather::new(place, b as u32, slot, first));
        };
        for k in 0..cross.spheres.len() {
            let ([i, to, j], slot) = (cross.spheres.name(k), (k * width, width));
            share(members[b].body(i), b, slot, true);
            share(members[to as usize].body(j), to as usize, slot, false);
        }
        let mut at = forces[b].kinds_at;
        for (kind, list) in KINDS.iter().zip(&cross.kinds) {
            kind.for_each_body(&now, b, list, &mut |k, [block, place], first| {
                share(place, block as usize, (at + 3 * k, 3), first);
            });
            at += 3 * list.len();
        }
        for (k, ImagePair { name, .. }) in cross.images.iter().enumerate() {
            let (to, slot) = (name.block as usize, (images_at + k * width, width));
            share(members[b].body(name.i), b, slot, true);
            share(members[to].body(name.j), to, slot, false);
        }
    }
}
