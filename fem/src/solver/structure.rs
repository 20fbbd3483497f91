//! Supernodes of the factor, how fronts pass updates to their parents, and where everything lies in memory.
//!
//! A *front* is the dense matrix of a supernode: `width` pivot columns and `below` rows below them. Its pivot columns become
//! factor; the rest is its *update*, added into the front of the parent. Whole subtrees that cost little are *branches*:
//! they are independent tasks. The fronts above them, the *upper fronts*, are factored one after another, each cut into tiles.
//!
//! Every place is fixed here, from the pattern alone. The updates of a branch lie on two stacks that grow towards each other
//! from the ends of a work space (depth even: left, odd: right, so that a front reads its children from one stack and
//! writes to the other); every thread has one such space. The upper fronts have another. The updates that branches hand to the
//! upper fronts have places of their own, and to keep these few, large subtrees are done in *rounds*: the branches of one, then
//! its upper fronts, then the next. So the peak is known beforehand.
//!
//! Source: Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math.
//! Software 9 (1983) 302-325; Liu, The multifrontal method for sparse matrix solution, SIAM Review 34 (1992) 82-109.

use super::dense::update_len;
use super::pattern::{NONE, Upper};
use std::ops::Range;

/// A branch costs at most this share of all flops; at least [`BRANCH_FLOPS`].
const BRANCHES: f64 = 256.0;
const BRANCH_FLOPS: f64 = 4e6;
/// A round costs about this share of all flops at most.
const ROUNDS: f64 = 4.0;

/// Consecutive rows of an update that are consecutive in the parent's front, too.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// First row in the update.
    pub own: u32,
    /// First row in the parent's front.
    pub parent: u32,
    pub len: u32,
}

/// Branches that make one task: a contiguous range of supernodes.
#[derive(Clone, Debug)]
pub(super) struct Task {
    pub first: usize,
    pub end: usize,
}

/// Tasks, and the upper fronts that can be done after them.
#[derive(Clone, Debug)]
pub(super) struct Round {
    pub tasks: Range<usize>,
    pub upper: Range<usize>,
}

#[derive(Debug, Default)]
pub(super) struct Structure {
    /// First column of every supernode, and the number of columns at the end.
    pub begin: Vec<u32>,
    /// Start of the rows of every supernode in `rows`; also of its part of the vectors of a solve.
    pub rows_start: Vec<usize>,
    /// Rows below the pivot block, ascending.
    pub rows: Vec<u32>,
    /// The same rows as places in the parent's front.
    pub local: Vec<u32>,
    pub runs_start: Vec<usize>,
    pub runs: Vec<Run>,
    pub parent: Vec<u32>,
    pub children_start: Vec<usize>,
    pub children: Vec<u32>,
    /// Start of the columns of a front in the factor (`width + below` rows), and of the second panel of an
    /// unsymmetric factor (`below` rows).
    pub panel: Vec<usize>,
    pub second: Vec<usize>,
    /// Entries of the matrix by pivot column: row in the front, and place in the caller's values.
    pub entry_start: Vec<usize>,
    pub entry_row: Vec<u32>,
    pub entry_source: Vec<u32>,
    /// Place of the update: in the work space, or for the last front of a branch among the handed-over ones.
    pub update: Vec<usize>,
    /// Boundary of the work space between the front's own update and those of its children.
    pub split: Vec<usize>,
    /// Whether the update lies on the left stack, below that boundary.
    pub left: Vec<bool>,
    /// Whether the update is handed from a branch to the upper fronts.
    pub handed: Vec<bool>,
    pub handed_len: usize,
    /// Work space of the upper fronts, and of a thread that does branches; in values of one triangle, like all places.
    pub work_len: usize,
    pub branch_len: usize,
    pub rounds: Vec<Round>,
    pub tasks: Vec<Task>,
    pub upper: Vec<u32>,
    /// Columns of the widest front, and of the widest one in a branch.
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

    /// Flops of a symmetric front.
    pub fn front_flops(&self, s: usize) -> f64 {
        let (w, r) = (self.width(s) as f64, self.below(s) as f64);
        // Sum of (r + i)^2 for i = 1..=w.
        w * r * r + r * w * (w + 1.0) + w * (w + 1.0) * (2.0 * w + 1.0) / 6.0
    }

    /// Builds everything from the supernodes (`begin`, `rows_start`, `rows`) and the matrix.
    pub fn new(begin: Vec<u32>, rows_start: Vec<usize>, rows: Vec<u32>, upper: &Upper) -> Structure {
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
            // Whole cache lines, so that kernels meet the same alignment in every run.
            panel += (w * (w + r)).next_multiple_of(8);
            second += (w * r).next_multiple_of(8);
            self.max_width = self.max_width.max(w);
            self.flops += self.front_flops(s);
        }
        self.panel.push(panel);
        self.second.push(second);
    }

    fn locate_entries(&mut self, upper: &Upper) {
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
        // Rows come ascending, so the place within a supernode only moves on.
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

    /// Cuts the tree into branches and upper fronts and gives every update its place.
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
        self.handed = vec![false; count];
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
            self.handed[s] = true;
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

    /// Ends a round after every subtree of the upper fronts that is as large as a round may be, and places what is handed over.
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
                    if self.handed[s] {
                        self.update[s] = place;
                        place += update_len(self.below(s));
                        // What a later round reads must stay.
                        if self.parent[s] != NONE && self.parent[s] as usize >= end {
                            base = place;
                        }
                    }
                }
            }
            self.handed_len = self.handed_len.max(place);
            self.rounds.push(Round { tasks, upper });
        }
    }

    /// Number of tasks of the longest round: more threads than that have nothing to do.
    pub fn most_tasks(&self) -> usize {
        self.rounds.iter().map(|round| round.tasks.len()).max().unwrap_or(0)
    }

    /// Places the updates of `fronts` (in their order) on two stacks; returns the length of the work space.
    fn stack(&mut self, fronts: &[u32]) -> usize {
        let mut end = 0_usize;
        // The right stack needs the size of the region, which the first pass finds.
        for _ in 0..2 {
            let (mut height, mut peak) = ([0_usize; 2], 0);
            for &s in fronts {
                let s = s as usize;
                let own = usize::from(!self.left[s]);
                let children: usize = self
                    .children(s)
                    .iter()
                    .filter(|&&c| !self.handed[c as usize])
                    .map(|&c| update_len(self.below(c as usize)))
                    .sum();
                let theirs = height[1 - own];
                if !self.handed[s] {
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
