//! Spatial re-sorting of bodies, contacts and bonds.

use super::block_layout::{self, BodyState};
use super::bonds;
use super::model::Model;
use super::state::{BlockLists, State};
use crate::base::Vec3;
use crate::bodies::block::{Block, Rotation};
use crate::contact::narrow_phase::{KINDS, Renumbering};
use crate::lanes::vec4::xyz;
use crate::law::History;
use crate::pairs::cross::{Cross, ImageName, ImagePair};
use crate::pairs::list::PairList;
use crate::pairs::patches::{PatchContact, PatchList, PatchPair};
use std::collections::BTreeMap;

/// Steps between two sortings.
pub(crate) const EVERY: u64 = 5000;

/// Bodies present after re-sorting.
pub(crate) struct BodyChanges {
    /// Remaining bodies. Shape `[bodies]`.
    pub stays: Vec<bool>,
    /// Inserted bodies; removed ones may be re-inserted.
    pub come: BTreeMap<u32, BodyState>,
}

impl BodyChanges {
    pub fn none(state: &State) -> BodyChanges {
        BodyChanges {
            stays: (0..state.places.len()).map(|b| state.present(b)).collect(),
            come: BTreeMap::new(),
        }
    }

    /// Positions [m], zero if absent. Shape `[bodies]`.
    pub fn positions(&self, state: &State) -> Vec<Vec3> {
        let of = |b: usize| match self.come.get(&(b as u32)) {
            Some(row) => xyz(&row.centre),
            None if self.stays[b] => state.position(b),
            None => Vec3::zeros(),
        };
        (0..self.stays.len()).map(of).collect()
    }
}

pub(crate) fn reorder(state: &mut State, model: &Model, positions: &[Vec3], changes: &BodyChanges) {
    let BodyChanges { stays, come } = changes;
    let present = |b: usize| stays[b] || come.contains_key(&(b as u32));
    let bonds = bonds::extract_bonds(state);
    let old_places = state.places.clone();
    let old = PreviousLists {
        blocks: std::mem::take(&mut state.blocks),
        lists: std::mem::take(&mut state.lists),
        cross: std::mem::take(&mut state.cross),
    };
    for bodies in block_layout::blocks(model, positions, present) {
        let block = block_layout::block(model, bodies, |body| match come.get(&body) {
            Some(row) => *row,
            None => {
                let [b, k] = old_places[body as usize];
                old.row(model, body as usize, b as usize, k as usize)
            }
        });
        let (lists, cross) = block_layout::lists(model, &block);
        state.blocks.push(block);
        state.lists.push(lists);
        state.cross.push(cross);
    }
    state.number(model);
    bonds::insert_bonds(model, state, bonds);

    let names = SphereMap::new(state, model, &old, |b| model.member_count(b as usize), stays);
    old.pairs(&names, state);
    old.images(&names, state);
    old.kinds(&names, state, false);
    old.walls(&names, state);
    sort(state);
}

pub(super) fn sort(state: &mut State) {
    for lists in &mut state.lists {
        lists.pairs.sort();
        lists.planes.sort();
        for list in [&mut lists.walls, &mut lists.surface] {
            list.pairs.sort_unstable_by_key(|p| (p.i, p.patch));
            list.live.sort_unstable_by_key(|p| (p.i, p.patch));
        }
    }
    for cross in &mut state.cross {
        cross.spheres.sort();
        cross.kinds.iter_mut().for_each(PairList::sort);
        cross.images.sort_unstable_by_key(|p| p.name);
    }
    state.stale = true;
}

pub(super) struct PreviousLists {
    pub blocks: Vec<Block>,
    pub lists: Vec<BlockLists>,
    pub cross: Vec<Cross>,
}

pub(super) struct SphereMap<'a> {
    /// Body and member of each sphere, by old block.
    old: Vec<Vec<[u32; 2]>>,
    stays: &'a [bool],
    /// New block, slot, first sphere of each body.
    places: Vec<[u32; 2]>,
    first: Vec<u32>,
}

