//! DEM-only system.

use super::{Applied, GrainsView, System};
use crate::checkpoint::{Body, Loaded};
use crate::device::{Place, Steps, failed};
use crate::ranks::Sharing;
use std::io;
use trackbed_coupling as coupling;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_dem as dem;
use trackbed_dem::BackEnd;
use trackbed_io::failure::Failure;
use trackbed_track::TrackSystem;

/// DEM-only system.
pub struct GrainsSystem {
    /// Model.
    pub model: dem::Model,
    /// State.
    pub state: dem::State,
    work: Steps,
    /// Whether an upload is due.
    changed: bool,
    applied: Vec<dem::AppliedForce>,
    window: f64,
}

impl GrainsSystem {
    /// Creates the initial system; `interval` of the history [s].
    ///
    /// # Errors
    /// Initial overlaps too large, or unsupported device.
    pub fn new(
        model: dem::Model,
        mut state: dem::State,
        interval: f64,
        place: Place,
        sharing: Sharing<'_>,
    ) -> Result<GrainsSystem, Failure> {
        let mut work = dem::Work::new(&model, &state);
        dem::find_contacts(&model, &mut state, &mut work, &dem::surface::NoSurface)
            .map_err(failed(&model))?;
        GrainsSystem::with(model, state, work, interval, (place, sharing))
    }

    /// Restores a checkpoint.
    ///
    /// # Errors
    /// Unsuitable checkpoint or device.
    pub fn resume(
        model: dem::Model,
        interval: f64,
        loaded: &mut Loaded,
        place: Place,
        sharing: Sharing<'_>,
    ) -> Result<GrainsSystem, Failure> {
        let state = loaded.take()?;
        let work = dem::Work::new(&model, &state);
        GrainsSystem::with(model, state, work, interval, (place, sharing))
    }

    fn with(
        model: dem::Model,
        state: dem::State,
        work: dem::Work,
        interval: f64,
        (place, sharing): (Place, Sharing<'_>),
    ) -> Result<GrainsSystem, Failure> {
        let work = match (sharing.link(), place) {
            (Some(link), _) => {
                drop(work);
                Steps::ranks(link, &model, &state, sharing.description())?
            }
            (None, Place::Cpu) => Steps::processor(work),
            (None, Place::Gpu) => Steps::device(&model, &state)?,
        };
        let (window, applied) = (window(&model, interval), Vec::new());
        Ok(GrainsSystem { model, state, work, changed: false, applied, window })
    }
}

impl GrainsSystem {
    /// Returns the mutable state.
    pub fn state_mut(&mut self) -> (&dem::Model, &mut dem::State) {
        self.changed = true;
        (&self.model, &mut self.state)
    }

    /// Formats messages per step between ranks, if any.
    pub fn traffic(&self) -> Vec<String> {
        let lines = self.work.traffic().map(|traffic| traffic.lines(self.state.steps_done()));
        lines.unwrap_or_default()
    }

    /// Resets time and balances.
    pub fn reset_time(&mut self) {
        self.state.reset_time();
    }
}

/// One step if constant, else 1, 1.25, 2, 2.5 or 5 times a power of ten [s], limited so that few longer
/// steps fit.
fn window(model: &dem::Model, interval: f64) -> f64 {
    match model.measured() {
        None => model.dt(),
        Some(_) => round_window([model.dt(), STEPS * model.dt()], interval),
    }
}

const STEPS: f64 = 64.0;

/// Longest round window [s] that nearly divides the history interval.
fn round_window([shortest, longest]: [f64; 2], interval: f64) -> f64 {
    let decade = libm::floor(libm::log10(longest)) as i32;
    let round = [0, -1].into_iter().flat_map(|less| {
        // Dividing rounds once, multiplying by the inverse twice.
        let unit = libm::exp10(f64::from((decade + less).abs()));
        [5.0, 2.5, 2.0, 1.25, 1.0].map(|n| if decade + less < 0 { n / unit } else { n * unit })
    });
    let fits = |window: &f64| {
        let rows = (interval / window).round();
        let fits = rows >= 1.0 && (interval / (rows * window) - 1.0).abs() <= MISFIT;
        fits && (shortest..=longest).contains(window)
    };
    let part = interval / (interval / longest).ceil().max(1.0);
    let whole = || shortest * (part / shortest).round().max(1.0);
    round.into_iter().find(fits).filter(|window| 2.0 * window >= part).unwrap_or_else(whole)
}

const MISFIT: f64 = 0.05;

/// Whether the `rest` of the run [s] is shorter than a window, apart from rounding.
fn is_short(rest: f64, window: f64) -> bool {
    rest > 1e-9 * window && rest < window * (1.0 - 1e-9)
}

impl TrackSystem for GrainsSystem {
    fn window(&self) -> f64 {
        self.window
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model, state: &self.state })
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        let (model, state) = self.state_mut();
        moves.iter().for_each(|(body, shift, turn)| state.shift(model, *body, shift, turn));
        state.request_search();
    }
}

