//! Systems advanced by the main loop.

mod coupled;
mod grains;
mod solid;

pub use coupled::{CoupledSystem, Meshed, SavedCoupling};
pub use grains::GrainsSystem;
pub use solid::{SolidKind, SolidSystem};
pub use trackbed_track::GrainsView;

use super::checkpoint::Body;
use std::io;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_io::failure::Failure;
use trackbed_track::TrackSystem;

/// Forces on bodies at a time.
pub type Applied<'a> = &'a mut dyn FnMut(f64, &dem::Model, &dem::State, &mut Vec<dem::AppliedForce>);

/// Solid of a running system.
#[derive(Clone, Copy)]
pub struct SolidView<'a> {
    /// Model.
    pub model: &'a fem::model::Model,
    /// State.
    pub state: &'a fem::state::State,
}

/// Model advanced by windows.
pub trait System: TrackSystem {
    /// Returns DEM and FEM steps after `windows` windows.
    fn steps_done(&self, windows: u64) -> (u64, u64);
    /// Advances one window.
    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure>;
    /// Shortens the last window to `rest` [s] if that is possible and differs from it; returns whether it did.
    fn shorten(&mut self, _rest: f64) -> bool {
        false
    }
    /// Saves the state to a checkpoint.
    fn save(&self, body: &mut Body<'_>) -> io::Result<()>;
    /// Saves the final state for `--from`, without solver history.
    fn save_end(&self, body: &mut Body<'_>) -> io::Result<()> {
        self.save(body)
    }
    /// Removes and inserts grains.
    ///
    /// # Errors
    /// Failed removal or insertion.
    fn exchange(&mut self, _leave: &[usize], _arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        Ok(())
    }
    /// Returns the contact surface of the solid.
    fn surface(&self) -> &dyn dem::surface::Surface {
        &dem::surface::NoSurface
    }
    /// Returns the stored energy [J].
    fn stored(&self) -> StoredEnergy;
    /// Returns work and dissipation [J].
    fn spent(&self) -> WorkAndDissipation;
    /// Returns the smallest meaningful reference energy [J].
    fn reference_energy(&self) -> f64 {
        self.grains().map_or(0.0, |g| dem::measure::reference_energy(g.model, g.state))
    }
    /// Completes the motion of a reduced solid; windows compute only its contact surface.
    fn recover(&mut self) {}
    /// Makes checks that are too expensive for every window.
    ///
    /// # Errors
    /// Values not finite.
    fn examine(&mut self) -> Result<(), Failure> {
        Ok(())
    }
    /// Returns the solid, if any; see [`System::recover`].
    fn solid(&self) -> Option<SolidView<'_>> {
        None
    }
    /// Whether a failed window keeps the last converged state.
    fn keeps_its_state(&self) -> bool {
        false
    }
    /// Returns support reactions on the solid [N], shape `[3·nodes]`, if known.
    fn reactions(&self) -> Option<Vec<f64>> {
        None
    }
    /// Returns the mean grain force on the ground in the last window [N].
    fn contact_force(&self) -> [f64; 3] {
        [0.0; 3]
    }
    /// Returns the largest mean face pressure on the ground in the last window [Pa].
    fn peak_pressure(&self) -> f64 {
        0.0
    }
    /// Returns a short progress text on iterations.
    fn progress(&self) -> Option<String> {
        None
    }
    /// Returns the seat load work [J].
    fn seat_work(&self) -> f64 {
        self.grains().map_or(0.0, |g| g.state.balance.work_applied)
    }
}

/// Returns strain and gravitational energy [J]; nodal weights `gravity` [N], shape `[3·nodes]`.
pub fn stored_at_rest(model: &fem::Model, state: &fem::state::State, gravity: &[f64]) -> StoredEnergy {
    StoredEnergy {
        solid_strain: fem::energy::strain(model, state),
        solid_gravity: -gravity.iter().zip(&state.u).map(|(f, u)| f * u).sum::<f64>(),
        ..StoredEnergy::default()
    }
}
