//! What a history records: things that state their columns once, with name, unit and value.

use super::flow::Flow;
use crate::model::Job;
use crate::write::csv::Row;
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
