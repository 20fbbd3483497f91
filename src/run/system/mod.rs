//! What the main loop needs of a model, whatever it consists of: solid, grains, or both.

mod coupled;
mod grains;
mod solid;

pub use coupled::{CoupledSystem, Meshed};
pub use grains::GrainsSystem;
pub use solid::{SolidKind, SolidSystem};
pub use trackbed_coupling::track::GrainsView;

use super::checkpoint::Body;
use crate::failure::Failure;
use std::io;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_dem as dem;
use trackbed_fem as fem;

/// Forces on bodies at a time.
pub type Applied<'a> = &'a mut dyn FnMut(f64, &dem::Model, &dem::State, &mut Vec<dem::AppliedForce>);

/// The solid of a running system.
#[derive(Clone, Copy)]
pub struct SolidView<'a> {
    /// Model.
    pub model: &'a fem::model::Model,
    /// Its state.
    pub state: &'a fem::state::State,
}

/// A model that can be advanced window by window.
pub trait System: TrackSystem {
    /// Steps of grains and solid since the start, after `windows` windows.
    fn steps_done(&self, windows: u64) -> (u64, u64);
    /// Advances by one window.
    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure>;
    /// Puts into a checkpoint what `resume` of the system goes on from.
    fn save(&self, body: &mut Body<'_>) -> io::Result<()>;
    /// Puts into a file what another run goes on from: what a solver has learnt stays behind.
    fn save_end(&self, body: &mut Body<'_>) -> io::Result<()> {
        self.save(body)
    }
    /// Takes grains out and puts grains in.
    ///
    /// # Errors
    /// A grain that cannot leave or come.
    fn exchange(&mut self, _leave: &[usize], _arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        Ok(())
    }
    /// The surface of the solid that grains may touch.
    fn surface(&self) -> &dyn dem::surface::Surface {
        &dem::surface::NoSurface
    }
    /// Energy stored now [J].
    fn stored(&self) -> Stored;
    /// Work and dissipation so far [J].
    fn spent(&self) -> Spent;
    /// Energy in proportion to which an error of the balance means something at least [J].
    fn reference_energy(&self) -> f64 {
        self.grains().map_or(0.0, |g| dem::measure::reference_energy(g.model, g.state))
    }
    /// The solid, if there is one.
    fn solid(&self) -> Option<SolidView<'_>> {
        None
    }
    /// Whether a window that fails leaves the state of the last good step behind.
    fn keeps_its_state(&self) -> bool {
        false
    }
    /// Forces of the supports on the solid [N], shape `[3·nodes]`, where they are known.
    fn reactions(&self) -> Option<Vec<f64>> {
        None
    }
    /// Force of the grains on the ground, mean over the last window [N].
    fn contact_force(&self) -> [f64; 3] {
        [0.0; 3]
    }
    /// Largest mean pressure on a face of the ground in the last window [Pa].
    fn peak_pressure(&self) -> f64 {
        0.0
    }
    /// What the user sees of it while it runs, in a few words: the work of an iteration.
    fn progress(&self) -> Option<String> {
        None
    }
    /// Work of the loads on the sleepers' seats so far [J].
    fn seat_work(&self) -> f64 {
        self.grains().map_or(0.0, |g| g.state.ledger.work_applied)
    }
}

/// Energy that a solid alone stores in its strain and against gravity, whose nodal forces are `gravity` [N], shape `[3·nodes]`.
pub fn stored_at_rest(model: &fem::Model, state: &fem::state::State, gravity: &[f64]) -> Stored {
    Stored {
        solid_strain: fem::energy::strain(model, state),
        solid_gravity: -gravity.iter().zip(&state.u).map(|(f, u)| f * u).sum::<f64>(),
        ..Stored::default()
    }
}
