//! Messages of partial states.

use super::codec::{decode, encode};
use super::partition::Partition;
use crate::bodies::block::Block;
use crate::bond::{BondList, BondState};
use crate::engine::state::{BlockLists, State};
use crate::pairs::cross::Cross;
use crate::pairs::groups::Groups;
use std::ops::Range;

/// Motion of all bodies, contacts of the rank's blocks and of earlier ones with them.
pub(super) fn write(state: &State, partition: &Partition, rank: usize, out: &mut Vec<u8>) {
    let own = partition.of_rank(rank);
    encode(out, &partition.bounds);
    encode(out, &rest_of(state));
    encode(out, &state.blocks);
    encode(out, &state.lists[own.clone()]);
    encode(out, &state.cross[own.clone()]);
    let reach = |list: &Groups<3>| (0..list.len()).any(|k| own.contains(&(list.name(k)[1] as usize)));
    let earlier = state.cross[..own.start].iter().enumerate().filter(|(_, cross)| reach(&cross.spheres));
    let earlier: Vec<(u32, Groups<3>)> = earlier
        .map(|(b, cross)| {
            let mut part = Groups::new(cross.spheres.turning);
            for (name, history) in cross.spheres.iter().filter(|(n, _)| own.contains(&(n[1] as usize))) {
                part.push(name, &history);
            }
            (b as u32, part)
        })
        .collect();
    encode(out, &earlier);
    let turning: Vec<bool> = state.cross[..own.start].iter().map(|cross| cross.spheres.turning).collect();
    encode(out, &turning);
    let bonds = state.bonds.cross.iter().enumerate();
    let bonds: Vec<BondList> = bonds.map(|(b, list)| bonds_with(list, b, &own)).collect();
    encode(out, &bonds);
}

/// With an end in the blocks `own`.
fn bonds_with(list: &BondList, b: usize, own: &Range<usize>) -> BondList {
    if own.contains(&b) {
        return list.clone();
    }
    let mut part = BondList::default();
    part.fill(list.iter().filter(|e| own.contains(&(e.block as usize))));
    part.debonded.extend(list.debonded.iter().filter(|r| own.contains(&(r.block as usize))));
    part
}

/// Removes data that only other ranks compute.
pub(super) fn restrict(state: &mut State, own: &Range<usize>) {
    if own.len() == state.blocks.len() {
        return;
    }
    for b in (0..state.blocks.len()).filter(|b| !own.contains(b)) {
        state.lists[b] = BlockLists::default();
        if b >= own.end {
            state.cross[b] = Cross::default();
        }
    }
    for (b, list) in state.bonds.cross.iter_mut().enumerate() {
        *list = bonds_with(list, b, own);
    }
}

/// `None` if the message is malformed.
pub(super) fn read(rank: usize, mut rest: &[u8]) -> Option<(State, Partition)> {
    let rest = &mut rest;
    let partition = Partition { bounds: decode(rest)? };
    let own = partition.of_rank(rank);
    let mut state: State = decode(rest)?;
    state.blocks = decode(rest)?;
    state.lists.resize_with(own.start, BlockLists::default);
    state.lists.append(&mut decode(rest)?);
    state.lists.resize_with(state.blocks.len(), BlockLists::default);
    state.cross.resize_with(own.start, Cross::default);
    state.cross.append(&mut decode(rest)?);
    state.cross.resize_with(state.blocks.len(), Cross::default);
    let earlier: Vec<(u32, Groups<3>)> = decode(rest)?;
    let turning: Vec<bool> = decode(rest)?;
    for (cross, turning) in state.cross.iter_mut().zip(turning) {
        cross.spheres.turning = turning;
    }
    for (b, part) in earlier {
        state.cross[b as usize].spheres = part;
    }
    state.bonds.cross = decode(rest)?;
    rest.is_empty().then_some((state, partition))
}

fn rest_of(state: &State) -> State {
    State {
        balance: state.balance,
        places: Vec::new(),
        blocks: Vec::new(),
        lists: Vec::new(),
        cross: Vec::new(),
        bonds: BondState { cross: Vec::new(), breaks: Vec::new(), ..state.bonds },
        planes: state.planes.clone(),
        walls: state.walls.clone(),
        sheet: Vec::new(),
        scars: Vec::new(),
        ..*state
    }
}

pub(super) fn write_back(state: &State, own: Range<usize>, out: &mut Vec<u8>) {
    encode(out, &state.blocks[own.clone()]);
    encode(out, &state.lists[own.clone()]);
    encode(out, &state.cross[own.clone()]);
    // Models without bonds have no lists.
    encode(out, state.bonds.cross.get(own).unwrap_or_default());
}

/// `None` if the message is malformed.
pub(super) fn read_back(state: &mut State, own: Range<usize>, rest: &mut &[u8]) -> Option<()> {
    let blocks: Vec<Block> = decode(rest)?;
    let (lists, cross): (Vec<BlockLists>, Vec<Cross>) = (decode(rest)?, decode(rest)?);
    let bonds: Vec<BondList> = decode(rest)?;
    let expected = if state.bonds.cross.is_empty() { 0 } else { own.len() };
    if [blocks.len(), lists.len(), cross.len()] != [own.len(); 3] || bonds.len() != expected {
        return None;
    }
    if expected > 0 {
        state.bonds.cross.splice(own.clone(), bonds);
    }
    state.blocks.splice(own.clone(), blocks);
    state.lists.splice(own.clone(), lists);
    state.cross.splice(own, cross);
    Some(())
}
