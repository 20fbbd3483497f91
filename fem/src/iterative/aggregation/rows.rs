//! Block matrices by rows.

use super::super::matrix_product::MatrixProduct;
use crate::assembly::Matrices;
use crate::solver::conjugate::Operator;
use rayon::prelude::*;

/// Rows per parallel task.
pub const PART: usize = 64;

pub type Block<const R: usize, const C: usize> = [[f64; C]; R];

/// Square block matrix by rows.
pub trait BlockRows<const N: usize>: Sync {
    /// Number of block rows.
    fn count(&self) -> usize;

    /// Visits the entries of row `p`, including the diagonal, in fixed order.
    fn visit(&self, p: usize, take: impl FnMut(usize, &Block<N, N>));
}

/// Free-dof stiffness from its upper half, with identity rows for constrained dofs.
pub struct UpperTriangle<'a> {
    matrices: &'a Matrices,
    free: &'a [[bool; 3]],
    below: Vec<[u32; 2]>,
    start: Vec<u32>,
}

impl<'a> UpperTriangle<'a> {
    pub fn new(product: &'a MatrixProduct) -> UpperTriangle<'a> {
        let (matrices, free) = (product.matrices(), product.free());
        let nodes = matrices.node_count();
        let mut start = vec![0_u32; nodes + 1];
        let above = |p: usize| matrices.row(p)[1..].iter().map(|&q| q as usize);
        (0..nodes).flat_map(above).for_each(|q| start[q + 1] += 1);
        (0..nodes).for_each(|n| start[n + 1] += start[n]);
        let (mut next, mut below) = (start.clone(), vec![[0; 2]; start[nodes] as usize]);
        for p in 0..nodes {
            for (slot, q) in (matrices.slots(p).start + 1..).zip(above(p)) {
                below[next[q] as usize] = [p as u32, slot as u32];
                next[q] += 1;
            }
        }
        UpperTriangle { matrices, free, below, start }
    }
}

impl BlockRows<3> for UpperTriangle<'_> {
    fn count(&self) -> usize {
        self.free.len()
    }

    fn visit(&self, p: usize, mut take: impl FnMut(usize, &Block<3, 3>)) {
        let blocks = self.matrices.stiffness_blocks();
        let mut masked = |q: usize, mut block: Block<3, 3>| {
            for i in 0..3 {
                for j in 0..3 {
                    if !(self.free[p][i] && self.free[q][j]) {
                        block[i][j] = f64::from(u8::from(p == q && i == j));
                    }
                }
            }
            take(q, &block);
        };
        for &[q, slot] in &self.below[self.start[p] as usize..self.start[p + 1] as usize] {
            let k = &blocks[slot as usize];
            masked(q as usize, [[k[0], k[3], k[6]], [k[1], k[4], k[7]], [k[2], k[5], k[8]]]);
        }
        for (k, &q) in blocks[self.matrices.slots(p)].iter().zip(self.matrices.row(p)) {
            masked(q as usize, [[k[0], k[1], k[2]], [k[3], k[4], k[5]], [k[6], k[7], k[8]]]);
        }
    }
}

/// Block matrix by rows, columns ascending.
pub struct Blocks<const R: usize, const C: usize> {
    pub start: Vec<usize>,
    pub column: Vec<u32>,
    pub value: Vec<Block<R, C>>,
}

impl<const R: usize, const C: usize> Blocks<R, C> {
    pub fn from_rows(rows: impl Iterator<Item = Vec<(u32, Block<R, C>)>>) -> Blocks<R, C> {
        let mut blocks = Blocks { start: vec![0], column: Vec::new(), value: Vec::new() };
        for row in rows {
            blocks.column.extend(row.iter().map(|(c, _)| *c));
            blocks.value.extend(row.iter().map(|(_, v)| *v));
            blocks.start.push(blocks.column.len());
        }
        blocks
    }

    pub fn row(&self, p: usize) -> impl Iterator<Item = (usize, &Block<R, C>)> {
        let row = self.start[p]..self.start[p + 1];
        self.column[row.clone()].iter().map(|&c| c as usize).zip(&self.value[row])
    }

    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// `y = A x`, or `y += A x`. Shapes `[R * rows]`, `[C * columns]`.
    pub fn times(&self, x: &[f64], y: &mut [f64], add: bool) {
        let (x, y) = (x.as_chunks::<C>().0, y.as_chunks_mut::<R>().0);
        y.par_chunks_mut(PART).enumerate().for_each(|(k, y)| {
            for (p, y) in (k * PART..).zip(y) {
                let mut sum = if add { *y } else { [0.0; R] };
                for (q, a) in self.row(p) {
                    for i in 0..R {
                        sum[i] += (0..C).map(|j| a[i][j] * x[q][j]).sum::<f64>();
                    }
                }
                *y = sum;
            }
        });
    }

    pub fn memory(&self) -> usize {
        size_of_val(&self.value[..]) + size_of_val(&self.column[..]) + size_of_val(&self.start[..])
    }
}

impl BlockRows<6> for Blocks<6, 6> {
    fn count(&self) -> usize {
        self.len()
    }

    fn visit(&self, p: usize, mut take: impl FnMut(usize, &Block<6, 6>)) {
        self.row(p).for_each(|(q, block)| take(q, block));
    }
}

impl Operator for Blocks<6, 6> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        self.times(x, y, false);
    }
}
