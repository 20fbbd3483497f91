//! Galerkin matrix of the next level, `Pᵀ A P`.

use super::rows::{Block, BlockRows, Blocks};
use super::transfer::add_product;
use rayon::prelude::*;

/// Rows per chunk, computed in parallel and added in row order.
const CHUNK: usize = 256;
const NONE: u32 = u32::MAX;

/// `Pᵀ A P`, exactly symmetric; zero diagonal entries, of unused modes, become 1.
pub fn galerkin<const N: usize>(rows: &impl BlockRows<N>, p: &Blocks<N, 6>, columns: usize) -> Blocks<6, 6> {
    let mut sums: Vec<Vec<(u32, Block<6, 6>)>> = vec![Vec::new(); columns];
    let all: Vec<usize> = (0..rows.count()).collect();
    for chunk in all.chunks(CHUNK) {
        let parts: Vec<Vec<(u32, u32, Block<6, 6>)>> = chunk
            .par_iter()
            .map_init(|| vec![NONE; columns], |place, &row| contributions(rows, p, row, place))
            .collect();
        for (a, b, block) in parts.into_iter().flatten() {
            let row = &mut sums[a as usize];
            match row.binary_search_by_key(&b, |(c, _)| *c) {
                Ok(k) => row[k].1.iter_mut().flatten().zip(block.iter().flatten()).for_each(|(s, v)| *s += v),
                Err(k) => row.insert(k, (b, block)),
            }
        }
    }
    let upper: Vec<Vec<(u32, Block<6, 6>)>> = sums;
    let mut whole: Vec<Vec<(u32, Block<6, 6>)>> = vec![Vec::new(); columns];
    for (a, row) in upper.into_iter().enumerate() {
        for (b, mut block) in row {
            if b as usize == a {
                let given = block;
                for i in 0..6 {
                    (0..6).for_each(|j| block[i][j] = 0.5 * (given[i][j] + given[j][i]));
                    if given[i][i] <= 0.0 {
                        block[i][i] = 1.0;
                    }
                }
            } else {
                let mirror = std::array::from_fn(|i| std::array::from_fn(|j| block[j][i]));
                whole[b as usize].push((a as u32, mirror));
            }
            whole[a].push((b, block));
        }
    }
    whole.iter_mut().for_each(|row| row.sort_unstable_by_key(|(b, _)| *b));
    Blocks::from_rows(whole.into_iter())
}

/// `P_rowᵀ (A P)_row` on and above the diagonal. `place` is scratch, all [`NONE`].
fn contributions<const N: usize>(
    rows: &impl BlockRows<N>,
    p: &Blocks<N, 6>,
    row: usize,
    place: &mut [u32],
) -> Vec<(u32, u32, Block<6, 6>)> {
    let mut product: Vec<(u32, Block<N, 6>)> = Vec::new();
    rows.visit(row, |q, a| {
        for (c, block) in p.row(q) {
            if place[c] == NONE {
                place[c] = product.len() as u32;
                product.push((c as u32, [[0.0; 6]; N]));
            }
            add_product(&mut product[place[c] as usize].1, a, block);
        }
    });
    product.iter().for_each(|(c, _)| place[*c as usize] = NONE);
    let mut contributions = Vec::new();
    for (a, left) in p.row(row) {
        let transposed: Block<6, N> = std::array::from_fn(|i| std::array::from_fn(|k| left[k][i]));
        for (b, right) in product.iter().filter(|(b, _)| *b as usize >= a) {
            let mut block = [[0.0; 6]; 6];
            add_product(&mut block, &transposed, right);
            contributions.push((a as u32, *b, block));
        }
    }
    contributions
}
