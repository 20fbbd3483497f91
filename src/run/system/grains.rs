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
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))?;
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

/// A window of grains alone: one step where the scene fixes it, else so many first steps that few long ones find room in their
/// place, and about a whole number of windows in an interval of the history [s].
fn window(model: &dem::Model, interval: f64) -> f64 {
    if model.measured().is_none() {
        return model.dt();
    }
    let windows = (interval / (STEPS * model.dt())).ceil().max(1.0);
    let steps = (interval / (windows * model.dt())).round();
    model.dt() * steps.clamp(1.0, STEPS)
}

/// Steps in a window when a run begins.
const STEPS: f64 = 64.0;

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
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))
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
