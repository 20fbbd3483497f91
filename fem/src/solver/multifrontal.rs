//! Multifrontal factorisation `P A P^T = L L^T` or `P A P^T = L U`, and solves.
//!
//! Results are bitwise identical for any number of threads and repeated factorisations.
//!
//! Source: Duff and Reid (1983); Liu (1992). Limits: rows are exchanged within pivot blocks only, so a
//! singular pivot block gives [`PivotError`]; see [`DirectSolver::weakest_pivot`].

use super::PivotError;
use super::analysis::Analysis;
use super::front::{self, Panels, Scratch, Updates};
use super::solution::{Solution, Vectors};
use super::structure::{Structure, Task};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};

/// Numeric factor with buffers.
pub struct DirectSolver {
    analysis: Arc<Analysis>,
    kind: Kind,
    first: Buffer,
    second: Buffer,
    /// Row exchanges in the pivot block, in order.
    rows: Vec<u32>,
    work: Buffer,
    exported: Buffer,
    scratch: Option<Scratch>,
    slots: Vec<Mutex<Slot>>,
    solution: Solution,
    weakest: (f64, usize),
}

struct Slot {
    work: Buffer,
    scratch: Scratch,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    None,
    Symmetric,
    Unsymmetric,
}

impl DirectSolver {
    /// Solver without factor; the first factorisation allocates.
    pub fn new(analysis: Arc<Analysis>) -> DirectSolver {
        let last = analysis.size().saturating_sub(1);
        DirectSolver {
            analysis,
            kind: Kind::None,
            first: Buffer::default(),
            second: Buffer::default(),
            rows: Vec::new(),
            work: Buffer::default(),
            exported: Buffer::default(),
            scratch: None,
            slots: Vec::new(),
            solution: Solution::default(),
            weakest: (1.0, last),
        }
    }

    /// Symbolic factorisation.
    pub fn analysis(&self) -> &Arc<Analysis> {
        &self.analysis
    }

    /// Factors the symmetric matrix `lower` `[pattern entries]`, ordered as [`Analysis::pattern`].
    ///
    /// # Errors
    /// [`PivotError`] of the earliest nonpositive pivot; invalid factor.
    ///
    /// # Panics
    /// If `lower` does not match the pattern.
    pub fn factor_symmetric(&mut self, lower: &[f64]) -> Result<(), PivotError> {
        assert_eq!(lower.len(), self.analysis.entries(), "one value for every entry of the pattern");
        let analysis = self.analysis.clone();
        let structure = analysis.structure();
        self.reserve(structure, 1);
        let run = |s: usize,
                   store: FrontStorage<'_>,
                   children: Updates<'_>,
                   shared,
                   scratch: &mut Scratch| {
            front::factor_symmetric(structure, s, lower, store.first, store.update, children, shared, scratch)
        };
        self.run(structure, 1, &run).map_err(|position| {
            let equation = analysis.equation(position);
            PivotError { equation, ratio: 0.0 }
        })?;
        self.kind = Kind::Symmetric;
        let start = analysis.pattern().0;
        self.find_weakest_pivot(|pivot, position| pivot * pivot / lower[start[analysis.equation(position)]]);
        Ok(())
    }

    /// Factors the unsymmetric matrix of `lower` (r, c) and `upper` (c, r), `[pattern entries]`; `lower`
    /// gives the diagonal.
    ///
    /// # Errors
    /// [`PivotError`] of the earliest zero or nonfinite pivot; invalid factor.
    ///
    /// # Panics
    /// If `lower` or `upper` does not match the pattern.
    pub fn factor_unsymmetric(&mut self, lower: &[f64], upper: &[f64]) -> Result<(), PivotError> {
        let entries = self.analysis.entries();
        assert!(
            lower.len() == entries && upper.len() == entries,
            "two values for every entry of the pattern"
        );
        let analysis = self.analysis.clone();
        let structure = analysis.structure();
        self.reserve(structure, 2);
        let values = (lower, upper);
        let run = |s: usize,
                   store: FrontStorage<'_>,
                   children: Updates<'_>,
                   shared,
                   scratch: &mut Scratch| {
            let panels = Panels { first: store.first, second: store.second, rows: store.rows };
            front::factor_unsymmetric(structure, s, values, panels, store.update, children, shared, scratch)
        };
        self.run(structure, 2, &run).map_err(|position| {
            let equation = analysis.equation(position);
            PivotError { equation, ratio: 0.0 }
        })?;
        self.kind = Kind::Unsymmetric;
        let scale = analysis.column_scale(lower, upper);
        self.find_weakest_pivot(|pivot, position| pivot.abs() / scale[analysis.equation(position)]);
        Ok(())
    }

