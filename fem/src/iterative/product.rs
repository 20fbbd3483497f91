//! Products with `A = k K + m M + d D` on the free dofs, from the half-stored matrices of a model.
//!
//! Each entry of the upper half is read once and serves its row and its column. A part of the rows, computed by one thread,
//! collects what belongs to columns of later parts aside; these are added afterwards, each node by the thread of its own part, in the
//! order of the parts. Constrained dofs take no part: x has to be 0 there and y is.

use crate::assembly::{Combination, Matrices};
use crate::solver::conjugate::Operator;
use crate::solver::conjugate::vectors::NODES;
use crate::supports::{CONSTRAINED, Supports};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The matrix of a combination, with scratch for its products.
pub struct Product {
    matrices: Arc<Matrices>,
    combination: Combination,
    parts: Vec<Part>,
    /// Where contributions from other parts begin for each node; shape `[nodes + 1]`.
    start: Vec<u32>,
    /// Part and place there of each contribution, in the order of parts.
    from: Vec<[u32; 2]>,
    /// Whether a dof is free. Shape `[nodes]`.
    free: Vec<[bool; 3]>,
}

/// Some rows of the upper half.
struct Part {
    nodes: Range<usize>,
    /// Nodes of later parts that the rows reach, ascending.
    beyond: Vec<u32>,
    /// Place of the column of each slot: among the own nodes, then among `beyond`.
    place: Vec<u32>,
    /// Blocks of the dashpots: places of row and column.
    dashpots: Vec<([u32; 2], [f64; 9])>,
    x: Vec<[f64; 3]>,
    y: Vec<[f64; 3]>,
}

impl Product {
    /// The matrix `combination` on the free dofs.
    pub fn new(matrices: Arc<Matrices>, supports: &Supports, combination: Combination) -> Product {
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
        Product { matrices, combination, parts, start, from, free }
    }

    /// The diagonal blocks by nodes, rows and columns of constrained dofs being those of the identity.
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

    /// Memory that it holds beside the matrices of the model [bytes].
    pub fn memory(&self) -> usize {
        let of_part =
            |p: &Part| 4 * (p.beyond.len() + p.place.len()) + 80 * p.dashpots.len() + 48 * p.x.len();
        self.parts.iter().map(of_part).sum::<usize>()
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
        let all = vec![[0.0; 3]; nodes.len() + beyond.len()];
        Part { nodes, beyond, place, dashpots: Vec::new(), x: all.clone(), y: all }
    }

    /// The products of the own rows and columns. `MASS`: the mass is not diagonal.
    fn multiply<const MASS: bool>(&mut self, matrices: &Matrices, c: Combination, x: &[[f64; 3]]) {
        let own = self.nodes.len();
        self.x[..own].copy_from_slice(&x[self.nodes.clone()]);
        for (to, &n) in self.x[own..].iter_mut().zip(&self.beyond) {
            *to = x[n as usize];
        }
        self.y.fill([0.0; 3]);
        let (blocks, mass) = (matrices.stiffness_blocks(), matrices.mass_entries());
        let first = matrices.slots(self.nodes.start).start;
        for p in 0..own {
            let slots = matrices.slots(self.nodes.start + p);
            let xp = self.x[p];
            let (mut sum, mut inertia) = ([0.0; 3], [0.0; 3]);
            let places = &self.place[slots.start - first..slots.end - first];
            for (i, (k, &place)) in blocks[slots.clone()].iter().zip(places).enumerate() {
                let xq = self.x[place as usize];
                for r in 0..3 {
                    sum[r] += k[3 * r] * xq[0] + k[3 * r + 1] * xq[1] + k[3 * r + 2] * xq[2];
                }
                let m = if MASS { c.mass * mass[slots.start + i] } else { 0.0 };
                if MASS {
                    (0..3).for_each(|r| inertia[r] += m * xq[r]);
                }
                // The diagonal comes first; it has no column of its own.
                if i > 0 {
                    let y = &mut self.y[place as usize];
                    for r in 0..3 {
                        let column = k[r] * xp[0] + k[3 + r] * xp[1] + k[6 + r] * xp[2];
                        y[r] += c.stiffness * column + if MASS { m * xp[r] } else { 0.0 };
                    }
                }
            }
            (0..3).for_each(|r| self.y[p][r] += c.stiffness * sum[r] + inertia[r]);
        }
        for &([p, q], d) in &self.dashpots {
            let ([xp, xq], p, q) = ([self.x[p as usize], self.x[q as usize]], p as usize, q as usize);
            for r in 0..3 {
                self.y[p][r] += c.dashpots * (d[3 * r] * xq[0] + d[3 * r + 1] * xq[1] + d[3 * r + 2] * xq[2]);
                if p != q {
                    self.y[q][r] += c.dashpots * (d[r] * xp[0] + d[3 + r] * xp[1] + d[6 + r] * xp[2]);
                }
            }
        }
    }
}

impl Operator for Product {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<3>().0, y.as_chunks_mut::<3>().0);
        let (matrices, c) = (&*self.matrices, self.combination);
        let lumped = if c.mass == 0.0 { None } else { matrices.lumped_mass() };
        let full = c.mass != 0.0 && lumped.is_none();
        self.parts.par_iter_mut().for_each(|part| {
            if full { part.multiply::<true>(matrices, c, x) } else { part.multiply::<false>(matrices, c, x) }
        });
        let (parts, start, from, free) = (&self.parts, &self.start, &self.from, &self.free);
        (parts.par_iter(), y.par_chunks_mut(NODES)).into_par_iter().for_each(|(part, y)| {
            for (i, (y, n)) in y.iter_mut().zip(part.nodes.clone()).enumerate() {
                let mut sum = part.y[i];
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
