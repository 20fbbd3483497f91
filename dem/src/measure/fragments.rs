//! Fragments of bonded bodies.

use crate::engine::model::Model;
use crate::engine::pieces::components;
use crate::engine::state::State;

/// Components connected by unbroken bonds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fragments {
    /// Fragment of each body, by smallest body. Shape `[bodies]`.
    pub of: Vec<u32>,
    /// Bodies per fragment.
    pub sizes: Vec<u32>,
}

/// Finds the fragments.
pub fn fragments(model: &Model, state: &State) -> Fragments {
    let mut bonds = Vec::with_capacity(state.bond_count());
    state.each_bond(|number, _| bonds.push(model.bonds[number as usize].ends));
    let of = components(model.body_count(), bonds);
    let mut sizes = vec![0; of.iter().map(|k| *k as usize + 1).max().unwrap_or(0)];
    of.iter().for_each(|&k| sizes[k as usize] += 1);
    Fragments { of, sizes }
}
