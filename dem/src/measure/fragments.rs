//! Fragments of bonded bodies.

use crate::engine::model::Model;
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

/// Union–find with path halving.
pub(crate) fn components(count: usize, pairs: impl IntoIterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..count as u32).collect();
    let root = |parent: &mut Vec<u32>, mut k: u32| {
        while parent[k as usize] != k {
            parent[k as usize] = parent[parent[k as usize] as usize];
            k = parent[k as usize];
        }
        k
    };
    for [a, b] in pairs {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        // Independent of the order of bonds.
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut of = vec![0; count];
    let mut fragments = 0;
    for body in 0..count {
        let first = root(&mut parent, body as u32) as usize;
        if first == body {
            of[body] = fragments;
            fragments += 1;
        } else {
            of[body] = of[first];
        }
    }
    of
}
