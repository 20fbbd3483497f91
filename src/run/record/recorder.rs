//! What a history records: a list of [`Recorder`]s, each of which states its columns once, with name, unit and value.

use super::histories::{Energies, Interface, Probes, Rails, Sleepers, Supports};
use crate::model::Job;
use crate::run::bond_output::{Bonds, Groups};
use crate::run::flow::{Flow, Inventory};
use crate::run::system::System;
use crate::run::wall_output::Walls;
use crate::write::csv::{Column, Row};
use trackbed_coupling::ledger::Balance;
use trackbed_coupling::track::Track;

/// One moment of a run, as its histories see it.
pub struct Now<'a, S> {
    /// Simulated time [s].
    pub time: f64,
    /// Solid and grains.
    pub system: &'a S,
    /// The scene.
    pub job: &'a Job,
    /// Sleepers and rails.
    pub track: &'a Track<'a>,
    /// Inlets and outlets.
    pub flow: Option<&'a Flow<'a>>,
    /// Energy account.
    pub balance: &'a Balance,
}

/// Something that has columns in `history.csv`.
pub trait Recorder<S> {
    /// Adds its columns; none in a run that has nothing for it. Their names must not change within a run.
    fn record(&self, now: &Now<'_, S>, row: &mut Row);
}

/// Everything that is recorded, in the order of the columns behind the time.
fn recorders<'a, S: System + 'a>() -> [&'a dyn Recorder<S>; 10] {
    [&Sleepers, &Interface, &Energies, &Rails, &Bonds, &Groups, &Supports, &Probes, &Walls, &Inventory]
}

fn record<S: System>(now: &Now<'_, S>, row: &mut Row) {
    row.put("time", "s", now.time);
    recorders().iter().for_each(|recorder| recorder.record(now, row));
}

/// The columns of a history.
pub fn columns<S: System>(now: &Now<'_, S>) -> Vec<Column> {
    Row::columns_of(|row| record(now, row))
}

/// Their values.
pub fn values<S: System>(now: &Now<'_, S>) -> Vec<f64> {
    Row::values_of(|row| record(now, row))
}
