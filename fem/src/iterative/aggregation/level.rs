//! Multigrid level: matrix, Chebyshev smoother in D⁻¹ A (D: diagonal blocks), transfer.
//!
//! Source: Adams, Brezina, Hu and Tuminaro (2003); recurrence: Saad (2003), algorithm 12.1.

use super::rows::{Block, PART};
use super::transfer::Transfer;
use crate::solver::conjugate::Operator;
use crate::solver::conjugate::vectors::{add_scaled, dot, parts, subtract};
use rayon::prelude::*;

/// Of degrees 2 to 5 and ranges 6 to 60, this pair needed fewest iterations on an embankment of 23,873
/// nodes.
const DEGREE: usize = 5;
/// Ratio of the largest to the smallest smoothed eigenvalue.
const RANGE: f64 = 60.0;
/// Power iterations, and the margin for their underestimate.
const POWER: usize = 15;
const MARGIN: f64 = 1.1;

/// Level with N unknowns per row.
pub struct Level<const N: usize, A> {
    matrix: A,
    inverse: Vec<Block<N, N>>,
    largest: f64,
    transfer: Transfer<N>,
    r: Vec<f64>,
    d: Vec<f64>,
    q: Vec<f64>,
}

/// Largest eigenvalue of D⁻¹ A, with a margin.
pub fn largest_eigenvalue<const N: usize>(matrix: &mut impl Operator, inverse: &[Block<N, N>]) -> f64 {
    let values = N * inverse.len();
    let mut partial = vec![0.0; parts(values)];
    // Knuth's linear congruential generator.
    let mut seed = 1_u64;
    let mut x: Vec<f64> = (0..values)
        .map(|_| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect();
    let (mut y, mut value) = (vec![0.0; values], 1.0);
    for _ in 0..POWER {
        let length = dot(&x, &x, &mut partial).sqrt();
        x.iter_mut().for_each(|x| *x /= length);
        matrix.apply(&x, &mut y);
        blocks_times(inverse, &y, &mut x, |z, _| z);
        value = dot(&x, &x, &mut partial).sqrt();
    }
    MARGIN * value
}

fn blocks_times<const N: usize>(
    inverse: &[Block<N, N>],
    r: &[f64],
    z: &mut [f64],
    f: impl Fn(f64, f64) -> f64 + Sync,
) {
    let (r, z) = (r.as_chunks::<N>().0, z.as_chunks_mut::<N>().0);
    (z.par_chunks_mut(PART), r.par_chunks(PART), inverse.par_chunks(PART)).into_par_iter().for_each(
        |(z, r, inverse)| {
            for (z, (r, a)) in z.iter_mut().zip(r.iter().zip(inverse)) {
                *z = std::array::from_fn(|i| f((0..N).map(|j| a[i][j] * r[j]).sum(), z[i]));
            }
        },
    );
}

impl<const N: usize, A: Operator> Level<N, A> {
    pub fn new(matrix: A, inverse: Vec<Block<N, N>>, largest: f64, transfer: Transfer<N>) -> Level<N, A> {
        let zero = || vec![0.0; N * inverse.len()];
        let (r, d, q) = (zero(), zero(), zero());
        Level { matrix, inverse, largest, transfer, r, d, q }
    }

    /// Smooths from zero, `x` near `A⁻¹ b`, and restricts the residual.
    pub fn descend(&mut self, b: &[f64], x: &mut [f64], coarse: &mut [f64]) {
        x.fill(0.0);
        self.r.copy_from_slice(b);
        self.smooth(x);
        self.matrix.apply(&self.d, &mut self.q);
        add_scaled(&mut self.r, -1.0, &self.q);
        self.transfer.restrict(&self.r, coarse);
    }

    /// Adds the coarse correction and smooths again.
    pub fn ascend(&mut self, b: &[f64], x: &mut [f64], coarse: &[f64]) {
        self.transfer.prolongator.times(coarse, x, true);
        self.matrix.apply(x, &mut self.q);
        subtract(b, &self.q, &mut self.r);
        self.smooth(x);
    }

    /// Last change in `d` is not yet subtracted from the residual `r`.
    fn smooth(&mut self, x: &mut [f64]) {
        let (low, high) = (self.largest / RANGE, self.largest);
        let (centre, half) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = centre / half;
        let mut rho = 1.0 / sigma;
        blocks_times(&self.inverse, &self.r, &mut self.d, |z, _| z / centre);
        add_scaled(x, 1.0, &self.d);
        for _ in 1..DEGREE {
            self.matrix.apply(&self.d, &mut self.q);
            add_scaled(&mut self.r, -1.0, &self.q);
            let next = 1.0 / (2.0 * sigma - rho);
            let (of_change, of_residual) = (next * rho, 2.0 * next / half);
            blocks_times(&self.inverse, &self.r, &mut self.d, |z, d| of_change * d + of_residual * z);
            rho = next;
            add_scaled(x, 1.0, &self.d);
        }
    }

    pub fn matrix(&self) -> &A {
        &self.matrix
    }

    pub fn memory(&self) -> usize {
        size_of_val(&self.inverse[..]) + 24 * self.r.len() + self.transfer.memory()
    }
}