impl<'a> SphereMap<'a> {
    pub fn new(
        state: &State,
        model: &Model,
        old: &PreviousLists,
        members: impl Fn(u32) -> u32,
        stays: &'a [bool],
    ) -> SphereMap<'a> {
        let members = &members;
        let spheres = |block: &Block| -> Vec<[u32; 2]> {
            block.bodies.iter().flat_map(|&b| (0..members(b)).map(move |m| [b, m])).collect()
        };
        let mut first = vec![0_u32; state.places.len()];
        for block in &state.blocks {
            let mut next = 0;
            for &b in &block.bodies {
                first[b as usize] = next;
                next += model.member_count(b as usize);
            }
        }
        let old = old.blocks.iter().map(spheres).collect();
        SphereMap { old, stays, places: state.places.clone(), first }
    }

    /// `None` if the body is removed.
    fn sphere(&self, block: usize, sphere: u32) -> Option<(u32, u32)> {
        let [body, member] = self.old[block][sphere as usize].map(|n| n as usize);
        self.stays[body].then(|| (self.places[body][0], self.first[body] + member as u32))
    }
}

struct BodyMap<'a> {
    names: &'a SphereMap<'a>,
    old: &'a [Block],
}

impl Renumbering for BodyMap<'_> {
    fn sphere(&self, block: usize, sphere: u32) -> Option<[u32; 2]> {
        self.names.sphere(block, sphere).map(|(block, sphere)| [block, sphere])
    }

    fn body(&self, block: usize, place: u32) -> Option<[u32; 2]> {
        let body = self.old[block].bodies[place as usize] as usize;
        self.names.stays[body].then(|| self.names.places[body])
    }
}

impl PreviousLists {
    fn row(&self, model: &Model, body: usize, b: usize, k: usize) -> BodyState {
        let from = &self.blocks[b];
        let unturned = || Rotation { orientation: model.bodies.orientation(body), momentum: Vec3::zeros() };
        BodyState {
            centre: from.centre[k],
            velocity: from.velocity[k],
            spin: from.spin[k],
            rotation: from.rotation.get(k).copied().unwrap_or_else(unturned),
        }
    }

    pub fn pairs(&self, names: &SphereMap<'_>, state: &mut State) {
        let mut file = |a: Option<(u32, u32)>, b: Option<(u32, u32)>, history: History| {
            let (Some(a), Some(b)) = (a, b) else { return };
            let turned = history.turned();
            let (a, b, history) = if a <= b { (a, b, history) } else { (b, a, turned) };
            if a.0 == b.0 {
                state.lists[a.0 as usize].pairs.push([a.1, b.1], &history);
            } else {
                state.cross[a.0 as usize].spheres.push([a.1, b.0, b.1], &history);
            }
        };
        for (b, lists) in self.lists.iter().enumerate() {
            for ([i, j], history) in lists.pairs.iter() {
                file(names.sphere(b, i), names.sphere(b, j), history);
            }
        }
        for (b, cross) in self.cross.iter().enumerate() {
            for ([i, block, j], history) in cross.spheres.iter() {
                file(names.sphere(b, i), names.sphere(block as usize, j), history);
            }
        }
    }

    pub fn images(&self, names: &SphereMap<'_>, state: &mut State) {
        for (b, cross) in self.cross.iter().enumerate() {
            for &ImagePair { name, history } in &cross.images {
                let (x, y) = (names.sphere(b, name.i), names.sphere(name.block as usize, name.j));
                let (Some(x), Some(y)) = (x, y) else { continue };
                let turned = (name.shift.map(|s| -s), history.turned());
                let (x, y, (shift, history)) =
                    if x <= y { (x, y, (name.shift, history)) } else { (y, x, turned) };
                let name = ImageName { i: x.1, block: y.0, j: y.1, shift };
                state.cross[x.0 as usize].images.push(ImagePair { name, history });
            }
        }
    }