    /// Smallest pivot over its diagonal (symmetric) or largest column entry (unsymmetric), and its
    /// equation.
    pub fn weakest_pivot(&self) -> (f64, usize) {
        self.weakest
    }

    /// Allocated buffers [bytes].
    pub fn allocated(&self) -> usize {
        let buffers = [&self.first, &self.second, &self.work, &self.exported];
        let values: usize = buffers.iter().map(|buffer| buffer.capacity()).sum();
        let slots: usize = self
            .slots
            .iter()
            .map(|slot| slot.lock().unwrap_or_else(PoisonError::into_inner))
            .map(|slot| 8 * slot.work.capacity() + slot.scratch.bytes())
            .sum();
        let scratch = self.scratch.as_ref().map_or(0, Scratch::bytes);
        8 * (values + self.solution.capacity()) + 4 * self.rows.capacity() + slots + scratch
    }

    /// Equation count.
    pub fn size(&self) -> usize {
        self.analysis.size()
    }

    /// Solves in place. Shape `[equations]`.
    ///
    /// # Panics
    /// If there is no factor, or the length of `x` differs.
    pub fn solve_in_place(&mut self, x: &mut [f64]) {
        self.solve_many(x, 1);
    }

    /// Solves `count` right-hand sides in place, column-major `[equations x count]`; differs from
    /// [`DirectSolver::solve_in_place`] by rounding.
    ///
    /// # Panics
    /// If there is no factor, or the length of `x` differs.
    pub fn solve_many(&mut self, x: &mut [f64], count: usize) {
        let n = self.analysis.size();
        assert!(self.kind != Kind::None, "factor the matrix before a solve");
        assert_eq!(x.len(), n * count, "one value for every equation and right-hand side");
        let factor = Vectors {
            analysis: &self.analysis,
            first: &self.first,
            second: &self.second,
            rows: (self.kind == Kind::Unsymmetric).then_some(&self.rows[..]),
        };
        let mut rest = x;
        while n > 0 && !rest.is_empty() {
            let width = [8, 4, 2, 1].into_iter().find(|w| w * n <= rest.len()).unwrap_or(1);
            let (now, later) = rest.split_at_mut(width * n);
            match width {
                8 => self.solution.solve::<8>(&factor, now),
                4 => self.solution.solve::<4>(&factor, now),
                2 => self.solution.solve::<2>(&factor, now),
                _ => self.solution.solve::<1>(&factor, now),
            }
            rest = later;
        }
    }

    fn reserve(&mut self, structure: &Structure, triangles: usize) {
        self.kind = Kind::None;
        self.weakest = (1.0, self.analysis.size().saturating_sub(1));
        let count = structure.count();
        self.first.reserve(structure.panel[count]);
        self.work.reserve(triangles * structure.work_len);
        self.exported.reserve(triangles * structure.exported_len);
        if triangles == 2 {
            self.second.reserve(structure.second[count]);
            self.rows.resize(self.analysis.size(), 0);
        }
        self.solution.reserve(structure, 1);
        self.scratch.get_or_insert_with(|| Scratch::new(structure.max_width));
        let threads = structure.most_tasks().min(rayon::current_num_threads());
        while self.slots.len() < threads {
            let scratch = Scratch::new(structure.branch_width);
            self.slots.push(Mutex::new(Slot { work: Buffer::default(), scratch }));
        }
        for slot in &mut self.slots {
            slot.get_mut()
                .unwrap_or_else(PoisonError::into_inner)
                .work
                .reserve(triangles * structure.branch_len);
        }
    }

