//! In-process observer of a run, which may apply grain forces.

use super::system::{GrainsView, SolidView};
use std::fmt;
use std::sync::Arc;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_dem as dem;
use trackbed_io::failure::Failure;

/// State at the main loop start or after a window.
pub struct Shown<'a> {
    /// Main-loop time [s].
    pub time: f64,
    /// Completed windows.
    pub done: u64,
    /// Expected total of windows.
    pub windows: u64,
    /// Grains, if any.
    pub grains: Option<GrainsView<'a>>,
    /// Solid, if any.
    pub solid: Option<SolidView<'a>>,
    /// Stored energy [J].
    pub stored: StoredEnergy,
    /// Work and dissipation so far [J].
    pub spent: WorkAndDissipation,
}

/// Observer of the main loop, on its thread. Not saved in checkpoints.
pub trait Companion: Send + Sync {
    /// Whether it observes the state now, asked before the first window and after each; reading it takes time.
    fn is_due(&self, time: f64, done: u64, windows: u64) -> bool;

    /// Observes the state.
    ///
    /// # Errors
    /// Errors stop the run.
    fn follow(&self, shown: &Shown<'_>) -> Result<(), Failure>;

    /// Adds grain forces for the next step; their work enters the energy balance.
    fn push(&self, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>);
}

/// Optional observer of a run.
#[derive(Clone, Default)]
pub struct Accompanied(pub Option<Arc<dyn Companion>>);

impl fmt::Debug for Accompanied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Accompanied" } else { "Alone" })
    }
}
