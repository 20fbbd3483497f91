//! Groups of rows that become one row of the next level.
//!
//! Source: Vaněk, Mandel and Brezina, Computing 56 (1996) 179-196, section 5: groups of a row and all that it is strongly coupled
//! to, where none of these has a group yet; what is left joins the group that it is coupled to most.

use super::rows::{PART, Rows};
use rayon::prelude::*;

/// A row that has no group: one that is coupled to none.
pub const NONE: u32 = u32::MAX;

/// The group of each row.
pub struct Aggregates {
    /// Group by row, or [`NONE`].
    pub of: Vec<u32>,
    /// Number of groups.
    pub count: usize,
}

/// Rows that each row is strongly coupled to, with the strength: `|A_pq|² > threshold² |A_pp| |A_qq|` in the norm of Frobenius.
fn strong<const N: usize>(rows: &impl Rows<N>, threshold: f64) -> Vec<Vec<(u32, f64)>> {
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

/// Groups the rows of a matrix.
pub fn aggregate<const N: usize>(rows: &impl Rows<N>, threshold: f64) -> Aggregates {
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
