//! Fragments: bodies held together by bonds.

use crate::engine::model::Model;
use crate::engine::state::State;

/// The connected components of bodies and unbroken bonds. Clumps, boxes and spheres without a bond are fragments of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fragments {
    /// Fragment of each body; fragments are numbered from 0 in the order of their smallest body. Shape `[bodies]`.
    pub of: Vec<u32>,
    /// Number of bodies of each fragment.
    pub sizes: Vec<u32>,
}

/// Finds the fragments (union–find with path halving).
pub fn fragments(model: &Model, state: &State) -> Fragments {
    let mut parent: Vec<u32> = (0..model.body_count() as u32).collect();
    let root = |parent: &mut Vec<u32>, mut k: u32| {
        while parent[k as usize] != k {
            parent[k as usize] = parent[parent[k as usize] as usize];
            k = parent[k as usize];
        }
        k
    };
    state.each_bond(|number, _| {
        let [a, b] = model.bonds[number as usize].ends;
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        // The smaller body is the root, whatever the order of the bonds.
        parent[a.max(b) as usize] = a.min(b);
    });
    let mut of = vec![0; parent.len()];
    let mut sizes = Vec::new();
    for body in 0..parent.len() {
        let first = root(&mut parent, body as u32) as usize;
        if first == body {
            of[body] = sizes.len() as u32;
            sizes.push(0);
        } else {
            of[body] = of[first];
        }
        sizes[of[body] as usize] += 1;
    }
    Fragments { of, sizes }
}
