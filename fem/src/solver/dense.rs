//! Dense kernels of a front on tiles of fixed size, bitwise independent of the number of threads.

use faer::dyn_stack::MemStack;
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place};
use faer::linalg::lu::partial_pivoting::factor::lu_in_place;
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

pub(super) const TILE: usize = 128;
const ROWS: usize = 384;
const PANEL: usize = 128;

/// Update length in whole cache lines.
pub(super) fn update_len(below: usize) -> usize {
    let blocks = below.div_ceil(TILE);
    (0..blocks).map(|b| (below - b * TILE) * TILE.min(below - b * TILE)).sum::<usize>().next_multiple_of(8)
}

pub(super) fn block_start(below: usize, block: usize) -> usize {
    TILE * (block * below) - TILE * TILE * (block * block.saturating_sub(1) / 2)
}

pub(super) fn column<'a>(tile: &'a mut MatMut<'_, f64>, j: usize) -> &'a mut [f64] {
    tile.as_mut().col_mut(j).try_as_col_major_mut().expect("views are column-major").as_slice_mut()
}

/// `f(first column, first row, tile)` on every tile of the update.
pub(super) fn for_update_tiles<F>(update: &mut [f64], below: usize, parallel: bool, f: &F)
where
    F: Fn(usize, usize, MatMut<'_, f64>) + Sync,
{
    let blocks = below.div_ceil(TILE);
    halve_blocks(update, below, 0, blocks, parallel, f);
}

fn halve_blocks<F>(update: &mut [f64], below: usize, first: usize, end: usize, parallel: bool, f: &F)
where
    F: Fn(usize, usize, MatMut<'_, f64>) + Sync,
{
    if end - first > 1 {
        let middle = first.midpoint(end);
        let (left, right) = update.split_at_mut(block_start(below, middle) - block_start(below, first));
        both(
            parallel,
            || halve_blocks(left, below, first, middle, parallel, f),
            || halve_blocks(right, below, middle, end, parallel, f),
        );
    } else if end > first {
        let start = first * TILE;
        let (rows, columns) = (below - start, TILE.min(below - start));
        let block = MatMut::from_column_major_slice_mut(&mut update[..rows * columns], rows, columns);
        let (top, rest) = block.split_at_row_mut(columns);
        both(
            parallel && rows > columns,
            || f(start, start, top),
            || {
                if rows > columns {
                    for_rows(rest, start + columns, parallel, &|row, tile| f(start, row, tile));
                }
            },
        );
    }
}

/// `f(first row, rows)` on row chunks, or all rows if sequential.
pub(super) fn for_rows<F>(matrix: MatMut<'_, f64>, first: usize, parallel: bool, f: &F)
where
    F: Fn(usize, MatMut<'_, f64>) + Sync,
{
    let rows = matrix.nrows();
    if !parallel || rows <= ROWS {
        f(first, matrix);
        return;
    }
    let middle = rows.div_ceil(ROWS) / 2 * ROWS;
    let (top, bottom) = matrix.split_at_row_mut(middle);
    rayon::join(|| for_rows(top, first, true, f), || for_rows(bottom, first + middle, true, f));
}

/// `f(first column, columns)` on column chunks, or all columns if sequential.
pub(super) fn for_columns<F>(matrix: MatMut<'_, f64>, first: usize, parallel: bool, f: &F)
where
    F: Fn(usize, MatMut<'_, f64>) + Sync,
{
    let columns = matrix.ncols();
    if !parallel || columns <= PANEL {
        f(first, matrix);
        return;
    }
    let middle = columns.div_ceil(PANEL) / 2 * PANEL;
    let (left, right) = matrix.split_at_col_mut(middle);
    rayon::join(|| for_columns(left, first, true, f), || for_columns(right, first + middle, true, f));
}

fn both(parallel: bool, a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    if parallel {
        rayon::join(a, b);
    } else {
        a();
        b();
    }
}

/// `tile = -a b^T`; lower triangle on the diagonal.
pub(super) fn product(tile: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>, diagonal: bool) {
    if diagonal {
        use BlockStructure::{Rectangular, TriangularLower};
        let (accum, b) = (Accum::Replace, b.transpose());
        triangular::matmul(tile, TriangularLower, accum, a, Rectangular, b, Rectangular, -1.0, Par::Seq);
    } else {
        matmul(tile, Accum::Replace, a, b.transpose(), -1.0, Par::Seq);
    }
}

/// Factors `[L11; L21]` of a symmetric front in place.
///
/// # Errors
/// Column of a nonpositive pivot.
pub(super) fn cholesky(
    mut panel: MatMut<'_, f64>,
    parallel: bool,
    stack: &mut MemStack,
) -> Result<(), usize> {
    let width = panel.ncols();
    let step = if parallel { PANEL } else { width };
    for j in (0..width).step_by(step.max(1)) {
        let next = (j + step).min(width);
        let (done, right) = panel.as_mut().split_at_col_mut(j);
        let (_, mut now) = right.subcols_mut(0, next - j).split_at_row_mut(j);
        let done = done.as_ref().subrows(j, now.nrows());
        if j > 0 {
            // Left-looking: all finished columns update these together.
            let pivots = done.subrows(0, next - j);
            for_rows(now.as_mut(), 0, parallel, &|row, tile| {
                let rows = done.subrows(row, tile.nrows());
                matmul(tile, Accum::Add, rows, pivots.transpose(), -1.0, Par::Seq);
            });
        }
        let (mut pivots, rest) = now.split_at_row_mut(next - j);
        cholesky_in_place(pivots.as_mut(), Default::default(), Par::Seq, stack, Default::default())
            .map_err(|LltError::NonPositivePivot { index }| j + index)?;
        let pivots = pivots.as_ref();
        if rest.nrows() > 0 {
            for_rows(rest, 0, parallel, &|_, tile| {
                solve_lower_triangular_in_place(pivots, tile.transpose_mut(), Par::Seq);
            });
        }
    }
    Ok(())
}

pub(super) struct Exchange {
    found: Vec<u32>,
    inverse: Vec<u32>,
    rows: Vec<u32>,
    column: Vec<f64>,
}

impl Exchange {
    pub fn new(width: usize) -> Exchange {
        let zeros = || vec![0; width];
        Exchange { found: zeros(), inverse: zeros(), rows: zeros(), column: vec![0.0; width] }
    }

    pub fn bytes(&self) -> usize {
        20 * self.column.len()
    }
}

/// Factors a pivot block in place, `P A = L U`; row i is exchanged with `exchanges[i] >= i`, in order.
pub(super) fn lu(
    mut block: MatMut<'_, f64>,
    exchanges: &mut [u32],
    exchange: &mut Exchange,
    parallel: bool,
    stack: &mut MemStack,
) {
    let width = block.ncols();
    let step = if parallel { PANEL } else { width };
    let rows = &mut *exchanges;
    rows.iter_mut().enumerate().for_each(|(i, row)| *row = i as u32);
    for j in (0..width).step_by(step.max(1)) {
        let (next, left_rows) = ((j + step).min(width), width - j);
        {
            let now = block.as_mut().submatrix_mut(j, j, left_rows, next - j);
            let (found, inverse) = (&mut exchange.found[..left_rows], &mut exchange.inverse[..left_rows]);
            lu_in_place(now, found, inverse, Par::Seq, stack, Default::default());
        }
        let found = &exchange.found[..left_rows];
        if found.iter().enumerate().any(|(i, &f)| i != f as usize) {
            let swap = &mut exchange.rows[..left_rows];
            swap.copy_from_slice(&rows[j..]);
            rows[j..].iter_mut().zip(found).for_each(|(row, &f)| *row = swap[f as usize]);
            for c in (0..j).chain(next..width) {
                let column = &mut column(&mut block, c)[j..];
                let former = &mut exchange.column[..left_rows];
                former.copy_from_slice(column);
                column.iter_mut().zip(found).for_each(|(x, &f)| *x = former[f as usize]);
            }
        }
        if next == width {
            break;
        }
        let (left, right) = block.as_mut().split_at_col_mut(next);
        let left = left.as_ref().submatrix(j, j, left_rows, next - j);
        let right = right.subrows_mut(j, left_rows);
        let (pivots, below) = left.split_at_row(next - j);
        for_columns(right, 0, parallel, &|_, columns| {
            let (mut top, bottom) = columns.split_at_row_mut(next - j);
            solve_unit_lower_triangular_in_place(pivots, top.as_mut(), Par::Seq);
            matmul(bottom, Accum::Add, below, top.as_ref(), -1.0, Par::Seq);
        });
    }
    // Converts the row order to successive exchanges.
    let (found, place) = (&mut exchange.found[..width], &mut exchange.inverse[..width]);
    for i in 0..width {
        (found[i], place[i]) = (i as u32, i as u32);
    }
    for i in 0..width {
        let (wanted, at) = (exchanges[i] as usize, place[exchanges[i] as usize]);
        let moved = found[i];
        (found[at as usize], place[moved as usize]) = (moved, at);
        (found[i], place[wanted]) = (wanted as u32, i as u32);
        exchanges[i] = at;
    }
}

/// `second = (L11^-1 P A12)^T`.
pub(super) fn solve_second(
    mut second: MatMut<'_, f64>,
    block: MatRef<'_, f64>,
    exchanges: &[u32],
    parallel: bool,
) {
    if second.nrows() == 0 {
        return;
    }
    for (i, &j) in exchanges.iter().enumerate().filter(|&(i, &j)| i != j as usize) {
        let (left, mut right) = second.as_mut().split_at_col_mut(j as usize);
        let mut left = left.subcols_mut(i, 1);
        column(&mut left, 0).swap_with_slice(column(&mut right, 0));
    }
    for_rows(second, 0, parallel, &|_, tile| {
        solve_unit_lower_triangular_in_place(block, tile.transpose_mut(), Par::Seq);
    });
}

/// `first = A21 U11^-1`.
pub(super) fn solve_first(first: MatMut<'_, f64>, block: MatRef<'_, f64>, parallel: bool) {
    if first.nrows() == 0 {
        return;
    }
    for_rows(first, 0, parallel, &|_, tile| {
        solve_lower_triangular_in_place(block.transpose(), tile.transpose_mut(), Par::Seq);
    });
}
