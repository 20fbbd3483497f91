//! Vector operations in parts of fixed size, reproducible for any number of threads.

use rayon::prelude::*;

/// Nodes per part.
pub const NODES: usize = 1024;
/// Values per part.
pub const VALUES: usize = 3 * NODES;
const LANES: usize = 8;

fn dot_part(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for l in 0..LANES {
            sum[l] += a[l] * b[l];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sum.iter().sum::<f64>() + rest
}

/// `a·b`; `partial` holds one sum per part.
pub fn dot(a: &[f64], b: &[f64], partial: &mut [f64]) -> f64 {
    (partial.par_iter_mut(), a.par_chunks(VALUES), b.par_chunks(VALUES))
        .into_par_iter()
        .for_each(|(sum, a, b)| *sum = dot_part(a, b));
    partial.iter().sum()
}

/// `y += factor x`.
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    (y.par_chunks_mut(VALUES), x.par_chunks(VALUES)).into_par_iter().for_each(|(y, x)| {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
    });
}

/// `y = x + factor y`.
pub fn scale_and_add(y: &mut [f64], factor: f64, x: &[f64]) {
    (y.par_chunks_mut(VALUES), x.par_chunks(VALUES)).into_par_iter().for_each(|(y, x)| {
        y.iter_mut().zip(x).for_each(|(y, x)| *y = x + factor * *y);
    });
}

/// `y = a - b`.
pub fn subtract(a: &[f64], b: &[f64], y: &mut [f64]) {
    (y.par_chunks_mut(VALUES), a.par_chunks(VALUES), b.par_chunks(VALUES)).into_par_iter().for_each(
        |(y, a, b)| {
            y.iter_mut().zip(a.iter().zip(b)).for_each(|(y, (a, b))| *y = a - b);
        },
    );
}

/// Number of parts.
pub fn parts(values: usize) -> usize {
    values.div_ceil(VALUES)
}
