//! Smoothed prolongator between levels.
//!
//! T is an orthonormal basis of the rigid-body modes of each aggregate, smoothed by damped Jacobi,
//! `P = (I - omega D⁻¹ A) T`.
//!
//! Source: Vaněk, Mandel and Brezina (1996), sections 2 to 4, omega = 4/(3 lambda), lambda the largest
//! eigenvalue of D⁻¹ A. Aggregates with fewer free dofs than modes have zero columns.

use super::aggregates::{Aggregates, NONE};
use super::rows::{Block, BlockRows, Blocks, PART};
use rayon::prelude::*;

/// Relative norm below which a mode is linearly dependent.
const DEPENDENT: f64 = 1e-10;

pub struct Transfer<const N: usize> {
    /// Rows of the level, columns of the next.
    pub prolongator: Blocks<N, 6>,
    entries: Vec<[u32; 2]>,
    start: Vec<usize>,
}

/// Orthonormal modes on each aggregate, by rows, and modes of the next level.
pub fn tentative<const N: usize>(
    aggregates: &Aggregates,
    modes: &[Block<N, 6>],
) -> (Vec<Block<N, 6>>, Vec<Block<6, 6>>) {
    let mut members = vec![Vec::new(); aggregates.count];
    for (p, &group) in aggregates.of.iter().enumerate().filter(|(_, g)| **g != NONE) {
        members[group as usize].push(p);
    }
    let (mut base, mut next) = (vec![[[0.0; 6]; N]; modes.len()], Vec::with_capacity(members.len()));
    for rows in &members {
        rows.iter().for_each(|&p| base[p] = modes[p]);
        let mut triangle = [[0.0; 6]; 6];
        for j in 0..6 {
            let dot = |base: &[Block<N, 6>], a: usize, b: usize| {
                rows.iter().map(|&p| base[p].iter().map(|row| row[a] * row[b]).sum::<f64>()).sum::<f64>()
            };
            let before = dot(&base, j, j).sqrt();
            // Twice is enough (Giraud, Langou and Rozložník, Comput. Math. Appl. 50 (2005) 1069-1075).
            for _ in 0..2 {
                for i in 0..j {
                    let part = dot(&base, i, j);
                    triangle[i][j] += part;
                    rows.iter().for_each(|&p| base[p].iter_mut().for_each(|row| row[j] -= part * row[i]));
                }
            }
            let length = dot(&base, j, j).sqrt();
            let scale = if length > DEPENDENT * before { 1.0 / length } else { 0.0 };
            triangle[j][j] = if scale > 0.0 { length } else { 0.0 };
            rows.iter().for_each(|&p| base[p].iter_mut().for_each(|row| row[j] *= scale));
        }
        next.push(triangle);
    }
    (base, next)
}

impl<const N: usize> Transfer<N> {
    /// Smooths the tentative prolongator of these aggregates. `inverse`: D⁻¹.
    pub fn new(
        rows: &impl BlockRows<N>,
        aggregates: &Aggregates,
        base: &[Block<N, 6>],
        inverse: &[Block<N, N>],
        omega: f64,
    ) -> Transfer<N> {
        let smoothed: Vec<_> = (0..rows.count())
            .into_par_iter()
            .with_min_len(PART)
            .map(|p| {
                let mut row: Vec<(u32, Block<N, 6>)> = Vec::new();
                let at = |row: &mut Vec<(u32, Block<N, 6>)>, group: u32| {
                    row.iter().position(|(g, _)| *g == group).unwrap_or_else(|| {
                        row.push((group, [[0.0; 6]; N]));
                        row.len() - 1
                    })
                };
                rows.visit(p, |q, a| {
                    let group = aggregates.of[q];
                    if group != NONE {
                        let k = at(&mut row, group);
                        add_product(&mut row[k].1, a, &base[q]);
                    }
                });
                for (_, sum) in &mut row {
                    let mut damped = [[0.0; 6]; N];
                    add_product(&mut damped, &inverse[p], sum);
                    *sum = damped.map(|r| r.map(|v| -omega * v));
                }
                if aggregates.of[p] != NONE {
                    let k = at(&mut row, aggregates.of[p]);
                    let sums = row[k].1.iter_mut().flatten();
                    sums.zip(base[p].iter().flatten()).for_each(|(s, t)| *s += t);
                }
                row.sort_unstable_by_key(|(group, _)| *group);
                row
            })
            .collect();
        let prolongator = Blocks::from_rows(smoothed.into_iter());
        let mut start = vec![0; aggregates.count + 1];
        prolongator.column.iter().for_each(|&c| start[c as usize + 1] += 1);
        (0..aggregates.count).for_each(|c| start[c + 1] += start[c]);
        let (mut next, mut entries) = (start.clone(), vec![[0; 2]; prolongator.column.len()]);
        for p in 0..prolongator.len() {
            for place in prolongator.start[p]..prolongator.start[p + 1] {
                let column = prolongator.column[place] as usize;
                entries[next[column]] = [p as u32, place as u32];
                next[column] += 1;
            }
        }
        Transfer { prolongator, entries, start }
    }

    /// `coarse = Pᵀ r`.
    pub fn restrict(&self, r: &[f64], coarse: &mut [f64]) {
        let (r, coarse) = (r.as_chunks::<N>().0, coarse.as_chunks_mut::<6>().0);
        coarse.par_iter_mut().enumerate().for_each(|(c, sum)| {
            *sum = [0.0; 6];
            for &[p, place] in &self.entries[self.start[c]..self.start[c + 1]] {
                for (row, r) in self.prolongator.value[place as usize].iter().zip(&r[p as usize]) {
                    (0..6).for_each(|j| sum[j] += row[j] * r);
                }
            }
        });
    }

    pub fn memory(&self) -> usize {
        self.prolongator.memory() + size_of_val(&self.entries[..]) + size_of_val(&self.start[..])
    }
}

pub fn add_product<const N: usize, const K: usize>(sum: &mut Block<N, 6>, a: &Block<N, K>, b: &Block<K, 6>) {
    for (sum, a) in sum.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            (0..6).for_each(|j| sum[j] += a * b[j]);
        }
    }
}
