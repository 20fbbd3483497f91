//! Orders the nodes by geometric nested dissection.
//!
//! A plane splits the elements; shared nodes form the separator, numbered last.
//!
//! Source: George (1973).

use crate::mesh::Mesh;

/// Elements of an undivided part.
const LEAF: usize = 2;

/// Trial cuts as fractions.
const CUTS: [f64; 7] = [0.5, 0.45, 0.55, 0.4, 0.6, 0.35, 0.65];

/// Weight of imbalance.
const UNEVENNESS: f64 = 1.0;

/// Elimination order: entry i is the index of the i-th node.
pub fn nested_dissection(mesh: &Mesh) -> Vec<u32> {
    let centres = (0..mesh.element_count())
        .map(|e| {
            let x = mesh.element_coordinates(e);
            std::array::from_fn(|k| x.iter().map(|c| c[k]).sum::<f64>() / x.len() as f64)
        })
        .collect();
    let nodes = mesh.node_count();
    let mut dissection = Dissection {
        mesh,
        centres,
        numbered: vec![false; nodes],
        mark: vec![0; nodes],
        stamp: 0,
        order: Vec::new(),
    };
    let mut elements: Vec<u32> = (0..mesh.element_count() as u32).collect();
    dissection.part(&mut elements);
    // Nodes without elements come last.
    let left = (0..nodes as u32).filter(|&n| !dissection.numbered[n as usize]).collect::<Vec<_>>();
    dissection.order.extend(left);
    dissection.order
}

struct Dissection<'m> {
    mesh: &'m Mesh,
    centres: Vec<[f64; 3]>,
    numbered: Vec<bool>,
    /// Last stamp; avoids clearing.
    mark: Vec<u32>,
    stamp: u32,
    order: Vec<u32>,
}

impl Dissection<'_> {
    fn part(&mut self, elements: &mut [u32]) {
        let Some((axis, cut)) = self.best_cut(elements) else {
            let nodes = self.unnumbered(elements);
            self.order.extend(nodes);
            return;
        };
        self.sort(elements, axis);
        let (low, high) = elements.split_at_mut(cut);
        let separator = self.separator(low, high);
        for &n in &separator {
            self.numbered[n as usize] = true;
        }
        self.part(low);
        self.part(high);
        self.order.extend(separator);
    }

    /// Axis and size of the lower half, if divided.
    fn best_cut(&mut self, elements: &mut [u32]) -> Option<(usize, usize)> {
        let count = elements.len();
        if count <= LEAF {
            return None;
        }
        let mut best: Option<(f64, usize, usize)> = None;
        for axis in 0..3 {
            self.sort(elements, axis);
            let mut tried = 0;
            for fraction in CUTS {
                let cut = self.widest_gap(elements, axis, (fraction * count as f64).round() as usize);
                if tried & (1_u128 << (cut * 100 / count)) != 0 {
                    continue;
                }
                tried |= 1 << (cut * 100 / count);
                let (low, high) = elements.split_at(cut);
                let size = self.separator(low, high).len() as f64;
                let uneven = (low.len() as f64 - high.len() as f64).abs() / count as f64;
                let cost = size * (1.0 + UNEVENNESS * uneven);
                if best.is_none_or(|(least, ..)| cost < least) {
                    best = Some((cost, axis, cut));
                }
            }
        }
        best.map(|(_, axis, cut)| (axis, cut))
    }

    /// Widest gap of centres near `aim` (within a tenth): between layers.
    fn widest_gap(&self, elements: &[u32], axis: usize, aim: usize) -> usize {
        let count = elements.len();
        let reach = count / 10;
        let centre = |i: usize| self.centres[elements[i] as usize][axis];
        let (first, last) = (aim.saturating_sub(reach).max(1), (aim + reach).clamp(1, count - 1));
        let mut best = (f64::NEG_INFINITY, aim.clamp(1, count - 1));
        for cut in first..=last {
            let gap = centre(cut) - centre(cut - 1);
            // Among equal gaps, nearest to the aim.
            let nearer = cut.abs_diff(aim) < best.1.abs_diff(aim);
            if gap > best.0 * (1.0 + 1e-6) || (nearer && gap >= best.0 * (1.0 - 1e-6)) {
                best = (gap, cut);
            }
        }
        best.1
    }

    fn sort(&self, elements: &mut [u32], axis: usize) {
        let centres = &self.centres;
        elements.sort_unstable_by(|&a, &b| {
            centres[a as usize][axis].total_cmp(&centres[b as usize][axis]).then(a.cmp(&b))
        });
    }

    /// Unnumbered nodes shared by both halves.
    fn separator(&mut self, low: &[u32], high: &[u32]) -> Vec<u32> {
        self.stamp += 1;
        for &e in low {
            for &n in self.mesh.connectivity[e as usize].iter() {
                self.mark[n as usize] = self.stamp;
            }
        }
        let seen = self.stamp;
        self.stamp += 1;
        let mut shared = Vec::new();
        for &e in high {
            for &n in self.mesh.connectivity[e as usize].iter() {
                if self.mark[n as usize] == seen && !self.numbered[n as usize] {
                    self.mark[n as usize] = self.stamp;
                    shared.push(n);
                }
            }
        }
        shared.sort_unstable();
        shared
    }

    /// Unnumbered nodes of a leaf; weakly coupled ones first.
    fn unnumbered(&mut self, elements: &[u32]) -> Vec<u32> {
        let mut nodes = Vec::new();
        for &e in elements {
            for &n in self.mesh.connectivity[e as usize].iter() {
                if !self.numbered[n as usize] {
                    nodes.push((
                        elements.iter().filter(|&&o| self.mesh.connectivity[o as usize].contains(&n)).count(),
                        n,
                    ));
                }
            }
        }
        nodes.sort_by_key(|(uses, _)| *uses);
        let mut order = Vec::new();
        for (_, n) in nodes {
            if !self.numbered[n as usize] {
                self.numbered[n as usize] = true;
                order.push(n);
            }
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_sheet_separates_mesh() {
        let mesh = Mesh::block([8, 4, 3], [8.0, 4.0, 3.0]);
        let order = nested_dissection(&mesh);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(
            sorted.iter().enumerate().all(|(i, &n)| i == n as usize) && sorted.len() == mesh.node_count()
        );
        let sheet = 5 * 4 + 4 * 4 + 5 * 3;
        assert!(order[order.len() - sheet..].iter().all(|&n| mesh.coordinates[n as usize][0] == 4.0));
    }

    #[test]
    fn cuts_between_layers() {
        let mut mesh = Mesh::block([9, 1, 1], [9.0, 1.0, 1.0]);
        mesh.coordinates.iter_mut().for_each(|c| c[0] = c[0].powf(1.5));
        let order = nested_dissection(&mesh);
        let last = &order[order.len() - 8..];
        let x = mesh.coordinates[last[0] as usize][0];
        assert!(last.iter().all(|&n| mesh.coordinates[n as usize][0] == x));
    }
}
