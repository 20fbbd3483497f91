//! Parallel products with `A = k K + m M + d D` on the free dofs from half-stored matrices.
//!
//! Parts of rows buffer contributions to later parts, added in part order. x and y are 0 at constrained dofs.

use super::upper_blocks::UpperBlocks;
use crate::assembly::{Combination, Matrices};
use crate::solver::conjugate::Operator;
use crate::solver::conjugate::vectors::NODES;
use crate::supports::{CONSTRAINED, Supports};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Matrix of a combination, with scratch.
pub struct MatrixProduct {
    matrices: Arc<Matrices>,
    combination: Combination,
    /// Combined entries in single precision, if rounded.
    single: Option<Vec<[f32; 9]>>,
    parts: Vec<Part>,
    /// First buffered contribution of each node; shape `[nodes + 1]`.
    start: Vec<u32>,
    /// Part and position of each contribution, in part order.
    from: Vec<[u32; 2]>,
    /// Free dofs. Shape `[nodes]`.
    free: Vec<[bool; 3]>,
}

struct Part {
    nodes: Range<usize>,
    /// Nodes of later parts in the rows, ascending.
    beyond: Vec<u32>,
    /// Column position of each slot: own nodes, then `beyond`.
    place: Vec<u32>,
    dashpots: Vec<([u32; 2], [f64; 9])>,
    /// Four lanes; x times the stiffness factor.
    x: Vec<[f64; 4]>,
    y: Vec<[f64; 4]>,
}

impl MatrixProduct {
    /// Matrix `combination` on the free dofs.
    pub fn new(matrices: Arc<Matrices>, supports: &Supports, combination: Combination) -> MatrixProduct {
        let nodes = matrices.node_count();
        let mut parts: Vec<Part> = (0..nodes)
            .step_by(NODES)
            .map(|first| Part::new(&matrices, first..nodes.min(first + NODES)))
            .collect();
        for (slot, block) in matrices.dashpot_blocks() {
            let row = matrices.row_of(slot);
            let part = &mut parts[row / NODES];
            let column = part.place[slot - matrices.slots(part.nodes.start).start];
            part.dashpots.push(([(row - part.nodes.start) as u32, column], *block));
        }
        let mut start = vec![0; nodes + 1];
        parts.iter().flat_map(|p| &p.beyond).for_each(|&n| start[n as usize + 1] += 1);
        (0..nodes).for_each(|n| start[n + 1] += start[n]);
        let (mut next, mut from) = (start.clone(), vec![[0; 2]; start[nodes] as usize]);
        for (k, part) in parts.iter().enumerate() {
            for (i, &n) in part.beyond.iter().enumerate() {
                from[next[n as usize] as usize] = [k as u32, (part.nodes.len() + i) as u32];
                next[n as usize] += 1;
            }
        }
        let free = |dof: usize| supports.free_index()[dof] != CONSTRAINED;
        let free = (0..nodes).map(|n| [0, 1, 2].map(|k| free(3 * n + k))).collect();
        MatrixProduct { matrices, combination, single: None, parts, start, from, free }
    }

    /// Matrix in single precision, which halves memory traffic; vectors and sums are double. Overflow becomes
    /// infinite, which the iteration reports.
    pub fn rounded(matrices: Arc<Matrices>, supports: &Supports, combination: Combination) -> MatrixProduct {
        let mut product = MatrixProduct::new(matrices, supports, combination);
        let (matrices, c) = (product.matrices.clone(), combination);
        let mut single = Vec::with_capacity(matrices.stiffness_blocks().len());
        let mut dashpots = matrices.dashpot_blocks().peekable();
        for (slot, (k, m)) in matrices.stiffness_blocks().iter().zip(matrices.mass_entries()).enumerate() {
            let mut block = k.map(|k| c.stiffness * k);
            (0..3).for_each(|i| block[4 * i] += c.mass * m);
            if let Some((_, d)) = dashpots.next_if(|(s, _)| *s == slot) {
                block.iter_mut().zip(d).for_each(|(b, d)| *b += c.dashpots * d);
            }
            single.push(block.map(|v| v as f32));
        }
        product.single = Some(single);
        product
    }

    /// Diagonal blocks by nodes, identity at constrained dofs.
    pub fn diagonal_blocks(&self) -> Vec<[f64; 9]> {
        let (m, c) = (&self.matrices, self.combination);
        let mut blocks: Vec<[f64; 9]> = (0..m.node_count())
            .map(|p| {
                let slot = m.slots(p).start;
                let mass = c.mass * m.mass_entries()[slot];
                let mut block = m.stiffness_blocks()[slot].map(|k| c.stiffness * k);
                (0..3).for_each(|k| block[4 * k] += mass);
                block
            })
            .collect();
        for part in &self.parts {
            for ([row, _], d) in part.dashpots.iter().filter(|([row, column], _)| row == column) {
                let block = &mut blocks[part.nodes.start + *row as usize];
                block.iter_mut().zip(d).for_each(|(b, d)| *b += c.dashpots * d);
            }
        }
        for (block, free) in blocks.iter_mut().zip(&self.free) {
            for i in 0..3 {
                for j in 0..3 {
                    if !(free[i] && free[j]) {
                        block[3 * i + j] = f64::from(u8::from(i == j));
                    }
                }
            }
        }
        blocks
    }

