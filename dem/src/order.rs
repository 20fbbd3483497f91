//! The order of bodies in memory: blocks of neighbours, and rows within a block.
//!
//! The bodies are halved again and again across the longest side of their bounds, at multiples of the block size,
//! so that every block but the last holds equally many and is about as long as wide. Within a block they lie in
//! the order of cells (z, then y, then x), which the processor's prefetcher likes better than space-filling
//! curves. Boxes come last, in a block of their own. The order sets the order of sums, hence the last bits of a
//! run; it depends on the positions alone.

use crate::Vec3;
use crate::bond;
use crate::law::History;
use crate::model::{Kind, Model};
use crate::state::{
    Block, Cross, ImageName, ImagePair, Lanes, PatchContact, PatchPair, Rotation, State, xyz,
};
use std::collections::BTreeMap;

/// Steps between two sortings.
pub(crate) const EVERY: u64 = 5000;

/// Numbers of the bodies of each block, of those that are `present`; the positions of others do not matter.
pub(crate) fn blocks(model: &Model, positions: &[Vec3], present: impl Fn(usize) -> bool) -> Vec<Vec<u32>> {
    let of_kind = |boxes: bool| -> Vec<u32> {
        (0..positions.len() as u32)
            .filter(|&b| present(b as usize) && (model.bodies.kind(b as usize) == Kind::Box) == boxes)
            .collect()
    };
    let mut round = of_kind(false);
    let mut out = Vec::new();
    if !round.is_empty() {
        let size = round.iter().map(|&b| model.body(b as usize).radius).sum::<f64>() / round.len() as f64;
        halve(&mut round, positions, model.block, 2.0 * size, &mut out);
    }
    let boxes = of_kind(true);
    if !boxes.is_empty() {
        out.push(boxes);
    }
    out
}

fn halve(bodies: &mut [u32], positions: &[Vec3], size: usize, cell: f64, out: &mut Vec<Vec<u32>>) {
    let count = bodies.len().div_ceil(size);
    let at = |b: u32, d: usize| positions[b as usize][d];
    if count <= 1 {
        bodies.sort_by_cached_key(|&b| [2, 1, 0].map(|d| (at(b, d) / cell).floor() as i64));
        out.push(bodies.to_vec());
        return;
    }
    let (lo, hi) =
        bodies.iter().fold((Vec3::repeat(f64::INFINITY), Vec3::repeat(-f64::INFINITY)), |(lo, hi), &b| {
            (lo.inf(&positions[b as usize]), hi.sup(&positions[b as usize]))
        });
    let axis = (hi - lo).imax();
    let middle = count / 2 * size;
    // Ties by number, so that the result does not depend on the order that the bodies come in.
    bodies.sort_unstable_by(|&a, &b| at(a, axis).total_cmp(&at(b, axis)).then(a.cmp(&b)));
    let (left, right) = bodies.split_at_mut(middle);
    halve(left, positions, size, cell, out);
    halve(right, positions, size, cell, out);
}

/// A body on its way in: what its block will hold of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub centre: Lanes,
    pub velocity: Lanes,
    pub spin: Lanes,
    pub rotation: Rotation,
}

/// Who is there after a new order.
pub(crate) struct Turnover {
    /// Whether a body was there and stays. Shape `[bodies]`.
    pub stays: Vec<bool>,
    /// Bodies that come in; those that were there and do not stay may come in anew.
    pub come: BTreeMap<u32, Row>,
}

impl Turnover {
    /// All stay, none comes.
    pub fn none(state: &State) -> Turnover {
        Turnover { stays: (0..state.places.len()).map(|b| state.present(b)).collect(), come: BTreeMap::new() }
    }

    /// Where all those are that will be there [m]; zero for others. Shape `[bodies]`.
    pub fn positions(&self, state: &State) -> Vec<Vec3> {
        let of = |b: usize| match self.come.get(&(b as u32)) {
            Some(row) => xyz(&row.centre),
            None if self.stays[b] => state.position(b),
            None => Vec3::zeros(),
        };
        (0..self.stays.len()).map(of).collect()
    }
}

