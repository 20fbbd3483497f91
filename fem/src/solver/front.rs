//! Assembly, elimination and update of one front.

use super::dense::{self, Exchange, TILE, block_start, column, for_columns, for_update_tiles};
use super::pattern::MIRRORED;
use super::structure::{Run, Structure};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::{MatMut, MatRef, Par};
use std::ops::Range;

/// Flops above which threads share a front.
const SHARED_FLOPS: f64 = 2e7;

#[derive(Clone, Copy)]
pub(super) struct Updates<'a> {
    pub work: &'a [f64],
    pub work_start: usize,
    /// Updates from branches to upper fronts.
    pub exported: &'a [f64],
    /// Triangles per update: 1 or 2.
    pub triangles: usize,
}

impl<'a> Updates<'a> {
    fn get(&self, structure: &Structure, c: usize, which: usize) -> &'a [f64] {
        let len = dense::update_len(structure.below(c));
        let start = self.triangles * structure.update[c] + which * len;
        if structure.exported[c] {
            &self.exported[start..start + len]
        } else {
            &self.work[start - self.work_start..][..len]
        }
    }
}

pub(super) struct Scratch {
    memory: MemBuffer,
    exchange: Exchange,
}

impl Scratch {
    pub fn new(width: usize) -> Scratch {
        use faer::linalg::cholesky::llt::factor::cholesky_in_place_scratch;
        use faer::linalg::lu::partial_pivoting::factor::lu_in_place_scratch;
        let llt = cholesky_in_place_scratch::<f64>(width, Par::Seq, Default::default());
        let lu = lu_in_place_scratch::<u32, f64>(width, width, Par::Seq, Default::default());
        Scratch { memory: MemBuffer::new(StackReq::or(llt, lu)), exchange: Exchange::new(width) }
    }

    pub fn bytes(&self) -> usize {
        self.memory.len() + self.exchange.bytes()
    }
}

/// Factors a symmetric front.
///
/// # Errors
/// Column of a nonpositive pivot.
pub(super) fn factor_symmetric(
    structure: &Structure,
    s: usize,
    lower: &[f64],
    panel: &mut [f64],
    update: &mut [f64],
    children: Updates<'_>,
    shared: bool,
    scratch: &mut Scratch,
) -> Result<(), usize> {
    let (width, below) = (structure.width(s), structure.below(s));
    let rows = width + below;
    let parallel = shared && structure.front_flops(s) > SHARED_FLOPS;
    let mut panel = MatMut::from_column_major_slice_mut(&mut panel[..rows * width], rows, width);
    for_columns(panel.as_mut(), 0, parallel, &|first, mut tile| {
        tile.fill(0.0);
        for &c in structure.children(s) {
            let c = c as usize;
            add(structure, c, children.get(structure, c, 0), &mut tile, (0, first), true);
        }
    });
    for (j, equation) in structure.columns(s).enumerate() {
        let entries = structure.entry_start[equation]..structure.entry_start[equation + 1];
        let column = column(&mut panel, j);
        for k in entries {
            column[structure.entry_row[k] as usize] +=
                lower[(structure.entry_source[k] & !MIRRORED) as usize];
        }
    }
    dense::cholesky(panel.as_mut(), parallel, MemStack::new(&mut scratch.memory))?;
    let l = panel.as_ref().subrows(width, below);
    for_update_tiles(update, below, parallel, &|first, row, mut tile| {
        let (a, b) = (l.subrows(row, tile.nrows()), l.subrows(first, tile.ncols()));
        dense::product(tile.as_mut(), a, b, first == row);
        for &c in structure.children(s) {
            let c = c as usize;
            let child = children.get(structure, c, 0);
            add(structure, c, child, &mut tile, (width + row, width + first), true);
        }
    });
    Ok(())
}

/// `first`: pivot block and rows below; `second`: transposed columns right of it.
pub(super) struct Panels<'a> {
    pub first: &'a mut [f64],
    pub second: &'a mut [f64],
    /// Row exchanges in the pivot block, in order.
    pub rows: &'a mut [u32],
}

