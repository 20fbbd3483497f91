//! Pieces of bodies that bonds join.

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