/// Sorts a state anew by the given positions; contacts go along with their bodies. Those of bodies that do not stay are forgotten.
pub(crate) fn reorder(state: &mut State, model: &Model, positions: &[Vec3], turnover: &Turnover) {
    let Turnover { stays, come } = turnover;
    let present = |b: usize| stays[b] || come.contains_key(&(b as u32));
    let turning = model.laws.rolls();
    let members: Vec<u32> = (0..positions.len()).map(|b| model.member_count(b)).collect();
    let lists: Vec<_> = state.blocks.iter_mut().map(|b| std::mem::take(&mut b.bonds)).collect();
    let bonds = bond::store::take(lists.into_iter(), state);
    let old = std::mem::take(&mut state.blocks);
    let cross = std::mem::take(&mut state.cross);
    let old_places = state.places.clone();

    // Old sphere → body and member.
    let named: Vec<Vec<[u32; 2]>> = old
        .iter()
        .map(|block| {
            block.bodies.iter().flat_map(|&b| (0..members[b as usize]).map(move |m| [b, m])).collect()
        })
        .collect();

    for bodies in blocks(model, positions, present) {
        let mut block = Block::new(turning);
        for &body in &bodies {
            if let Some(row) = come.get(&body) {
                block.centre.push(row.centre);
                block.velocity.push(row.velocity);
                block.spin.push(row.spin);
                if model.rigid {
                    block.rotation.push(row.rotation);
                }
                continue;
            }
            let [b, k] = old_places[body as usize];
            let (from, k) = (&old[b as usize], k as usize);
            block.centre.push(from.centre[k]);
            block.velocity.push(from.velocity[k]);
            block.spin.push(from.spin[k]);
            if let Some(r) = from.rotation.get(k) {
                block.rotation.push(*r);
            }
        }
        block.bodies = bodies;
        block.fit();
        state.blocks.push(block);
    }
    state.cross.resize_with(state.blocks.len(), || Cross::new(turning));
    state.number(model);
    bond::store::put(model, state, bonds);

    // First sphere of each body within its new block.
    let mut first = vec![0_u32; positions.len()];
    for block in &state.blocks {
        let mut next = 0;
        for &b in &block.bodies {
            first[b as usize] = next;
            next += members[b as usize];
        }
    }
    let places = state.places.clone();
    let new = |[body, member]: [u32; 2]| {
        stays[body as usize].then(|| (places[body as usize][0], first[body as usize] + member))
    };

    let mut file = |a: Option<(u32, u32)>, b: Option<(u32, u32)>, history: History| {
        let (Some(a), Some(b)) = (a, b) else { return };
        // The spring is that of the first against the second.
        let turned = history.turned();
        let (a, b, history) = if a <= b { (a, b, history) } else { (b, a, turned) };
        if a.0 == b.0 {
            state.blocks[a.0 as usize].pairs.push([a.1, b.1], &history);
        } else {
            state.cross[a.0 as usize].spheres.push([a.1, b.0, b.1], &history);
        }
    };
    for (block, names) in old.iter().zip(&named) {
        for ([i, j], history) in block.pairs.iter() {
            file(new(names[i as usize]), new(names[j as usize]), history);
        }
    }
    for (b, pairs) in cross.iter().enumerate() {
        for ([i, block, j], history) in pairs.spheres.iter() {
            file(new(named[b][i as usize]), new(named[block as usize][j as usize]), history);
        }
    }
    for (b, pairs) in cross.iter().enumerate() {
        for &ImagePair { name, history } in &pairs.images {
            let (x, y) = (new(named[b][name.i as usize]), new(named[name.block as usize][name.j as usize]));
            let (Some(x), Some(y)) = (x, y) else { continue };
            let turned = (name.shift.map(|s| -s), history.turned());
            let (x, y, (shift, history)) =
                if x <= y { (x, y, (name.shift, history)) } else { (y, x, turned) };
            let name = ImageName { i: x.1, block: y.0, j: y.1, shift };
            state.cross[x.0 as usize].images.push(ImagePair { name, history });
        }
    }
    for (b, pairs) in cross.iter().enumerate() {
        for ([i, from, j], history) in pairs.boxes.iter() {
            let Some((block, i)) = new(named[b][i as usize]) else { continue };
            let box_body = old[from as usize].bodies[j as usize];
            let [box_block, j] = places[box_body as usize];
            state.cross[block as usize].boxes.push([i, box_block, j], &history);
        }
    }
    for (block, names) in old.iter().zip(&named) {
        for ([i, plane], history) in block.planes.iter() {
            // A block of boxes keeps its corners: boxes never change places among themselves.
            let place = match names.get(i as usize) {
                Some(&name) => new(name),
                None => Some((state.blocks.len() as u32 - 1, i)),
            };
            let Some((b, i)) = place else { continue };
            state.blocks[b as usize].planes.push([i, plane], &history);
        }
        for (from, pick) in [(&block.walls, true), (&block.surface, false)] {
            for p in &from.live {
                let Some((b, i)) = new(names[p.i as usize]) else { continue };
                let to = &mut state.blocks[b as usize];
                (if pick { &mut to.walls } else { &mut to.surface }).live.push(PatchContact { i, ..*p });
            }
            for p in &from.pairs {
                let Some((b, i)) = new(names[p.i as usize]) else { continue };
                let to = &mut state.blocks[b as usize];
                (if pick { &mut to.walls } else { &mut to.surface }).pairs.push(PatchPair { i, ..*p });
            }
        }
    }
    for block in &mut state.blocks {
        block.pairs.sort();
        block.planes.sort();
        for list in [&mut block.walls, &mut block.surface] {
            list.pairs.sort_unstable_by_key(|p| (p.i, p.patch));
            list.live.sort_unstable_by_key(|p| (p.i, p.patch));
        }
    }
    for cross in &mut state.cross {
        cross.spheres.sort();
        cross.boxes.sort();
        cross.images.sort_unstable_by_key(|p| p.name);
    }
    state.stale = true;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Partner;
    use crate::input::BodyInput;
    use crate::measure;
    use crate::surface::NoSurface;
    use crate::testing::{SOFT, dumbbells, push, shaft};
    use crate::work::Work;

    /// Every contact keeps its force when the bodies are sorted anew, whichever of its two bodies comes first.
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
        // A contact between two bodies as seen by the one with the lower number.
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