impl System for GrainsSystem {
    fn steps_done(&self, _: u64) -> (u64, u64) {
        (self.state.steps_done(), 0)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        let none = &dem::surface::NoSurface;
        // CPU steps use the state directly.
        if std::mem::take(&mut self.changed) && self.work.elsewhere() {
            self.work.upload(&self.model, &self.state).map_err(failed(&self.model))?;
        }
        for _ in 0..dem::stability::divide(&self.model, &mut self.state, self.window, 1) {
            self.applied.clear();
            applied(self.state.time, &self.model, &self.state, &mut self.applied);
            self.work.step(&self.model, &mut self.state, none, &self.applied).map_err(failed(&self.model))?;
        }
        self.work.download(&self.model, &mut self.state).map_err(failed(&self.model))
    }

    fn shorten(&mut self, rest: f64) -> bool {
        // A short first step starts the leapfrog scheme with an error.
        let first = self.state.steps_done() == 0 && rest < self.model.dt();
        let short = self.model.measured().is_some() && is_short(rest, self.window) && !first;
        if short {
            self.window = rest;
        }
        short
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.state)
    }

    fn exchange(&mut self, leave: &[usize], arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        dem::flow::exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
            .map_err(|e| Failure::Numerical(self.model.name_objects(&e)))
    }

    fn stored(&self) -> StoredEnergy {
        let e = dem::measure::energies(&self.model, &self.state);
        StoredEnergy {
            grains_kinetic: e.kinetic_translation + e.kinetic_rotation,
            contact_springs: e.elastic_normal + e.elastic_tangential,
            bonds: e.elastic_bonds,
            mounts: e.elastic_mounts,
            grains_gravity: e.gravity,
            ..StoredEnergy::default()
        }
    }

    fn spent(&self) -> WorkAndDissipation {
        coupling::step::grain_work_and_dissipation(&self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_round_without_close_rows() {
        let window = |longest: f64, interval: f64| round_window([longest / STEPS, longest], interval);
        // Divisible by a round window, or long.
        for interval in [1.0, 0.5, 0.05, 1e-3, 2e-3, 0.0213, 0.037] {
            assert_eq!(window(1.47e-4, interval), 1.25e-4, "{interval}");
        }
        for (longest, round) in
            [(1e-3, 1e-3), (0.99e-3, 5e-4), (4.9e-6, 2.5e-6), (2.4e-6, 2e-6), (64.0, 50.0), (0.3, 0.25)]
        {
            assert_eq!(window(longest, 1e4 * round), round);
        }
        // Close rows.
        assert_eq!(window(1.47e-4, 1e-4), 1e-4);
        assert_eq!(window(6.4e-3, 1.7e-3), 17.0 * 1e-4);
        assert_eq!(window(6.4e-3, 2e-5), 1e-4);
    }

    #[test]
    fn last_window_ends_with_the_run() {
        let (end, window) = (0.3_f64, round_window([1.0197e-4, 64.0 * 1.0197e-4], 1e-4));
        let whole = (end / window).ceil();
        assert!(whole * window > end + 1e-6, "{window}");
        let rest = end - (whole - 1.0) * window;
        assert!(is_short(rest, window));
        for rest in [window, window * (1.0 - 1e-12), 2.0 * window, 1e-14 * window] {
            assert!(!is_short(rest, window), "{rest}");
        }
    }
}