/// Factors an unsymmetric front.
///
/// # Errors
/// Column of a zero or nonfinite pivot.
pub(super) fn factor_unsymmetric(
    structure: &Structure,
    s: usize,
    values: (&[f64], &[f64]),
    panels: Panels<'_>,
    update: &mut [f64],
    children: Updates<'_>,
    shared: bool,
    scratch: &mut Scratch,
) -> Result<(), usize> {
    let (width, below) = (structure.width(s), structure.below(s));
    let rows = width + below;
    let parallel = shared && 2.0 * structure.front_flops(s) > SHARED_FLOPS;
    let mut first = MatMut::from_column_major_slice_mut(&mut panels.first[..rows * width], rows, width);
    let mut second = MatMut::from_column_major_slice_mut(&mut panels.second[..below * width], below, width);
    for_columns(first.as_mut(), 0, parallel, &|start, mut tile| {
        tile.fill(0.0);
        for &c in structure.children(s) {
            let c = c as usize;
            add(structure, c, children.get(structure, c, 0), &mut tile, (0, start), true);
            add_mirrored(structure, c, children.get(structure, c, 1), &mut tile, start);
        }
    });
    for_columns(second.as_mut(), 0, parallel, &|start, mut tile| {
        tile.fill(0.0);
        for &c in structure.children(s) {
            let c = c as usize;
            add(structure, c, children.get(structure, c, 1), &mut tile, (width, start), false);
        }
    });
    scatter_unsymmetric(structure, s, values, &mut first, &mut second);
    let (mut block, rest) = first.as_mut().split_at_row_mut(width);
    let stack = MemStack::new(&mut scratch.memory);
    dense::lu(block.as_mut(), panels.rows, &mut scratch.exchange, parallel, stack);
    let block = block.as_ref();
    if let Some(j) = (0..width).find(|&j| !(block[(j, j)] != 0.0 && block[(j, j)].is_finite())) {
        return Err(j);
    }
    dense::solve_first(rest, block, parallel);
    dense::solve_second(second.as_mut(), block, panels.rows, parallel);
    let (l, u) = (first.as_ref().subrows(width, below), second.as_ref());
    let (low, high) = update.split_at_mut(update.len() / 2);
    for (triangle, which, a, b) in [(low, 0, l, u), (high, 1, u, l)] {
        for_update_tiles(triangle, below, parallel, &|start, row, mut tile| {
            let (a, b) = (a.subrows(row, tile.nrows()), b.subrows(start, tile.ncols()));
            dense::product(tile.as_mut(), a, b, start == row);
            for &c in structure.children(s) {
                let c = c as usize;
                let child = children.get(structure, c, which);
                add(structure, c, child, &mut tile, (width + row, width + start), which == 0);
            }
        });
    }
    Ok(())
}

fn scatter_unsymmetric(
    structure: &Structure,
    s: usize,
    (lower, upper): (&[f64], &[f64]),
    first: &mut MatMut<'_, f64>,
    second: &mut MatMut<'_, f64>,
) {
    let width = structure.width(s);
    for (j, equation) in structure.columns(s).enumerate() {
        for k in structure.entry_start[equation]..structure.entry_start[equation + 1] {
            let (row, source) = (structure.entry_row[k] as usize, structure.entry_source[k]);
            let place = (source & !MIRRORED) as usize;
            let (below, right) = if source & MIRRORED == 0 {
                (lower[place], upper[place])
            } else {
                (upper[place], lower[place])
            };
            first[(row, j)] += below;
            if row >= width {
                second[(row - width, j)] += right;
            } else if row != j {
                first[(j, row)] += right;
            }
        }
    }
}

fn overlap(structure: &Structure, c: usize, range: Range<usize>) -> Range<usize> {
    let local = structure.local(c);
    let at = |bound: usize| local.partition_point(|&p| (p as usize) < bound);
    at(range.start)..at(range.end)
}

/// Adds a triangle of child `c` to the parent's tile at `origin` = (row, column).
fn add(
    structure: &Structure,
    c: usize,
    update: &[f64],
    tile: &mut MatMut<'_, f64>,
    origin: (usize, usize),
    diagonal: bool,
) {
    let (local, runs, below) = (structure.local(c), structure.runs(c), structure.below(c));
    let rows = overlap(structure, c, origin.0..origin.0 + tile.nrows());
    let columns = overlap(structure, c, origin.1..origin.1 + tile.ncols());
    if rows.is_empty() || columns.is_empty() {
        return;
    }
    let last = runs.partition_point(|run| (run.own as usize) < rows.end);
    let from = rows.start.max(columns.start);
    let mut first = runs.partition_point(|run| ((run.own + run.len) as usize) <= from);
    for j in columns {
        // Only the first triangle contains the diagonal.
        let from = rows.start.max(if diagonal { j } else { j + 1 });
        if from >= rows.end {
            break;
        }
        while ((runs[first].own + runs[first].len) as usize) <= from {
            first += 1;
        }
        let source = update_column(update, below, j);
        let target = column(tile, local[j] as usize - origin.1);
        for &Run { own, parent, len } in &runs[first..last] {
            let (own, parent, len) = (own as usize, parent as usize, len as usize);
            let (begin, end) = (own.max(from), (own + len).min(rows.end));
            let to = begin - own + parent - origin.0;
            let (source, target) = (&source[begin - j..end - j], &mut target[to..to + end - begin]);
            for (target, source) in target.iter_mut().zip(source) {
                *target += source;
            }
        }
    }
}

/// Adds the second triangle of `c`; the tile has whole columns from `start`.
fn add_mirrored(structure: &Structure, c: usize, update: &[f64], tile: &mut MatMut<'_, f64>, start: usize) {
    let (local, below) = (structure.local(c), structure.below(c));
    let end = start + tile.ncols();
    let parent = structure.parent[c] as usize;
    let rows = overlap(structure, c, start..end.min(structure.width(parent)));
    for j in 0..rows.end {
        let source = update_column(update, below, j);
        for i in rows.start.max(j + 1)..rows.end {
            tile[(local[j] as usize, local[i] as usize - start)] += source[i - j];
        }
    }
}

/// Column `j` of an update triangle, from its diagonal.
fn update_column(update: &[f64], below: usize, j: usize) -> &[f64] {
    let (block, rows) = (j / TILE, below - j / TILE * TILE);
    let at = j - block * TILE;
    &update[block_start(below, block) + at * rows + at..][..below - j]
}

pub(super) fn pivots<'a>(structure: &Structure, s: usize, values: &'a [f64]) -> MatRef<'a, f64> {
    let (width, rows) = (structure.width(s), structure.width(s) + structure.below(s));
    MatRef::from_column_major_slice(&values[structure.panel[s]..][..rows * width], rows, width)
}
