//! Grains alone.

use super::{Applied, GrainsView, System};
use crate::failure::Failure;
use crate::run::checkpoint::{Body, Loaded};
use crate::run::device::{Place, Steps, failed};
use crate::run::ranks::Sharing;
use std::io;
use trackbed_coupling as coupling;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_dem as dem;
use trackbed_dem::BackEnd;

/// Grains alone.
pub struct GrainsSystem {
    /// Model.
    pub model: dem::Model,
    /// State.
    pub state: dem::State,
    /// What computes the steps.
    work: Steps,
    /// Whether something has changed the state that a device has taken over.
    changed: bool,
    applied: Vec<dem::AppliedForce>,
    /// Length of a window [s].
    window: f64,
}

impl GrainsSystem {
    /// The grains in the state that they start from; `interval` is that of the history [s].
    ///
    /// # Errors
    /// They overlap so much that no step can be made; a device refuses them.
    pub fn new(
        model: dem::Model,
        mut state: dem::State,
        interval: f64,
        place: Place,
        sharing: Sharing<'_>,
    ) -> Result<GrainsSystem, Failure> {
        let mut work = dem::Work::new(&model, &state);
        dem::find_contacts(&model, &mut state, &mut work, &dem::surface::NoSurface)
            .map_err(|e| Failure::Numerical(e.to_string()))?;
        GrainsSystem::with(model, state, work, interval, (place, sharing))
    }

    /// The grains as a checkpoint has them; `interval` as in [`GrainsSystem::new`].
    ///
    /// # Errors
    /// A checkpoint of something else; a device refuses the grains.
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
    /// The state, to be changed.
    pub fn state_mut(&mut self) -> (&dem::Model, &mut dem::State) {
        self.changed = true;
        (&self.model, &mut self.state)
    }

    /// What ranks have sent each other a step, in lines; none where there is one.
    pub fn traffic(&self) -> Vec<String> {
        let lines = self.work.traffic().map(|traffic| traffic.lines(self.state.steps_done()));
        lines.unwrap_or_default()
    }

    /// Lets time and accounts begin anew.
    pub fn begin_anew(&mut self) {
        self.state.begin_anew();
    }
}

/// A window of grains alone [s]: one step where the scene fixes it, else 1, 1.25, 2, 2.5 or 5 times a power of ten, and at most so many
/// first steps that few long ones find room in their place. Round times are whole numbers of such windows, and windows do not
/// depend on the history unless its rows are close.
fn window(model: &dem::Model, interval: f64) -> f64 {
    match model.measured() {
        None => model.dt(),
        Some(_) => round_window([model.dt(), STEPS * model.dt()], interval),
    }
}

/// Steps in a window when a run begins, at most.
const STEPS: f64 = 64.0;

/// The longest round window within the bounds [s] that an interval of the history [s] has about a whole number of; for close rows
/// that only far shorter ones fit, whole first steps in about a part of the interval.
fn round_window([shortest, longest]: [f64; 2], interval: f64) -> f64 {
    let decade = libm::floor(libm::log10(longest)) as i32;
    let round = [0, -1].into_iter().flat_map(|less| {
        // A division by a power of ten rounds once, its inverse twice.
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

/// Largest deviation of the interval between rows from the one asked for, as a share.
const MISFIT: f64 = 0.05;

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
        state.forget_neighbours();
    }
}

impl System for GrainsSystem {
    fn steps_done(&self, _: u64) -> (u64, u64) {
        (self.state.steps_done(), 0)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        let none = &dem::surface::NoSurface;
        // The processor steps the state itself.
        if std::mem::take(&mut self.changed) && self.work.elsewhere() {
            self.work.upload(&self.model, &self.state).map_err(failed)?;
        }
        for _ in 0..dem::stability::divide(&self.model, &mut self.state, self.window, 1) {
            self.applied.clear();
            applied(self.state.time, &self.model, &self.state, &mut self.applied);
            self.work.step(&self.model, &mut self.state, none, &self.applied).map_err(failed)?;
        }
        self.work.download(&self.model, &mut self.state).map_err(failed)
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.state)
    }

    fn exchange(&mut self, leave: &[usize], arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        dem::flow::exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
            .map_err(|e| Failure::Numerical(e.to_string()))
    }

    fn stored(&self) -> Stored {
        let e = dem::measure::energies(&self.model, &self.state);
        Stored {
            grains_kinetic: e.kinetic_translation + e.kinetic_rotation,
            contact_springs: e.elastic_normal + e.elastic_tangential,
            bonds: e.elastic_bonds,
            mounts: e.elastic_mounts,
            grains_gravity: e.gravity,
            ..Stored::default()
        }
    }

    fn spent(&self) -> Spent {
        coupling::step::spent_by_grains(&self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_round_and_do_not_follow_the_history() {
        let window = |longest: f64, interval: f64| round_window([longest / STEPS, longest], interval);
        // Intervals that a round window divides, or that are long.
        for interval in [1.0, 0.5, 0.05, 1e-3, 2e-3, 0.0213, 0.037] {
            assert_eq!(window(1.47e-4, interval), 1.25e-4, "{interval}");
        }
        for (longest, round) in
            [(1e-3, 1e-3), (0.99e-3, 5e-4), (4.9e-6, 2.5e-6), (2.4e-6, 2e-6), (64.0, 50.0), (0.3, 0.25)]
        {
            assert_eq!(window(longest, 1e4 * round), round);
        }
        // Close rows: a round part of their interval, or about a part in whole steps.
        assert_eq!(window(1.47e-4, 1e-4), 1e-4);
        assert_eq!(window(6.4e-3, 1.7e-3), 17.0 * 1e-4);
        assert_eq!(window(6.4e-3, 2e-5), 1e-4);
    }
}
