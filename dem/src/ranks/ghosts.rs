//! Ghost bodies and their motion.

use super::codec::{read_numbers, write_numbers};
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::lanes::vec4::Vec4;
use nalgebra::{Quaternion, Unit};
use std::ops::Range;

/// Block and index of a body.
pub(super) type BodyLocation = [u32; 2];

/// Received and sent, by rank.
#[derive(Clone, Debug, Default)]
pub(super) struct Ghosts {
    pub to: Vec<Vec<BodyLocation>>,
    pub from: Vec<Vec<BodyLocation>>,
}

/// Ghosts in neighbour lists, ascending, unique.
pub(super) fn of_lists(state: &State, work: &Work, own: &Range<usize>) -> Vec<BodyLocation> {
    let mut need = Vec::new();
    for (b, cross) in state.cross.iter().enumerate().take(own.end) {
        for k in 0..cross.spheres.len() {
            let [i, block, j] = cross.spheres.name(k);
            need.extend(partner(work, own, [b as u32, i], [block, j]));
        }
    }
    bonded(state, own, &mut need);
    sorted(need)
}

fn bonded(state: &State, own: &Range<usize>, need: &mut Vec<BodyLocation>) {
    for (b, list) in state.bonds.cross.iter().enumerate() {
        let bonds = list.iter().map(|e| (e.i, e.block, e.j));
        for (i, block, j) in bonds.chain(list.debonded.iter().map(|r| (r.i, r.block, r.j))) {
            need.extend(other(own, [b as u32, i], [block, j]));
        }
    }
}

/// Candidates and bonds.
pub(super) fn of_candidates(state: &State, work: &Work, own: &Range<usize>) -> Vec<BodyLocation> {
    let mut need = Vec::new();
    bonded(state, own, &mut need);
    for (b, w) in work.blocks.iter().enumerate().take(own.end) {
        for &[i, block, j] in &w.candidates.cross {
            need.extend(partner(work, own, [b as u32, i], [block, j]));
        }
    }
    sorted(need)
}

/// Body outside `own`, if only one is.
fn partner(work: &Work, own: &Range<usize>, a: BodyLocation, b: BodyLocation) -> Option<BodyLocation> {
    other(own, a, b).map(|[block, sphere]| [block, work.members[block as usize].body(sphere)])
}

/// Body outside `own`, if only one is.
fn other(own: &Range<usize>, a: BodyLocation, b: BodyLocation) -> Option<BodyLocation> {
    let there = |[block, _]: BodyLocation| !own.contains(&(block as usize));
    match (there(a), there(b)) {
        (true, false) => Some(a),
        (false, true) => Some(b),
        _ => None,
    }
}

fn sorted(mut places: Vec<BodyLocation>) -> Vec<BodyLocation> {
    places.sort_unstable();
    places.dedup();
    places
}

/// Nine values per sphere, plus orientation in blocks with other bodies.
pub(super) fn write_motion(blocks: &[Block], places: &[BodyLocation], out: &mut Vec<u8>) {
    for &[b, k] in places {
        let (block, k) = (&blocks[b as usize], k as usize);
        for record in [&block.centre[k], &block.velocity[k], &block.spin[k]] {
            write_numbers(out, record.0[..3].iter().copied());
        }
        if let Some(rotation) = block.rotation.get(k) {
            write_numbers(out, rotation.orientation.coords.iter().copied());
        }
    }
}

/// `None` if the message is malformed.
pub(super) fn read_motion(
    blocks: &mut [Block],
    members: &mut [BlockBodies],
    places: &[BodyLocation],
    rest: &mut &[u8],
) -> Option<()> {
    for &[b, k] in places {
        let (block, k) = (&mut blocks[b as usize], k as usize);
        for record in [&mut block.centre[k], &mut block.velocity[k], &mut block.spin[k]] {
            let [x, y, z] = read_numbers(rest)?;
            *record = Vec4([x, y, z, record.0[3]]);
        }
        if let Some(rotation) = block.rotation.get_mut(k) {
            let [i, j, k_, w] = read_numbers(rest)?;
            rotation.orientation = Unit::new_unchecked(Quaternion::new(w, i, j, k_));
            members[b as usize].place_spheres(k, &block.centre[k], &rotation.orientation);
        }
    }
    Some(())
}