    /// Matrices of the model.
    pub fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// Free dofs by nodes.
    pub fn free(&self) -> &[[bool; 3]] {
        &self.free
    }

    /// Additional memory [bytes].
    pub fn memory(&self) -> usize {
        let of_part =
            |p: &Part| 4 * (p.beyond.len() + p.place.len()) + 80 * p.dashpots.len() + 64 * p.x.len();
        self.parts.iter().map(of_part).sum::<usize>()
            + self.single.as_ref().map_or(0, |s| size_of_val(&s[..]))
            + 4 * self.start.len()
            + 8 * self.from.len()
            + 3 * self.free.len()
    }
}

impl Part {
    fn new(matrices: &Matrices, nodes: Range<usize>) -> Part {
        let later = |q: &&u32| **q as usize >= nodes.end;
        let mut beyond: Vec<u32> =
            nodes.clone().flat_map(|p| matrices.row(p).iter().filter(later)).copied().collect();
        beyond.sort_unstable();
        beyond.dedup();
        let place_of = |&q: &u32| {
            if (q as usize) < nodes.end {
                q - nodes.start as u32
            } else {
                (nodes.len() + beyond.partition_point(|&n| n < q)) as u32
            }
        };
        let place = nodes.clone().flat_map(|p| matrices.row(p)).map(place_of).collect();
        let all = vec![[0.0; 4]; nodes.len() + beyond.len()];
        Part { nodes, beyond, place, dashpots: Vec::new(), x: all.clone(), y: all }
    }

    fn gather(&mut self, x: &[[f64; 3]], factor: f64) {
        let own = self.nodes.len();
        let scaled = |x: &[f64; 3]| [factor * x[0], factor * x[1], factor * x[2], 0.0];
        self.x.iter_mut().zip(&x[self.nodes.clone()]).for_each(|(to, x)| *to = scaled(x));
        for (to, &n) in self.x[own..].iter_mut().zip(&self.beyond) {
            *to = scaled(&x[n as usize]);
        }
        self.y.fill([0.0; 4]);
    }

    /// `MASS`: adds multiples of the identity.
    fn multiply<T: Copy + Into<f64>, const MASS: bool>(
        &mut self,
        matrices: &Matrices,
        blocks: &[[T; 9]],
        inertia: f64,
    ) {
        let slots = matrices.slots(self.nodes.start).start..matrices.slots(self.nodes.end - 1).end;
        let rows = UpperBlocks {
            start: &matrices.row_starts()[self.nodes.start..=self.nodes.end],
            place: &self.place,
            blocks: &blocks[slots.clone()],
            mass: &matrices.mass_entries()[slots],
            inertia,
        };
        rows.times::<MASS>(&self.x, &mut self.y);
    }

    fn multiply_dashpots(&mut self, factor: f64) {
        for &([p, q], d) in &self.dashpots {
            let ([xp, xq], p, q) = ([self.x[p as usize], self.x[q as usize]], p as usize, q as usize);
            for r in 0..3 {
                self.y[p][r] += factor * (d[3 * r] * xq[0] + d[3 * r + 1] * xq[1] + d[3 * r + 2] * xq[2]);
                if p != q {
                    self.y[q][r] += factor * (d[r] * xp[0] + d[3 + r] * xp[1] + d[6 + r] * xp[2]);
                }
            }
        }
    }
}

impl Operator for MatrixProduct {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<3>().0, y.as_chunks_mut::<3>().0);
        let (matrices, c) = (&*self.matrices, self.combination);
        let (single, blocks) = (&self.single, matrices.stiffness_blocks());
        let lumped = if c.mass == 0.0 || single.is_some() { None } else { matrices.lumped_mass() };
        let full = c.mass != 0.0 && matrices.lumped_mass().is_none();
        self.parts.par_iter_mut().for_each(|part| {
            if let Some(single) = single {
                part.gather(x, 1.0);
                part.multiply::<f32, false>(matrices, single, 0.0);
                return;
            }
            part.gather(x, c.stiffness);
            if full {
                part.multiply::<f64, true>(matrices, blocks, c.mass / c.stiffness);
            } else {
                part.multiply::<f64, false>(matrices, blocks, 0.0);
            }
            part.multiply_dashpots(c.dashpots / c.stiffness);
        });
        let (parts, start, from, free) = (&self.parts, &self.start, &self.from, &self.free);
        (parts.par_iter(), y.par_chunks_mut(NODES)).into_par_iter().for_each(|(part, y)| {
            for (i, (y, n)) in y.iter_mut().zip(part.nodes.clone()).enumerate() {
                let [mut sum @ .., _] = part.y[i];
                for &[k, place] in &from[start[n] as usize..start[n + 1] as usize] {
                    let other = parts[k as usize].y[place as usize];
                    (0..3).for_each(|r| sum[r] += other[r]);
                }
                let mass = lumped.map_or(0.0, |m| c.mass * m[n]);
                *y = [0, 1, 2].map(|r| if free[n][r] { sum[r] + mass * x[n][r] } else { 0.0 });
            }
        });
    }
}
