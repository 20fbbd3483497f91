//! Contact kernels and memory use.

use crate::base::capacity::capacity_bytes;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::lanes::Simd;
use std::collections::BTreeSet;

/// Describes the contact kernels of a model.
pub fn kernels(model: &Model) -> String {
    let law = model.laws.title();
    let used = || (0..model.body_count()).map(|body| model.shape(body));
    let solids: BTreeSet<&str> = used().filter_map(|shape| shape.query(|s| s.solid_name())).collect();
    // Polyhedra, disks, boxes.
    let mut names: Vec<&str> = solids.into_iter().rev().collect();
    if used().any(|shape| shape.query(|s| s.sphere_count()) > 0) {
        names.push(if model.clumps { "spheres of rigid bodies" } else { "single spheres" });
    }
    let shapes = names.join(", ");
    let rolling = if model.laws.rolls() { ", rolling and twisting" } else { "" };
    let bonds = if model.bonds.is_empty() { "" } else { ", bonds" };
    let drag = if model.body_forces.is_empty() { "" } else { ", body forces" };
    let lanes = Simd::best().name();
    format!("{law}, {shapes}{rolling}{bonds}{drag}, {lanes}")
}

/// Memory of bodies, contacts, bonds, neighbours and forces [B], without model constants.
pub fn bytes(state: &State, work: &Work) -> usize {
    let blocks: usize = state.blocks.iter().map(|b| b.bytes()).sum();
    let lists = state
        .lists
        .iter()
        .map(|l| l.pairs.bytes() + l.planes.bytes() + l.walls.bytes() + l.surface.bytes() + l.bonds.bytes());
    let cross: usize = state.cross.iter().map(|c| c.bytes()).sum();
    let bonds: usize = state.bonds.cross.iter().map(|l| l.bytes()).sum();
    let members: usize = work.members.iter().map(|m| m.bytes()).sum();
    let scratch: usize = work.blocks.iter().map(|w| w.bytes()).sum();
    let slots: usize = work.cross.iter().map(|c| capacity_bytes(&c.slots)).sum();
    let state_sum = capacity_bytes(&state.places) + blocks + lists.sum::<usize>() + cross + bonds;
    state_sum + members + scratch + slots + work.bonds.bytes()
}
