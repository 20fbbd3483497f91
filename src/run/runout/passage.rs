//! Cells in plan that moving grains pass, with their energies.

use super::deposit::Deposit;
use super::ground::{self, Plan};
use super::{kinetic, slide};
use crate::system::GrainsView;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use trackbed_input::model::grains::{GrainsPart, RunoutPlan};
use trackbed_io::columns::passage;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, write_table};

/// Positions along the way of a grain per cell size.
const POSITIONS: f64 = 4.0;

/// Passed cells by column and row: corner of cell (i, j) at (i, j) times the cell size.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Passage {
    /// Side of the cells [m].
    side: f64,
    cells: BTreeMap<[i32; 2], Passed>,
    /// Last position of each body.
    before: Vec<Option<[f64; 2]>>,
}

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Passed {
    /// Entries of grains.
    entries: u32,
    /// Largest kinetic energy of a grain [J].
    energy: f64,
}

/// Cell with passage and deposit.
struct Row {
    middle: [f64; 2],
    ground: f64,
    passed: Passed,
    depth: f64,
}

const COLUMNS: [Field<Row>; 6] = [
    (passage::X, |row| row.middle[0]),
    (passage::Y, |row| row.middle[1]),
    (passage::GROUND, |row| row.ground),
    (passage::ENTRIES, |row| f64::from(row.passed.entries)),
    (passage::ENERGY, |row| row.passed.energy),
    (passage::DEPTH, |row| row.depth),
];

fn cell_of(x: [f64; 2], cell: f64) -> [i32; 2] {
    x.map(|x| (x / cell).floor() as i32)
}

impl Passage {
    /// Follows all grains since the last call.
    pub fn follow(&mut self, view: GrainsView<'_>, plan: &RunoutPlan, cell: f64) {
        self.side = cell;
        self.before.resize(view.model.body_count(), None);
        for body in slide(view, plan) {
            let x = view.state.position(body);
            let energy = kinetic(view, &[body]);
            self.advance(body, [x.x, x.y], energy, cell);
        }
    }

    fn advance(&mut self, body: usize, to: [f64; 2], energy: f64, cell: f64) {
        let last = self.before[body].replace(to);
        let from = last.unwrap_or(to);
        let mut inside = last.map(|x| cell_of(x, cell));
        let way = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let count = (POSITIONS * way / cell).ceil().max(1.0) as usize;
        for k in 1..=count {
            let share = k as f64 / count as f64;
            let at = cell_of([0, 1].map(|d| from[d] + share * (to[d] - from[d])), cell);
            let passed = self.cells.entry(at).or_default();
            passed.entries += u32::from(inside != Some(at));
            passed.energy = passed.energy.max(energy);
            inside = Some(at);
        }
    }

    /// Returns the side of the cells [m].
    pub fn side(&self) -> f64 {
        self.side
    }

    /// Writes `passage.csv`: all cells that were passed or hold a deposit.
    ///
    /// # Errors
    /// I/O errors.
    pub fn write(
        &self,
        dir: &Path,
        view: GrainsView<'_>,
        part: &GrainsPart,
        deposit: &Deposit,
    ) -> Result<(), Failure> {
        let cell = self.side;
        let mut cells: BTreeMap<[i32; 2], (Passed, f64)> =
            self.cells.iter().map(|(at, passed)| (*at, (*passed, 0.0))).collect();
        for (i, j) in deposit.cells() {
            let at = cell_of(deposit.plan.middle(i, j), cell);
            cells.entry(at).or_default().1 = deposit.depth[deposit.plan.index(i, j)];
        }
        let middle = |at: &[i32; 2]| at.map(|k| (f64::from(k) + 0.5) * cell);
        let places: Vec<[f64; 2]> = cells.keys().map(middle).collect();
        let ground = ground::under(view, part, &around(cells.keys(), cell), &places);
        let rows = cells.into_iter().zip(ground).map(|((at, (passed, depth)), ground)| Row {
            middle: middle(&at),
            ground: ground.unwrap_or(0.0),
            passed,
            depth,
        });
        Ok(write_table(&dir.join(passage::TABLE.file), &COLUMNS, rows)?)
    }
}

/// Grid around cells.
fn around<'a>(cells: impl Iterator<Item = &'a [i32; 2]>, cell: f64) -> Plan {
    let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
    for at in cells {
        for d in 0..2 {
            (low[d], high[d]) = (low[d].min(at[d]), high[d].max(at[d]));
        }
    }
    Plan {
        low: low.map(|k| f64::from(k) * cell),
        cell,
        counts: [0, 1].map(|d| (i64::from(high[d]) - i64::from(low[d]) + 1).max(1) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fast grain misses no cell between two rows, and enters each once; its energy at the end of the way counts on all of it.
    #[test]
    fn all_cells_along_the_way_are_passed() {
        let mut passage = Passage { before: vec![None], ..Passage::default() };
        for (x, energy) in [(0.5, 0.0), (4.5, 10.0), (4.6, 3.0), (3.5, 2.0)] {
            passage.advance(0, [x, -0.5], energy, 1.0);
        }
        let found: Vec<_> = passage.cells.iter().map(|(at, p)| (*at, p.entries, p.energy)).collect();
        let expected = [
            ([0, -1], 1, 10.0),
            ([1, -1], 1, 10.0),
            ([2, -1], 1, 10.0),
            ([3, -1], 2, 10.0),
            ([4, -1], 1, 10.0),
        ];
        assert_eq!(found, expected);
    }
}
