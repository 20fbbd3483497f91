//! What a scene costs: the loops that its contacts run through, and the memory that state and scratch hold.

use crate::lanes::Simd;
use crate::law::Laws;
use crate::model::Model;
use crate::state::State;
use crate::work::Work;
use std::mem::size_of;

/// The loops that the contacts of a model run through, in words.
pub fn kernels(model: &Model) -> String {
    let law = match &model.laws {
        Laws::Linear(_) => "linear spring-dashpot",
        Laws::Hertz(_) => "Hertz-Mindlin",
    };
    let shapes = if model.rigid { "spheres of rigid bodies" } else { "single spheres" };
    let rolling = if model.laws.rolls() { ", rolling and twisting" } else { "" };
    let bonds = if model.bonds.is_empty() { "" } else { ", bonds" };
    let lanes = match Simd::best() {
        Simd::Portable => "four at a time (plain arrays)",
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => "four at a time (AVX2)",
        #[cfg(target_arch = "x86_64")]
        Simd::Avx512 => "eight at a time (AVX-512)",
    };
    format!("{law}, {shapes}{rolling}{bonds}, {lanes}")
}

/// Bytes that bodies, contacts, neighbours and forces hold now; constants of the model are not counted.
pub fn bytes(state: &State, work: &Work) -> usize {
    fn held<T>(list: &Vec<T>) -> usize {
        list.capacity() * size_of::<T>()
    }
    let mut sum = held(&state.places);
    for block in &state.blocks {
        sum += held(&block.bodies) + held(&block.centre) + held(&block.velocity) + held(&block.spin);
        sum += held(&block.rotation);
        sum += [&block.pairs, &block.planes].iter().map(|g| held(&g.groups) + held(&g.turns)).sum::<usize>();
        sum += [&block.walls, &block.surface].iter().map(|p| held(&p.pairs) + held(&p.live)).sum::<usize>();
    }
    for cross in &state.cross {
        let lists = [&cross.spheres, &cross.boxes];
        sum += lists.iter().map(|g| held(&g.groups) + held(&g.turns)).sum::<usize>();
    }
    for w in &work.blocks {
        sum += held(&w.owner) + held(&w.local) + held(&w.spheres) + held(&w.first) + held(&w.gather);
        sum += held(&w.candidates) + held(&w.cross) + held(&w.boxed) + held(&w.planes) + held(&w.sums);
        sum += held(&w.inertia) + held(&w.reach) + held(&w.kind) + held(&w.fixed) + held(&w.half);
        // Where the spheres were at the last search.
        sum += w.reference.len() * size_of::<[f32; 3]>();
    }
    sum + work.cross.iter().map(|c| held(&c.slots)).sum::<usize>()
}
