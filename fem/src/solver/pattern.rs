//! Permuted pattern, elimination tree and postorder of a structurally symmetric matrix.
//!
//! Source: Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11 (1990)
//! 134-172, sections 3 and 4. Limits: fewer than 2^31 entries.

/// List end, or parent of a root.
pub(super) const NONE: u32 = u32::MAX;

/// Flag in [`UpperPattern::source`]: entry from the other side of the diagonal.
pub(super) const MIRRORED: u32 = 1 << 31;

/// Upper triangle in elimination order.
pub(super) struct UpperPattern {
    pub start: Vec<usize>,
    pub row: Vec<usize>,
    /// Index of the entry in the caller's pattern, with [`MIRRORED`] if transposed.
    pub source: Vec<u32>,
}

impl UpperPattern {
    /// From the caller's lower triangle; `position[equation]` is the elimination position.
    pub fn new(column_start: &[usize], row: &[usize], position: &[u32]) -> UpperPattern {
        let n = position.len();
        let mut start = vec![0_usize; n + 1];
        for c in 0..n {
            let pc = position[c];
            for &r in &row[column_start[c]..column_start[c + 1]] {
                start[pc.max(position[r]) as usize + 1] += 1;
            }
        }
        for j in 0..n {
            start[j + 1] += start[j];
        }
        let mut next = start.clone();
        let mut found = vec![0_usize; row.len()];
        let mut source = vec![0_u32; row.len()];
        for c in 0..n {
            let pc = position[c];
            for k in column_start[c]..column_start[c + 1] {
                let pr = position[row[k]];
                let (low, high, side) = if pr >= pc { (pc, pr, 0) } else { (pr, pc, MIRRORED) };
                let place = next[high as usize];
                next[high as usize] += 1;
                found[place] = low as usize;
                source[place] = k as u32 | side;
            }
        }
        UpperPattern { start, row: found, source }
    }

    pub fn elimination_tree(&self) -> Vec<u32> {
        let n = self.start.len() - 1;
        let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
        for j in 0..n {
            for &i in &self.row[self.start[j]..self.start[j + 1]] {
                let mut i = i;
                while i < j {
                    // Path compression.
                    let next = std::mem::replace(&mut ancestor[i], j as u32);
                    if next == NONE {
                        parent[i] = j as u32;
                        break;
                    }
                    i = next as usize;
                }
            }
        }
        parent
    }
}

/// Columns in postorder, children ascending.
pub(super) fn postorder(parent: &[u32]) -> Vec<u32> {
    let n = parent.len();
    let (mut first_child, mut sibling) = (vec![NONE; n], vec![NONE; n]);
    let mut first_root = NONE;
    for j in (0..n).rev() {
        let list = if parent[j] == NONE { &mut first_root } else { &mut first_child[parent[j] as usize] };
        sibling[j] = std::mem::replace(list, j as u32);
    }
    let mut order = Vec::with_capacity(n);
    let mut path = Vec::new();
    let mut node = first_root;
    while node != NONE {
        while first_child[node as usize] != NONE {
            path.push(node);
            node = first_child[node as usize];
        }
        order.push(node);
        while sibling[node as usize] == NONE {
            match path.pop() {
                Some(up) => {
                    node = up;
                    order.push(node);
                }
                None => return order,
            }
        }
        node = sibling[node as usize];
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Liu: parent(j) is the first row below the diagonal of factor column j.
    #[test]
    fn tree_and_postorder_match_dense_elimination() {
        let columns: [&[usize]; 7] = [&[0, 3, 5], &[1, 2], &[2, 6], &[3], &[4, 5], &[5], &[6]];
        let mut start = vec![0];
        let mut row = Vec::new();
        for c in columns {
            row.extend_from_slice(c);
            start.push(row.len());
        }
        let upper = UpperPattern::new(&start, &row, &[0, 1, 2, 3, 4, 5, 6]);
        // By hand: column 0 fills (5,3).
        let parent = upper.elimination_tree();
        assert_eq!(parent, [3, 2, 6, 5, 5, NONE, NONE]);
        assert_eq!(postorder(&parent), [0, 3, 4, 5, 1, 2, 6]);
        let mirrored = UpperPattern::new(&start, &row, &[6, 5, 4, 3, 2, 1, 0]);
        assert!(mirrored.source.iter().filter(|&&s| s & MIRRORED != 0).count() == 5);
    }

    #[test]
    fn million_column_chain_needs_no_stack() {
        let n = 1_000_000;
        let parent: Vec<u32> = (1..=n).map(|p| if p == n { NONE } else { p }).collect();
        assert!(postorder(&parent).iter().enumerate().all(|(i, &j)| i == j as usize));
    }
}
