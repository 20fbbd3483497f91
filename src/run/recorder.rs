//! Recorders of history columns.

use super::flow::Flow;
use trackbed_coupling::energy_balance::EnergyBalance;
use trackbed_input::model::Job;
use trackbed_io::write::csv::Row;
use trackbed_track::Track;

/// State of a run passed to recorders.
pub struct Now<'a, S> {
    /// Simulated time [s].
    pub time: f64,
    /// Solid and grains.
    pub system: &'a S,
    /// Scene.
    pub job: &'a Job,
    /// Sleepers and rails.
    pub track: &'a Track<'a>,
    /// Inlets and outlets.
    pub flow: Option<&'a Flow<'a>>,
    /// Energy balance.
    pub balance: &'a EnergyBalance,
}

/// Source of columns in `history.csv`.
pub trait Recorder<S> {
    /// Adds the columns, if any. Names must not change within a run.
    fn record(&self, now: &Now<'_, S>, row: &mut Row);
}
