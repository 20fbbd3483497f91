//! Columns of `history.csv`.

use super::histories::{Energies, Interface, Inventory, Measures, Probes, Rails, Sleepers, Supports};
use crate::bond_output::{Bonds, Groups};
use crate::recorder::{Now, Recorder};
use crate::runout::Slides;
use crate::specimen::Specimens;
use crate::structures::Structures;
use crate::system::System;
use crate::wall_output::Walls;
use trackbed_io::columns::history;
use trackbed_io::write::csv::{Column, Row};

/// In column order after time.
fn recorders<'a, S: System + 'a>() -> [&'a dyn Recorder<S>; 14] {
    [
        &Sleepers,
        &Interface,
        &Energies,
        &Rails,
        &Bonds,
        &Groups,
        &Supports,
        &Probes,
        &Measures,
        &Walls,
        &Inventory,
        &Slides,
        &Specimens,
        &Structures,
    ]
}

fn record<S: System>(now: &Now<'_, S>, row: &mut Row) {
    row.put(history::TIME, now.time);
    recorders().iter().for_each(|recorder| recorder.record(now, row));
}

/// Returns the history columns.
pub fn columns<S: System>(now: &Now<'_, S>) -> Vec<Column> {
    Row::columns_of(|row| record(now, row))
}

/// Returns the history values.
pub fn values<S: System>(now: &Now<'_, S>) -> Vec<f64> {
    Row::values_of(|row| record(now, row))
}
