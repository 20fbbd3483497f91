//! Who accompanies a run from within its process: is shown the state at the end of each window, and may push grains.

use super::system::{GrainsView, SolidView};
use crate::failure::Failure;
use std::fmt;
use std::sync::Arc;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_dem as dem;

/// A run as it is at the start of its main loop, or after a window of it.
pub struct Shown<'a> {
    /// Time since the start of the main loop [s].
    pub time: f64,
    /// Windows done.
    pub done: u64,
    /// Windows of the whole loop, as far as is known.
    pub windows: u64,
    /// The grains, if there are any.
    pub grains: Option<GrainsView<'a>>,
    /// The solid, if there is one.
    pub solid: Option<SolidView<'a>>,
    /// Energy stored now [J].
    pub stored: Stored,
    /// Work and dissipation so far [J].
    pub spent: Spent,
}

/// Accompanies the main loop of a run, on the thread of the run. What it does is no part of a checkpoint.
pub trait Companion: Send + Sync {
    /// Sees the state before the first window, and after each.
    ///
    /// # Errors
    /// Ends the run.
    fn follow(&self, shown: &Shown<'_>) -> Result<(), Failure>;

    /// Adds forces on grains for the coming step; their work enters the account of energy.
    fn push(&self, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>);
}

/// The companion of a run, if it has one.
#[derive(Clone, Default)]
pub struct Accompanied(pub Option<Arc<dyn Companion>>);

impl fmt::Debug for Accompanied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Accompanied" } else { "Alone" })
    }
}