    /// Returns the first failed position in elimination order.
    fn run<F>(&mut self, structure: &Structure, triangles: usize, front: &F) -> Result<(), usize>
    where
        F: Fn(usize, FrontStorage<'_>, Updates<'_>, bool, &mut Scratch) -> Result<(), usize> + Sync,
    {
        let drive = Traversal { structure, triangles, front };
        let scratch = self.scratch.as_mut().expect("made with the buffers");
        for round in &structure.rounds {
            let branches = BranchStorage {
                first: &mut self.first[..],
                second: &mut self.second[..],
                rows: &mut self.rows[..],
                exported: &mut self.exported[..],
                start: FrontOffsets::default(),
            };
            let tasks = &structure.tasks[round.tasks.clone()];
            drive.branches(tasks, branches, &self.slots).map_or(Ok(()), Err)?;
            let (first, second) = (&mut self.first[..], &mut self.second[..]);
            for &s in &structure.upper[round.upper.clone()] {
                let s = s as usize;
                let store = (&mut *first, &mut *second, &mut self.rows[..]);
                let (update, children) = drive.split_stack(s, &mut self.work, &self.exported);
                drive.factor_front(s, store, FrontOffsets::default(), update, children, true, scratch)?;
            }
        }
        Ok(())
    }

    fn find_weakest_pivot(&mut self, ratio: impl Fn(f64, usize) -> f64) {
        let analysis = self.analysis.clone();
        let structure = analysis.structure();
        for s in 0..structure.count() {
            let panel = front::pivots(structure, s, &self.first);
            for (j, position) in structure.columns(s).enumerate() {
                let ratio = ratio(panel[(j, j)], position);
                if ratio < self.weakest.0 {
                    self.weakest = (ratio, analysis.equation(position));
                }
            }
        }
    }
}

struct FrontStorage<'a> {
    first: &'a mut [f64],
    second: &'a mut [f64],
    rows: &'a mut [u32],
    update: &'a mut [f64],
}

#[derive(Clone, Copy, Default)]
struct FrontOffsets {
    first: usize,
    second: usize,
    rows: usize,
    exported: usize,
}

struct BranchStorage<'a> {
    first: &'a mut [f64],
    second: &'a mut [f64],
    rows: &'a mut [u32],
    exported: &'a mut [f64],
    start: FrontOffsets,
}

struct Traversal<'a, F> {
    structure: &'a Structure,
    triangles: usize,
    front: &'a F,
}

