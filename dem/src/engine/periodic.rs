//! Periodic wrapping of bodies (`spatial/periodic.rs`).

use super::model::Model;
use super::pieces::components;
use super::state::State;
use crate::base::Vec3;
use crate::lanes::vec4::{set_xyz, xyz};
use crate::pairs::cross::{ImageName, ImagePair};
use crate::spatial::periodic::{NONE, Periodic, Turns};

pub(crate) fn wrap(periodic: &Periodic, model: &Model, state: &mut State) {
    let mut moved = false;
    let mut turns: Vec<Vec<Turns>> = Vec::with_capacity(state.blocks.len());
    let bonded = of_pieces(periodic, model, state);
    for block in &mut state.blocks {
        let mut own = Vec::new();
        for (k, &body) in block.bodies.iter().enumerate() {
            let alone = || periodic.turns(&xyz(&block.centre[k]));
            let t = bonded.get(body as usize).copied().unwrap_or_else(alone);
            own.extend((0..model.member_count(body as usize)).map(|_| t));
            if t == NONE {
                continue;
            }
            moved = true;
            let (way, mass) = (periodic.image_offset(&t), model.mass(body as usize));
            let back = xyz(&block.centre[k]) - way;
            set_xyz(&mut block.centre[k], &back);
            state.balance.periodic.angular -= way.cross(&(xyz(&block.velocity[k]) * mass));
            state.balance.work_periodic += mass * model.gravity.dot(&way);
        }
        turns.push(own);
    }
    if !moved {
        return;
    }
    if let Some(images) = &model.images {
        for (lists, turns) in state.lists.iter_mut().zip(&turns) {
            for list in [&mut lists.walls, &mut lists.surface] {
                images.wrap(list, turns, |t| periodic.image_offset(t));
            }
        }
    }
    for b in 0..state.blocks.len() {
        let shift = |i: u32, block: u32, j: u32, before: &Turns| -> Turns {
            let (ti, tj) = (&turns[b][i as usize], &turns[block as usize][j as usize]);
            std::array::from_fn(|d| before[d] + tj[d] - ti[d])
        };
        let own = b as u32;
        let (pairs, cross) = (&mut state.lists[b].pairs, &mut state.cross[b]);
        let mut all: Vec<ImagePair> = Vec::new();
        let mut add = |i, block, j, before: &Turns, history| {
            all.push(ImagePair {
                name: ImageName { i, block, j, shift: shift(i, block, j, before) },
                history,
            });
        };
        pairs.iter().for_each(|([i, j], history)| add(i, own, j, &NONE, history));
        cross.spheres.iter().for_each(|([i, block, j], history)| add(i, block, j, &NONE, history));
        cross.images.iter().for_each(|p| add(p.name.i, p.name.block, p.name.j, &p.name.shift, p.history));
        pairs.clear();
        cross.spheres.clear();
        cross.images.clear();
        all.sort_unstable_by_key(|p| p.name);
        for pair in all {
            let ImageName { i, block, j, shift } = pair.name;
            if shift != NONE {
                cross.images.push(pair);
            } else if block == own {
                pairs.push([i, j], &pair.history);
            } else {
                cross.spheres.push([i, block, j], &pair.history);
            }
        }
    }
}

/// Box lengths of each body to the box if bonds join bodies, which move with the middle of their piece; else empty.
fn of_pieces(periodic: &Periodic, model: &Model, state: &State) -> Vec<Turns> {
    if model.bonds.is_empty() {
        return Vec::new();
    }
    let mut pairs = Vec::new();
    let mut join = |number: u32| pairs.push(model.bonds[number as usize].ends);
    state.each_bond(|number, _| join(number));
    state.each_debonded(|_, r| join(r.number));
    let of = components(model.body_count(), pairs);
    let mut middles = vec![(Vec3::zeros(), 0.0); of.len()];
    for (body, piece) in of.iter().enumerate() {
        let (sum, count) = &mut middles[*piece as usize];
        (*sum, *count) = (*sum + state.position(body), *count + 1.0);
    }
    of.iter()
        .map(|piece| middles[*piece as usize])
        .map(|(sum, count)| periodic.turns(&(sum / count)))
        .collect()
}

impl Model {
    /// Wraps a point along periodic axes, upper boundaries excluded [m]; [`State`] positions may be
    /// unwrapped.
    pub fn wrap(&self, x: &Vec3) -> Vec3 {
        self.periodic.map_or(*x, |p| p.wrap(x))
    }

    /// Lower and upper periodic boundary [m] of each axis.
    pub fn periodic(&self) -> [Option<[f64; 2]>; 3] {
        std::array::from_fn(|d| {
            let p = self.periodic.filter(|p| p.length[d] > 0.0)?;
            Some([p.low[d], p.low[d] + p.length[d]])
        })
    }
}

#[cfg(test)]
#[path = "periodic_tests.rs"]
mod tests;
