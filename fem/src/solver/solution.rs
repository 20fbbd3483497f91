//! Forward and backward substitution for 1, 2, 4 or 8 interleaved right-hand sides.
//!
//! Source: Liu (1992), section 6.

use super::analysis::Analysis;
use super::kernels::{
    solve_lower, solve_lower_transposed, solve_upper, subtract_product, subtract_transposed,
};
use super::structure::{Structure, Task};

const BLOCK: usize = 128;
const ROWS: usize = 512;
const COLUMNS: usize = 128;
/// Values above which threads share a front.
const SHARED: usize = 200_000;

pub(super) struct Vectors<'a> {
    pub analysis: &'a Analysis,
    pub first: &'a [f64],
    pub second: &'a [f64],
    /// Row exchanges in the pivot block, in order; for L U.
    pub rows: Option<&'a [u32]>,
}

#[derive(Default)]
pub(super) struct Solution {
    /// Solution in elimination order `[equations x width]`.
    x: Vec<f64>,
    /// Contributions below every front `[rows x width]`.
    below: Vec<f64>,
}

impl Solution {
    pub fn reserve(&mut self, structure: &Structure, width: usize) {
        let count = structure.count();
        let (n, rows) = (structure.begin[count] as usize, structure.rows.len());
        if self.x.len() < n * width {
            self.x = vec![0.0; n * width];
            self.below = vec![0.0; rows * width];
        }
    }

    pub fn capacity(&self) -> usize {
        self.x.capacity() + self.below.capacity()
    }

    pub fn solve<const K: usize>(&mut self, factor: &Vectors<'_>, b: &mut [f64]) {
        let structure = factor.analysis.structure();
        self.reserve(structure, K);
        let n = factor.analysis.size();
        let (x, below) = (&mut self.x[..n * K], &mut self.below[..structure.rows.len() * K]);
        for (x, &e) in x.chunks_exact_mut(K).zip(&factor.analysis.order) {
            for k in 0..K {
                x[k] = b[k * n + e];
            }
        }
        let pass = Pass::<K> { structure, factor };
        pass.branches(&structure.tasks, Space { x, below, column: 0, row: 0 }, false);
        for &s in &structure.upper {
            pass.forward(s as usize, x, below, (0, 0), true);
        }
        for &s in structure.upper.iter().rev() {
            pass.backward(s as usize, x, below, (0, 0), true);
        }
        for task in &structure.tasks {
            for s in (task.first..task.end).filter(|&s| structure.exported[s]) {
                pass.fetch(s, x, below, (0, 0));
            }
        }
        pass.branches(&structure.tasks, Space { x, below, column: 0, row: 0 }, true);
        for (x, &e) in x.chunks_exact(K).zip(&factor.analysis.order) {
            for k in 0..K {
                b[k * n + e] = x[k];
            }
        }
    }
}

struct Space<'a> {
    x: &'a mut [f64],
    below: &'a mut [f64],
    column: usize,
    row: usize,
}

struct Pass<'a, const K: usize> {
    structure: &'a Structure,
    factor: &'a Vectors<'a>,
}

