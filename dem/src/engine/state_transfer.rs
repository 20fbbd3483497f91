//! Transfer of a bed to another model, with motion and contact history.

use super::block_layout::{self, BodyState};
use super::bonds;
use super::model::Model;
use super::reordering::{BodyChanges, PreviousLists, SphereMap, reorder, sort};
use super::state::State;
use crate::base::Vec3;
use crate::bodies::block::Rotation;
use crate::contact::narrow_phase::KINDS;
use crate::lanes::vec4::{set_xyz, xyz};
use std::collections::BTreeMap;

impl State {
    /// Copies the first `count` bodies from the state `other` of a model with identical shapes, sizes and
    /// bonds, with motion and mutual history. Call it before creating a [`Work`](crate::Work), and
    /// [`State::restore_history`] after contact detection.
    ///
    /// # Errors
    /// Index of the first missing or different body.
    pub fn transfer_bodies(&mut self, model: &Model, other: &State, count: usize) -> Result<(), usize> {
        let known = count.min(self.places.len()).min(other.places.len());
        let same = |k: &usize| *k < known && (!other.present(*k) || other.size(*k) == model.body(*k).radius);
        if let Some(k) = (0..count).find(|k| !same(k)) {
            return Err(k);
        }
        let come: BTreeMap<u32, BodyState> = (0..count)
            .filter(|&k| other.present(k))
            .map(|k| (k as u32, self.row_of(model, k, other)))
            .collect();
        let stays = (0..self.places.len()).map(|k| k >= count && self.present(k)).collect();
        let changes = BodyChanges { stays, come };
        let positions = changes.positions(self);
        bonds::extract_bonds(self);
        reorder(self, model, &positions, &changes);
        bonds::insert_bonds(model, self, bonds::extract_bonds(&mut other.clone()));
        (self.bonds.broken, self.bonds.fresh) = (other.bonds.broken, other.bonds.fresh);
        self.bonds.power = other.bonds.power;
        self.step_size.last = other.step_size.last;
        self.restore_history(model, other, count);
        Ok(())
    }

    /// Restores the mutual contact history of carried bodies; contact detection takes a step.
    pub fn restore_history(&mut self, model: &Model, other: &State, count: usize) {
        for (b, block) in self.blocks.iter().enumerate() {
            let (fresh, cross) = block_layout::lists(model, block);
            self.lists[b].pairs = fresh.pairs;
            let found = std::mem::replace(&mut self.cross[b], cross);
            let kinds = KINDS.iter().zip(found.kinds).zip(&mut self.cross[b].kinds);
            kinds.filter(|((kind, _), _)| !kind.of_bodies()).for_each(|((_, found), own)| *own = found);
        }
        let carried: Vec<bool> = (0..other.places.len()).map(|k| k < count && other.present(k)).collect();
        let State { blocks, lists, cross, .. } = other.clone();
        let old = PreviousLists { blocks, lists, cross };
        let members = |b: u32| if (b as usize) < count { model.member_count(b as usize) } else { 0 };
        let names = SphereMap::new(self, model, &old, members, &carried);
        old.pairs(&names, self);
        if model.periodic.is_some() {
            old.images(&names, self);
        }
        if model.solids {
            old.kinds(&names, self, true);
        }
        sort(self);
    }

    fn size(&self, body: usize) -> f64 {
        let [b, k] = self.places[body];
        self.blocks[b as usize].centre[k as usize].0[3]
    }

    fn row_of(&self, model: &Model, body: usize, other: &State) -> BodyState {
        let [b, k] = other.places[body].map(|n| n as usize);
        let from = &other.blocks[b];
        let unturned = || Rotation { orientation: model.bodies.orientation(body), momentum: Vec3::zeros() };
        let rotation = from.rotation.get(k).copied().unwrap_or_else(unturned);
        let mut row = BodyState::at_rest(model, body, &xyz(&from.centre[k]), rotation);
        let given = model.body(body).fixed != 0;
        let (velocity, spin) = match given && self.present(body) {
            true => (self.velocity(body), self.spin(body)),
            false => (xyz(&from.velocity[k]), xyz(&from.spin[k])),
        };
        set_xyz(&mut row.velocity, &velocity);
        set_xyz(&mut row.spin, &spin);
        // Another density changes angular momentum at the same angular velocity.
        let ratio = from.velocity[k].0[3] / row.velocity.0[3];
        if ratio.is_finite() {
            row.rotation.momentum *= ratio;
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::input::BodyInput;
    use crate::engine::work::Work;
    use crate::shape::plane::Plane;
    use crate::spatial::surface::NoSurface;
    use crate::testing::{SOFT, dumbbells, push, shaft};

    #[test]
    fn bed_continues_in_another_model() {
        let mut input = dumbbells(SOFT, [0.09, 0.09, 0.01]);
        input.planes = shaft(0.2, &[Vec3::x(), Vec3::y()]);
        input.materials.push(crate::Material { friction: 0.0, ..input.materials[0] });
        input.planes.iter_mut().for_each(|p| p.material = input.materials.len() - 1);
        for k in 0..600_usize {
            let cell = Vec3::new((k % 7) as f64 + 0.5, (k / 7 % 7) as f64 + 0.5, (k / 49) as f64 + 0.6);
            let (position, velocity) = (cell * 0.028, push(k) * 0.5);
            input.bodies.push(BodyInput { shape: k % 2, position, velocity, ..BodyInput::default() });
        }
        let count = input.bodies.len();
        let model = Model::new(input.clone()).unwrap();
        let far = Vec3::new(0.0, 0.0, -40.0);
        input.planes.insert(0, Plane { point: far, normal: Vec3::z(), material: 0, velocity: Vec3::zeros() });
        input.bodies.push(BodyInput { position: Vec3::new(0.1, 0.1, 30.0), ..BodyInput::default() });
        let other = Model::new(input).unwrap();
        let advance = |model: &Model, state: &mut State, steps: u64| {
            let mut work = Work::new(model, state);
            for _ in 0..steps {
                crate::step(model, state, &mut work, &NoSurface, &[]).unwrap();
            }
        };
        let mut state = State::new(&model);
        advance(&model, &mut state, 12_000);
        let mut carried = State::new(&other);
        carried.transfer_bodies(&other, &state, count).unwrap();
        // Undo the probe's changes of contact history.
        let mut work = Work::new(&other, &carried);
        crate::find_contacts(&other, &mut carried, &mut work, &NoSurface).unwrap();
        carried.restore_history(&other, &state, count);
        let mut forgotten = carried.clone();
        reorder(
            &mut forgotten,
            &other,
            &(0..=count).map(|k| carried.position(k)).collect::<Vec<_>>(),
            &BodyChanges {
                stays: vec![false; count + 1],
                come: (0..=count as u32).map(|k| (k, carried.row_of(&other, k as usize, &carried))).collect(),
            },
        );
        advance(&model, &mut state, 400);
        advance(&other, &mut carried, 400);
        advance(&other, &mut forgotten, 400);
        let apart =
            |a: &State| (0..count).map(|k| (a.position(k) - state.position(k)).norm()).fold(0.0, f64::max);
        let (same, not) = (apart(&carried), apart(&forgotten));
        println!("carried: apart by {same:.1e} m after 400 steps; without memory by {not:.1e} m");
        assert!(same < 1e-9 && not > 1e-7, "{same:.1e} {not:.1e}");
        let mut wrong = State::new(&other);
        assert_eq!(wrong.transfer_bodies(&other, &State::new(&other), count + 2), Err(count + 1));
    }
}
