//! Bounding-volume hierarchy of boxes: median splits, refit for moving boxes.

/// Boxes per leaf.
const LEAF: usize = 4;

/// Axis-aligned box: lower and upper corner [m].
pub type Aabb = ([f64; 3], [f64; 3]);

#[derive(Clone, Copy, Debug)]
struct Node {
    lo: [f64; 3],
    hi: [f64; 3],
    /// First item of a leaf, or second child of a branch (the first follows its parent).
    start: u32,
    /// 0 for a branch.
    count: u32,
}

/// Hierarchy without references to the boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

impl Bvh {
    /// Builds the tree.
    pub fn new(boxes: &[Aabb]) -> Bvh {
        let mut tree = Bvh { nodes: Vec::new(), items: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            tree.split(boxes, 0, boxes.len());
            tree.refit(boxes);
        }
        tree
    }

    fn split(&mut self, boxes: &[Aabb], start: usize, end: usize) {
        let node = self.nodes.len();
        self.nodes.push(Node {
            lo: [0.0; 3],
            hi: [0.0; 3],
            start: start as u32,
            count: (end - start) as u32,
        });
        if end - start <= LEAF {
            return;
        }
        let middle = |item: u32, d: usize| boxes[item as usize].0[d] + boxes[item as usize].1[d];
        let spread = |d: usize| {
            let (lo, hi) =
                self.items[start..end].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &k| {
                    (lo.min(middle(k, d)), hi.max(middle(k, d)))
                });
            hi - lo
        };
        let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
        let half = (end - start) / 2;
        self.items[start..end].select_nth_unstable_by(half, |&a, &b| {
            middle(a, axis).total_cmp(&middle(b, axis)).then(a.cmp(&b))
        });
        self.split(boxes, start, start + half);
        let second = self.nodes.len();
        self.split(boxes, start + half, end);
        self.nodes[node].start = second as u32;
        self.nodes[node].count = 0;
    }

    /// Refits the tree to moved boxes of the same order.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        for k in (0..self.nodes.len()).rev() {
            let Node { start, count, .. } = self.nodes[k];
            let mut lo = [f64::INFINITY; 3];
            let mut hi = [f64::NEG_INFINITY; 3];
            let mut add = |b: &[f64; 3], c: &[f64; 3]| {
                for d in 0..3 {
                    lo[d] = lo[d].min(b[d]);
                    hi[d] = hi[d].max(c[d]);
                }
            };
            if count == 0 {
                for child in [k + 1, start as usize] {
                    add(&self.nodes[child].lo, &self.nodes[child].hi);
                }
            } else {
                for &item in &self.items[start as usize..(start + count) as usize] {
                    add(&boxes[item as usize].0, &boxes[item as usize].1);
                }
            }
            self.nodes[k].lo = lo;
            self.nodes[k].hi = hi;
        }
    }

    /// Appends boxes that may overlap `[lo, hi]`, ascending.
    pub fn query(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        let first = out.len();
        // A median tree of fewer than 2³² items is at most 32 deep.
        let mut stack = [0_u32; 40];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let k = stack[depth] as usize;
            let node = &self.nodes[k];
            if (0..3).any(|d| node.lo[d] > hi[d] || node.hi[d] < lo[d]) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = k as u32 + 1;
                depth += 2;
            } else {
                out.extend_from_slice(&self.items[node.start as usize..(node.start + node.count) as usize]);
            }
        }
        out[first..].sort_unstable();
    }

    /// Visits boxes possibly nearest to `p`; `visit` returns the least squared distance so far [m²].
    pub fn nearest(&self, p: [f64; 3], mut visit: impl FnMut(u32) -> f64) {
        let apart = |k: usize| -> f64 {
            let node = &self.nodes[k];
            (0..3).map(|d| (node.lo[d] - p[d]).max(p[d] - node.hi[d]).max(0.0).powi(2)).sum()
        };
        let mut best = f64::INFINITY;
        let mut stack = [(0_u32, 0.0); 40];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let (k, least) = stack[depth];
            if least > best {
                continue;
            }
            let node = &self.nodes[k as usize];
            if node.count == 0 {
                let (one, two) = (k + 1, node.start);
                let (to_one, to_two) = (apart(one as usize), apart(two as usize));
                // Nearer child first.
                let pair = if to_one <= to_two {
                    [(two, to_two), (one, to_one)]
                } else {
                    [(one, to_one), (two, to_two)]
                };
                stack[depth..depth + 2].copy_from_slice(&pair);
                depth += 2;
            } else {
                for &item in &self.items[node.start as usize..(node.start + node.count) as usize] {
                    best = visit(item);
                }
            }
        }
    }

    /// Total bounds; `None` if empty.
    pub fn bounds(&self) -> Option<Aabb> {
        self.nodes.first().map(|n| (n.lo, n.hi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    fn random_boxes(rng: &mut Pcg64Mcg, n: usize) -> Vec<Aabb> {
        let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        (0..n)
            .map(|_| {
                let lo = [unit(), unit(), unit()];
                (lo, lo.map(|x| x + 0.1 * unit()))
            })
            .collect()
    }

    #[test]
    fn finds_every_box_after_refit() {
        let mut rng = Pcg64Mcg::new(7);
        let mut tree = Bvh::new(&random_boxes(&mut rng, 500));
        let boxes = random_boxes(&mut rng, 500);
        tree.refit(&boxes);
        for (lo, hi) in random_boxes(&mut rng, 200) {
            let mut found = Vec::new();
            tree.query(lo, hi, &mut found);
            assert!(found.is_sorted());
            let meets = |b: &Aabb| (0..3).all(|d| b.0[d] <= hi[d] && b.1[d] >= lo[d]);
            for (k, b) in boxes.iter().enumerate() {
                assert!(!meets(b) || found.binary_search(&(k as u32)).is_ok(), "box {k} lost");
            }
        }
    }
}