impl<const K: usize> Pass<'_, K> {
    fn branches(&self, tasks: &[Task], space: Space<'_>, backward: bool) {
        match tasks {
            [] => {}
            [task] => {
                let Space { x, below, column, row } = space;
                let origin = (column, row);
                if backward {
                    for s in (task.first..task.end).rev() {
                        self.backward(s, x, below, origin, false);
                    }
                } else {
                    for s in task.first..task.end {
                        self.forward(s, x, below, origin, false);
                    }
                }
            }
            _ => {
                let (low, high) = tasks.split_at(tasks.len() / 2);
                let s = high[0].first;
                let (column, row) = (self.structure.begin[s] as usize, self.structure.rows_start[s]);
                let (x, high_x) = space.x.split_at_mut((column - space.column) * K);
                let (below, high_below) = space.below.split_at_mut((row - space.row) * K);
                let left = Space { x, below, ..space };
                let right = Space { x: high_x, below: high_below, column, row };
                rayon::join(|| self.branches(low, left, backward), || self.branches(high, right, backward));
            }
        }
    }

    fn panel(&self, s: usize) -> (&[f64], usize, usize) {
        let (width, below) = (self.structure.width(s), self.structure.below(s));
        (&self.factor.first[self.structure.panel[s]..][..width * (width + below)], width, below)
    }

    /// `x_s = L11^-1 x_s`, `below = children - L21 x_s`.
    fn forward(&self, s: usize, x: &mut [f64], below: &mut [f64], origin: (usize, usize), shared: bool) {
        let structure = self.structure;
        let (panel, width, rows) = self.panel(s);
        let ld = width + rows;
        let x = &mut x[(structure.begin[s] as usize - origin.0) * K..][..width * K];
        let (children, own) = below.split_at_mut((structure.rows_start[s] - origin.1) * K);
        let own = &mut own[..rows * K];
        own.fill(0.0);
        for &c in structure.children(s) {
            let c = c as usize;
            let from = &children[(structure.rows_start[c] - origin.1) * K..];
            for run in structure.runs(c) {
                let (mut at, mut to, mut len) = (run.own as usize, run.parent as usize, run.len as usize);
                if to < width {
                    let count = len.min(width - to);
                    add(&mut x[to * K..(to + count) * K], &from[at * K..(at + count) * K]);
                    (at, to, len) = (at + count, to + count, len - count);
                }
                if len > 0 {
                    add(&mut own[(to - width) * K..(to - width + len) * K], &from[at * K..(at + len) * K]);
                }
            }
        }
        let unit = self.factor.rows.is_some();
        if let Some(exchanges) = self.factor.rows {
            for (i, &j) in exchanges[structure.columns(s)].iter().enumerate() {
                let j = j as usize;
                if i != j {
                    (0..K).for_each(|k| x.swap(i * K + k, j * K + k));
                }
            }
        }
        let parallel = shared && panel.len() > SHARED;
        for first in (0..width).step_by(BLOCK) {
            let end = (first + BLOCK).min(width);
            let (now, later) = x[first * K..].split_at_mut((end - first) * K);
            solve_lower::<K>(&panel[first * ld + first..], ld, now, unit);
            by_rows::<K>(&panel[first * ld + end..], ld, now, later, 0, width - end, parallel);
            if parallel {
                by_rows::<K>(&panel[first * ld + width..], ld, now, own, 0, rows, true);
            }
        }
        if !parallel {
            subtract_product::<K>(&panel[width.min(panel.len())..], ld, x, own);
        }
    }

    fn fetch(&self, s: usize, x: &[f64], below: &mut [f64], origin: (usize, usize)) {
        let structure = self.structure;
        let rows = structure.below(s);
        if rows == 0 {
            return;
        }
        let p = structure.parent[s] as usize;
        let width = structure.width(p);
        let x = &x[(structure.begin[p] as usize - origin.0) * K..];
        let (own, parents) = below.split_at_mut((structure.rows_start[p] - origin.1) * K);
        let own = &mut own[(structure.rows_start[s] - origin.1) * K..][..rows * K];
        for run in structure.runs(s) {
            let (mut at, mut from, mut len) = (run.own as usize, run.parent as usize, run.len as usize);
            if from < width {
                let count = len.min(width - from);
                own[at * K..(at + count) * K].copy_from_slice(&x[from * K..(from + count) * K]);
                (at, from, len) = (at + count, from + count, len - count);
            }
            if len > 0 {
                let from = from - width;
                own[at * K..(at + len) * K].copy_from_slice(&parents[from * K..(from + len) * K]);
            }
        }
    }

    /// `x_s = L11^-T (x_s - L21^T below)`, or with U instead of L^T.
    fn backward(&self, s: usize, x: &mut [f64], below: &mut [f64], origin: (usize, usize), upper: bool) {
        let structure = self.structure;
        if !structure.exported[s] {
            self.fetch(s, x, below, origin);
        }
        let (panel, width, rows) = self.panel(s);
        let ld = width + rows;
        let x = &mut x[(structure.begin[s] as usize - origin.0) * K..][..width * K];
        let own = &below[(structure.rows_start[s] - origin.1) * K..][..rows * K];
        let parallel = upper && panel.len() > SHARED;
        if self.factor.rows.is_some() {
            let second = &self.factor.second[structure.second[s]..][..width * rows];
            by_columns::<K>(second, rows, x, own, parallel);
            for first in (0..width).step_by(BLOCK).rev() {
                let end = (first + BLOCK).min(width);
                let (earlier, now) = x[..end * K].split_at_mut(first * K);
                solve_upper::<K>(&panel[first * ld + first..], ld, now);
                by_rows::<K>(&panel[first * ld..], ld, now, earlier, 0, first, parallel);
            }
        } else {
            by_columns::<K>(&panel[width.min(panel.len())..], ld, x, own, parallel);
            for first in (0..width).step_by(BLOCK).rev() {
                let end = (first + BLOCK).min(width);
                let (now, later) = x[first * K..].split_at_mut((end - first) * K);
                by_columns::<K>(&panel[first * ld + end..], ld, now, later, parallel);
                solve_lower_transposed::<K>(&panel[first * ld + first..], ld, now);
            }
        }
    }
}

fn add(target: &mut [f64], source: &[f64]) {
    target.iter_mut().zip(source).for_each(|(t, s)| *t += s);
}

fn by_rows<const K: usize>(
    a: &[f64],
    ld: usize,
    x: &[f64],
    y: &mut [f64],
    first: usize,
    rows: usize,
    parallel: bool,
) {
    if rows == 0 {
        return;
    }
    if !parallel || rows <= ROWS {
        subtract_product::<K>(&a[first..], ld, x, y);
        return;
    }
    let middle = rows.div_ceil(ROWS) / 2 * ROWS;
    let (top, bottom) = y.split_at_mut(middle * K);
    rayon::join(
        || by_rows::<K>(a, ld, x, top, first, middle, true),
        || by_rows::<K>(a, ld, x, bottom, first + middle, rows - middle, true),
    );
}

fn by_columns<const K: usize>(a: &[f64], ld: usize, x: &mut [f64], y: &[f64], parallel: bool) {
    let columns = x.len() / K;
    if y.is_empty() {
        return;
    }
    if !parallel || columns <= COLUMNS {
        subtract_transposed::<K>(a, ld, x, y);
        return;
    }
    let middle = columns.div_ceil(COLUMNS) / 2 * COLUMNS;
    let (left, right) = x.split_at_mut(middle * K);
    rayon::join(
        || by_columns::<K>(a, ld, left, y, true),
        || by_columns::<K>(&a[middle * ld..], ld, right, y, true),
    );
}