impl<F> Traversal<'_, F>
where
    F: Fn(usize, FrontStorage<'_>, Updates<'_>, bool, &mut Scratch) -> Result<(), usize> + Sync,
{
    /// Returns the least failed position.
    fn branches(&self, tasks: &[Task], space: BranchStorage<'_>, slots: &[Mutex<Slot>]) -> Option<usize> {
        match tasks {
            [] => None,
            [task] => {
                // One slot per thread: one is always free.
                let mut at = rayon::current_thread_index().unwrap_or(0);
                loop {
                    let slot = &slots[at % slots.len()];
                    match slot.try_lock() {
                        Ok(mut slot) => return self.branch(task, space, &mut slot),
                        Err(TryLockError::Poisoned(slot)) => {
                            return self.branch(task, space, &mut slot.into_inner());
                        }
                        Err(TryLockError::WouldBlock) => at += 1,
                    }
                }
            }
            _ => {
                let (low, high) = tasks.split_at(tasks.len() / 2);
                let (left, right) = self.halve(space, &high[0]);
                let (a, b) =
                    rayon::join(|| self.branches(low, left, slots), || self.branches(high, right, slots));
                a.or(b)
            }
        }
    }

    fn halve<'a>(&self, space: BranchStorage<'a>, next: &Task) -> (BranchStorage<'a>, BranchStorage<'a>) {
        let (structure, triangles, start) = (self.structure, self.triangles, space.start);
        let s = next.first;
        let first_exported =
            (s..next.end).find(|&s| structure.exported[s]).expect("a branch ends in the task");
        let middle = FrontOffsets {
            first: structure.panel[s],
            second: if triangles == 2 { structure.second[s] } else { 0 },
            rows: if triangles == 2 { structure.begin[s] as usize } else { 0 },
            exported: triangles * structure.update[first_exported],
        };
        let first = space.first.split_at_mut(middle.first - start.first);
        let second = space.second.split_at_mut(middle.second - start.second);
        let rows = space.rows.split_at_mut(middle.rows - start.rows);
        let exported = space.exported.split_at_mut(middle.exported - start.exported);
        (
            BranchStorage { first: first.0, second: second.0, rows: rows.0, exported: exported.0, start },
            BranchStorage {
                first: first.1,
                second: second.1,
                rows: rows.1,
                exported: exported.1,
                start: middle,
            },
        )
    }

    fn branch(&self, task: &Task, space: BranchStorage<'_>, slot: &mut Slot) -> Option<usize> {
        let BranchStorage { first, second, rows, exported, start } = space;
        let (work, scratch) = (&mut slot.work[..], &mut slot.scratch);
        for s in task.first..task.end {
            let store = (&mut *first, &mut *second, &mut *rows);
            let result = if self.structure.exported[s] {
                let update = self.range(s, start.exported);
                let children = Updates { work, work_start: 0, exported: &[], triangles: self.triangles };
                self.factor_front(s, store, start, &mut exported[update], children, false, scratch)
            } else {
                let (update, children) = self.split_stack(s, work, &[]);
                self.factor_front(s, store, start, update, children, false, scratch)
            };
            if let Err(position) = result {
                return Some(position);
            }
        }
        None
    }

    fn range(&self, s: usize, start: usize) -> std::ops::Range<usize> {
        let (structure, triangles) = (self.structure, self.triangles);
        let begin = triangles * structure.update[s] - start;
        begin..begin + triangles * super::dense::update_len(structure.below(s))
    }

    /// Update of the front, and the children's stack.
    fn split_stack<'a>(
        &self,
        s: usize,
        work: &'a mut [f64],
        exported: &'a [f64],
    ) -> (&'a mut [f64], Updates<'a>) {
        let triangles = self.triangles;
        let split = triangles * self.structure.split[s];
        let own = self.range(s, 0);
        let (left, right) = work.split_at_mut(split);
        if self.structure.left[s] {
            let children = Updates { work: right, work_start: split, exported, triangles };
            (&mut left[own], children)
        } else {
            let children = Updates { work: left, work_start: 0, exported, triangles };
            (&mut right[own.start - split..own.end - split], children)
        }
    }

    fn factor_front(
        &self,
        s: usize,
        (first, second, rows): (&mut [f64], &mut [f64], &mut [u32]),
        start: FrontOffsets,
        update: &mut [f64],
        children: Updates<'_>,
        shared: bool,
        scratch: &mut Scratch,
    ) -> Result<(), usize> {
        let structure = self.structure;
        let (second, rows) = if self.triangles == 2 {
            let columns = structure.columns(s);
            (
                &mut second[structure.second[s] - start.second..structure.second[s + 1] - start.second],
                &mut rows[columns.start - start.rows..columns.end - start.rows],
            )
        } else {
            (&mut [][..], &mut [][..])
        };
        let first = &mut first[structure.panel[s] - start.first..structure.panel[s + 1] - start.first];
        let store = FrontStorage { first, second, rows, update };
        (self.front)(s, store, children, shared, scratch).map_err(|j| structure.columns(s).start + j)
    }
}

/// Cache-line aligned, so that kernel results are reproducible.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    values: Vec<f64>,
    skip: usize,
    len: usize,
}

const LINE: usize = 8;

impl Buffer {
    pub fn reserve(&mut self, len: usize) {
        if self.len != len {
            // Fresh zeroed memory is free until used.
            self.values = Vec::new();
            self.values = vec![0.0; len + LINE];
            self.skip = self.values.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
            self.len = len;
        }
    }

    pub fn capacity(&self) -> usize {
        self.values.capacity()
    }
}

impl std::ops::Deref for Buffer {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[self.skip..self.skip + self.len]
    }
}

impl std::ops::DerefMut for Buffer {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[self.skip..self.skip + self.len]
    }
}

#[cfg(test)]
#[path = "multifrontal_tests.rs"]
mod tests;