    pub fn kinds(&self, names: &SphereMap<'_>, state: &mut State, bodies: bool) {
        let names = BodyMap { names, old: &self.blocks };
        for (b, cross) in self.cross.iter().enumerate() {
            let kinds = KINDS.iter().zip(&cross.kinds).enumerate();
            for (k, (kind, list)) in kinds.filter(|(_, (kind, _))| !bodies || kind.of_bodies()) {
                kind.renumber(&names, b, list, &mut |block, name, points| {
                    state.cross[block].kinds[k].push(name, points);
                });
            }
        }
    }

    fn walls(&self, names: &SphereMap<'_>, state: &mut State) {
        for (b, lists) in self.lists.iter().enumerate() {
            for ([i, plane], history) in lists.planes.iter() {
                let Some((block, i)) = names.sphere(b, i) else { continue };
                state.lists[block as usize].planes.push([i, plane], &history);
            }
            let mut carry = |from: &PatchList, pick: fn(&mut BlockLists) -> &mut PatchList| {
                for p in &from.live {
                    let Some((block, i)) = names.sphere(b, p.i) else { continue };
                    pick(&mut state.lists[block as usize]).live.push(PatchContact { i, ..*p });
                }
                for p in &from.pairs {
                    let Some((block, i)) = names.sphere(b, p.i) else { continue };
                    pick(&mut state.lists[block as usize]).pairs.push(PatchPair { i, ..*p });
                }
            };
            carry(&lists.walls, |l| &mut l.walls);
            carry(&lists.surface, |l| &mut l.surface);
        }
    }
}

impl State {
    /// Re-sorts every [`EVERY`] steps; counting makes restarts reproducible.
    pub(crate) fn reorder(&mut self, model: &Model) {
        if let Some(periodic) = &model.periodic {
            super::periodic::wrap(periodic, model, self);
        }
        let all = BodyChanges::none(self);
        let positions = all.positions(self);
        reorder(self, model, &positions, &all);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Partner;
    use crate::bodies::input::BodyInput;
    use crate::engine::work::Work;
    use crate::measure;
    use crate::spatial::surface::NoSurface;
    use crate::testing::{SOFT, dumbbells, push, shaft};

    #[test]
    fn contacts_survive_a_new_order() {
        let mut input = dumbbells(SOFT, [0.09, 0.09, 0.01]);
        input.planes = shaft(0.2, &[Vec3::x(), Vec3::y()]);
        for k in 0..1500_usize {
            let cell = Vec3::new((k % 7) as f64 + 0.5, (k / 7 % 7) as f64 + 0.5, (k / 49) as f64 + 0.6);
            let (position, velocity) = (cell * 0.028, push(k) * 0.5);
            input.bodies.push(BodyInput { shape: k % 2, position, velocity, ..BodyInput::default() });
        }
        let position = Vec3::new(0.1, 0.1, 0.9);
        input.bodies.push(BodyInput { shape: 2, position, ..BodyInput::default() });
        let model = Model::new(input).unwrap();
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        assert!(state.blocks.len() > 2);
        while state.steps < 3 * EVERY {
            crate::step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
        }
        // Oriented from the lower body index.
        let forces = |state: &State| {
            let mut swapped = 0;
            let mut list: Vec<_> = measure::contacts(&model, state)
                .iter()
                .map(|c| match c.b {
                    Partner::Body(b) if b < c.a => {
                        swapped += 1;
                        ((b, c.a, 0), -c.force)
                    }
                    Partner::Body(b) => ((c.a, b, 0), c.force),
                    Partner::Plane(p) => ((c.a, 0, p + 1), c.force),
                    _ => ((c.a, 0, 0), c.force),
                })
                .collect();
            list.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.norm().total_cmp(&y.1.norm())));
            (list, swapped)
        };
        let (before, first) = forces(&state);
        state.reorder(&model);
        let (after, second) = forces(&state);
        assert!(before.len() > 200 && first != second, "{} {first} {second}", before.len());
        assert_eq!(before.len(), after.len());
        for (x, y) in before.iter().zip(&after) {
            assert_eq!(x.0, y.0);
            assert!((x.1 - y.1).norm() < 1e-9 * (1.0 + x.1.norm()), "{x:?} {y:?}");
        }
    }
}
