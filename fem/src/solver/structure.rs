//! Supernodes, fronts and memory layout of the factor.
//!
//! A *front* is the dense matrix of a supernode: `width` pivot columns and `below` rows. Its *update* is
//! added to the parent's front. Cheap subtrees are *branches*, run as independent tasks; the *upper fronts*
//! above them follow sequentially, in tiles.
//!
//! The layout follows from the pattern, so peak memory is known. Updates passed to upper fronts are limited
//! by *rounds*: branches of a large subtree, then its upper fronts.
//!
//! Source: Duff and Reid (1983); Liu (1992).

use super::dense::update_len;
use super::pattern::{NONE, UpperPattern};
use std::ops::Range;

/// Branch limit: this fraction of all flops, at least [`BRANCH_FLOPS`].
const BRANCHES: f64 = 256.0;
const BRANCH_FLOPS: f64 = 4e6;
/// Round limit as a fraction of all flops.
const ROUNDS: f64 = 4.0;

/// Update rows also consecutive in the parent's front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub own: u32,
    pub parent: u32,
    pub len: u32,
}

/// Contiguous range of supernodes.
#[derive(Clone, Debug)]
pub(super) struct Task {
    pub first: usize,
    pub end: usize,
}

/// Tasks, then upper fronts.
#[derive(Clone, Debug)]
pub(super) struct Round {
    pub tasks: Range<usize>,
    pub upper: Range<usize>,
}

#[derive(Debug, Default)]
pub(super) struct Structure {
    /// First column of every supernode, then the column count.
    pub begin: Vec<u32>,
    /// Start of each supernode in `rows` and in solve vectors.
    pub rows_start: Vec<usize>,
    /// Rows below the pivot block, ascending.
    pub rows: Vec<u32>,
    /// Positions of `rows` in the parent's front.
    pub local: Vec<u32>,
    pub runs_start: Vec<usize>,
    pub runs: Vec<Run>,
    pub parent: Vec<u32>,
    pub children_start: Vec<usize>,
    pub children: Vec<u32>,
    /// Start of each front in the factor (`width + below` rows) and second panel (`below` rows).
    pub panel: Vec<usize>,
    pub second: Vec<usize>,
    /// Matrix entries by pivot column: front row, index of the caller's value.
    pub entry_start: Vec<usize>,
    pub entry_row: Vec<u32>,
    pub entry_source: Vec<u32>,
    /// Update offset in the work space, or among passed updates.
    pub update: Vec<usize>,
    /// Boundary between own and children's updates.
    pub split: Vec<usize>,
    /// Whether the update is on the left stack.
    pub left: Vec<bool>,
    /// Whether the update passes to the upper fronts.
    pub exported: Vec<bool>,
    pub exported_len: usize,
    /// Work space of upper fronts and branch thread, in values of one triangle.
    pub work_len: usize,
    pub branch_len: usize,
    pub rounds: Vec<Round>,
    pub tasks: Vec<Task>,
    pub upper: Vec<u32>,
    /// Widest front, overall and in a branch [columns].
    pub max_width: usize,
    pub branch_width: usize,
    pub flops: f64,
}

impl Structure {
    pub fn count(&self) -> usize {
        self.parent.len()
    }

    pub fn width(&self, s: usize) -> usize {
        (self.begin[s + 1] - self.begin[s]) as usize
    }

    pub fn below(&self, s: usize) -> usize {
        self.rows_start[s + 1] - self.rows_start[s]
    }

    pub fn columns(&self, s: usize) -> Range<usize> {
        self.begin[s] as usize..self.begin[s + 1] as usize
    }

    pub fn local(&self, s: usize) -> &[u32] {
        &self.local[self.rows_start[s]..self.rows_start[s + 1]]
    }

    pub fn runs(&self, s: usize) -> &[Run] {
        &self.runs[self.runs_start[s]..self.runs_start[s + 1]]
    }

    pub fn children(&self, s: usize) -> &[u32] {
        &self.children[self.children_start[s]..self.children_start[s + 1]]
    }

    pub fn front_flops(&self, s: usize) -> f64 {
        let (w, r) = (self.width(s) as f64, self.below(s) as f64);
        // Sum of (r + i)^2 for i = 1..=w.
        w * r * r + r * w * (w + 1.0) + w * (w + 1.0) * (2.0 * w + 1.0) / 6.0
    }

