//! Aggregates rows for the next level.
//!
//! Source: Vaněk, Mandel and Brezina (1996), section 5: a row with its strongly coupled rows, if all are
//! free, forms an aggregate; leftover rows join their strongest neighbour.

use super::rows::{BlockRows, PART};
use rayon::prelude::*;

/// Row without aggregate, coupled to no other.
pub const NONE: u32 = u32::MAX;

pub struct Aggregates {
    /// Aggregate by row, or [`NONE`].
    pub of: Vec<u32>,
    pub count: usize,
}

/// Strong couplings of each row: `|A_pq|² > threshold² |A_pp| |A_qq|` in the Frobenius norm.
fn strong<const N: usize>(rows: &impl BlockRows<N>, threshold: f64) -> Vec<Vec<(u32, f64)>> {
    let square = |b: &[[f64; N]; N]| b.iter().flatten().map(|v| v * v).sum::<f64>();
    let size: Vec<f64> = (0..rows.count())
        .map(|p| {
            let mut diagonal = 0.0;
            rows.visit(p, |q, b| {
                if p == q {
                    diagonal = square(b).sqrt();
                }
            });
            diagonal
        })
        .collect();
    (0..rows.count())
        .into_par_iter()
        .with_min_len(PART)
        .map(|p| {
            let mut coupled = Vec::new();
            rows.visit(p, |q, b| {
                let strength = square(b) / (size[p] * size[q]);
                if q != p && strength > threshold * threshold {
                    coupled.push((q as u32, strength));
                }
            });
            coupled
        })
        .collect()
}

pub fn aggregate<const N: usize>(rows: &impl BlockRows<N>, threshold: f64) -> Aggregates {
    let strong = strong(rows, threshold);
    let (mut of, mut count) = (vec![NONE; strong.len()], 0);
    for (p, coupled) in strong.iter().enumerate() {
        if !coupled.is_empty() && of[p] == NONE && coupled.iter().all(|&(q, _)| of[q as usize] == NONE) {
            of[p] = count;
            coupled.iter().for_each(|&(q, _)| of[q as usize] = count);
            count += 1;
        }
    }
    let first = of.clone();
    for (p, coupled) in strong.iter().enumerate().filter(|(p, _)| first[*p] == NONE) {
        let grouped = coupled.iter().filter(|(q, _)| first[*q as usize] != NONE);
        if let Some(&(q, _)) = grouped.reduce(|a, b| if b.1 > a.1 { b } else { a }) {
            of[p] = first[q as usize];
        }
    }
    for (p, coupled) in strong.iter().enumerate().filter(|(_, coupled)| !coupled.is_empty()) {
        if of[p] == NONE {
            of[p] = count;
            for &(q, _) in coupled {
                if of[q as usize] == NONE {
                    of[q as usize] = count;
                }
            }
            count += 1;
        }
    }
    Aggregates { of, count: count as usize }
}