    pub fn new(begin: Vec<u32>, rows_start: Vec<usize>, rows: Vec<u32>, upper: &UpperPattern) -> Structure {
        let mut structure = Structure { begin, rows_start, rows, ..Structure::default() };
        structure.link();
        structure.locate_rows();
        structure.lay_out_panels();
        structure.locate_entries(upper);
        structure.plan();
        structure
    }

    fn link(&mut self) {
        let count = self.begin.len() - 1;
        let n = self.begin[count] as usize;
        let mut supernode_of = vec![0_u32; n];
        for s in 0..count {
            supernode_of[self.begin[s] as usize..self.begin[s + 1] as usize].fill(s as u32);
        }
        self.parent = (0..count)
            .map(|s| match self.rows.get(self.rows_start[s]) {
                Some(&row) if self.rows_start[s] < self.rows_start[s + 1] => supernode_of[row as usize],
                _ => NONE,
            })
            .collect();
        self.children_start = vec![0; count + 1];
        for &p in self.parent.iter().filter(|&&p| p != NONE) {
            self.children_start[p as usize + 1] += 1;
        }
        for s in 0..count {
            self.children_start[s + 1] += self.children_start[s];
        }
        let mut next = self.children_start.clone();
        self.children = vec![0; self.children_start[count]];
        for s in 0..count {
            if self.parent[s] != NONE {
                let place = &mut next[self.parent[s] as usize];
                self.children[*place] = s as u32;
                *place += 1;
            }
        }
    }

    fn locate_rows(&mut self) {
        let count = self.count();
        self.local = vec![0; self.rows.len()];
        self.runs_start.push(0);
        for s in 0..count {
            if self.parent[s] != NONE {
                let p = self.parent[s] as usize;
                let (begin, end) = (self.begin[p], self.begin[p + 1]);
                let theirs = &self.rows[self.rows_start[p]..self.rows_start[p + 1]];
                let mut at = 0;
                let mut last: Option<Run> = None;
                for k in self.rows_start[s]..self.rows_start[s + 1] {
                    let row = self.rows[k];
                    let place = if row < end {
                        row - begin
                    } else {
                        while theirs[at] < row {
                            at += 1;
                        }
                        end - begin + at as u32
                    };
                    self.local[k] = place;
                    match &mut last {
                        Some(run) if run.parent + run.len == place => run.len += 1,
                        _ => {
                            self.runs.extend(last);
                            let own = (k - self.rows_start[s]) as u32;
                            last = Some(Run { own, parent: place, len: 1 });
                        }
                    }
                }
                self.runs.extend(last);
            }
            self.runs_start.push(self.runs.len());
        }
    }

    fn lay_out_panels(&mut self) {
        let (mut panel, mut second) = (0, 0);
        for s in 0..self.count() {
            let (w, r) = (self.width(s), self.below(s));
            self.panel.push(panel);
            self.second.push(second);
            // Whole cache lines keep kernel results reproducible.
            panel += (w * (w + r)).next_multiple_of(8);
            second += (w * r).next_multiple_of(8);
            self.max_width = self.max_width.max(w);
            self.flops += self.front_flops(s);
        }
        self.panel.push(panel);
        self.second.push(second);
    }

    fn locate_entries(&mut self, upper: &UpperPattern) {
        let n = upper.start.len() - 1;
        let entries = upper.row.len();
        self.entry_start = vec![0; n + 1];
        for &i in &upper.row {
            self.entry_start[i + 1] += 1;
        }
        for j in 0..n {
            self.entry_start[j + 1] += self.entry_start[j];
        }
        let mut next = self.entry_start.clone();
        self.entry_row = vec![0; entries];
        self.entry_source = vec![0; entries];
        let mut supernode_of = vec![0_u32; n];
        for s in 0..self.count() {
            supernode_of[self.columns(s)].fill(s as u32);
        }
        // Rows ascend, so positions only advance.
        let mut reached = self.rows_start.clone();
        for j in 0..n {
            for k in upper.start[j]..upper.start[j + 1] {
                let i = upper.row[k];
                let s = supernode_of[i] as usize;
                let local = if j < self.begin[s + 1] as usize {
                    j - self.begin[s] as usize
                } else {
                    while (self.rows[reached[s]] as usize) < j {
                        reached[s] += 1;
                    }
                    self.width(s) + reached[s] - self.rows_start[s]
                };
                self.entry_row[next[i]] = local as u32;
                self.entry_source[next[i]] = upper.source[k];
                next[i] += 1;
            }
        }
    }

    fn plan(&mut self) {
        let count = self.count();
        let mut below_flops: Vec<f64> = (0..count).map(|s| self.front_flops(s)).collect();
        let (mut depth, mut first) = (vec![0_u32; count], (0..count).collect::<Vec<_>>());
        for s in 0..count {
            if self.parent[s] != NONE {
                let p = self.parent[s] as usize;
                below_flops[p] += below_flops[s];
                first[p] = first[p].min(first[s]);
            }
        }
        for s in (0..count).rev() {
            if self.parent[s] != NONE {
                depth[s] = depth[self.parent[s] as usize] + 1;
            }
        }
        let limit = (self.flops / BRANCHES).max(BRANCH_FLOPS);
        self.exported = vec![false; count];
        self.update = vec![0; count];
        self.split = vec![0; count];
        self.left = depth.iter().map(|d| d & 1 == 0).collect();
        let mut load = f64::INFINITY;
        for s in 0..count {
            if below_flops[s] > limit {
                self.upper.push(s as u32);
                continue;
            }
            self.branch_width = self.branch_width.max(self.width(s));
            if self.parent[s] != NONE && below_flops[self.parent[s] as usize] <= limit {
                continue;
            }
            self.exported[s] = true;
            match self.tasks.last_mut() {
                Some(task) if task.end == first[s] && load + below_flops[s] <= limit => {
                    task.end = s + 1;
                    load += below_flops[s];
                }
                _ => {
                    self.tasks.push(Task { first: first[s], end: s + 1 });
                    load = below_flops[s];
                }
            }
        }
        self.make_rounds(&below_flops);
        for task in self.tasks.clone() {
            let fronts: Vec<u32> = (task.first as u32..task.end as u32).collect();
            self.branch_len = self.branch_len.max(self.stack(&fronts));
        }
        let upper = std::mem::take(&mut self.upper);
        self.work_len = self.stack(&upper);
        self.upper = upper;
    }

    /// Ends rounds at subtrees of full size.
    fn make_rounds(&mut self, below_flops: &[f64]) {
        let limit = self.flops / ROUNDS;
        let large = |s: usize| self.parent[s] == NONE || below_flops[self.parent[s] as usize] > limit;
        let ends: Vec<usize> = self
            .upper
            .iter()
            .map(|&s| s as usize)
            .filter(|&s| below_flops[s] <= limit && large(s))
            .map(|s| s + 1)
            .chain([self.count()])
            .collect();
        let (mut task, mut front, mut base) = (0, 0, 0);
        for end in ends {
            let tasks = task..task + self.tasks[task..].partition_point(|t| t.end <= end);
            let upper = front..front + self.upper[front..].partition_point(|&s| (s as usize) < end);
            (task, front) = (tasks.end, upper.end);
            let mut place = base;
            for t in tasks.clone() {
                for s in self.tasks[t].first..self.tasks[t].end {
                    if self.exported[s] {
                        self.update[s] = place;
                        place += update_len(self.below(s));
                        // Later rounds read it.
                        if self.parent[s] != NONE && self.parent[s] as usize >= end {
                            base = place;
                        }
                    }
                }
            }
            self.exported_len = self.exported_len.max(place);
            self.rounds.push(Round { tasks, upper });
        }
    }

    /// Most tasks of a round, the useful number of threads.
    pub fn most_tasks(&self) -> usize {
        self.rounds.iter().map(|round| round.tasks.len()).max().unwrap_or(0)
    }

    fn stack(&mut self, fronts: &[u32]) -> usize {
        let mut end = 0_usize;
        // The right stack needs the region size from the first pass.
        for _ in 0..2 {
            let (mut height, mut peak) = ([0_usize; 2], 0);
            for &s in fronts {
                let s = s as usize;
                let own = usize::from(!self.left[s]);
                let children: usize = self
                    .children(s)
                    .iter()
                    .filter(|&&c| !self.exported[c as usize])
                    .map(|&c| update_len(self.below(c as usize)))
                    .sum();
                let theirs = height[1 - own];
                if !self.exported[s] {
                    height[own] += update_len(self.below(s));
                    self.update[s] = if own == 0 {
                        height[0] - update_len(self.below(s))
                    } else {
                        end.saturating_sub(height[1])
                    };
                }
                peak = peak.max(height[0] + height[1]);
                self.split[s] = if own == 0 { end.saturating_sub(theirs) } else { theirs };
                height[1 - own] -= children;
            }
            end = peak;
        }
        end
    }
}
