//! Run-time checks of the coupling window by [interface numbers](crate::interface_stability).

use super::model::Model;
use super::state::{State, Work};
use crate::interface_stability::InterfaceStabilityNumbers;
use crate::stability::{interface_excess, interface_growth};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_fem::SolveError;

/// Maximum windows between checks.
const MOST: u64 = 2048;
/// Growth of the contact count that triggers an early check, and minimum windows before it.
const MORE: f64 = 1.25;
const FEWEST: u64 = 16;
/// Maximum divisions of a window.
const PARTS: u32 = 64;

/// Results of the interface checks.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct InterfaceCheck {
    /// Largest interface numbers so far.
    pub largest: InterfaceStabilityNumbers,
    /// Sum of growth bounds; its exponential bounds the amplitude growth.
    pub growth: f64,
    /// Divisions of a window.
    pub division: u32,
    /// Numbers of the last check for windows of 1 s.
    last: InterfaceStabilityNumbers,
    windows: u64,
    checked: u64,
    interval: u64,
    contacts: usize,
}

impl InterfaceCheck {
    fn due(&self, contacts: usize) -> bool {
        let since = self.windows - self.checked;
        self.windows == 1
            || since >= self.interval
            || since >= FEWEST && contacts as f64 > MORE * self.contacts as f64 + 2.0
    }
}

/// Checks the interface after a window, if due; `automatic` shortens further windows as required.
///
/// # Errors
/// The matrix of shorter windows cannot be factored.
pub fn check_interface<B: dem::BackEnd>(
    model: &mut Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    automatic: bool,
) -> Result<(), SolveError> {
    let contacts = work.grains.surface_contacts();
    let own = &mut state.interface_check;
    own.windows += 1;
    if own.due(contacts.len()) {
        own.interval = (2 * own.interval).clamp(1, MOST);
        own.checked = own.windows;
        own.contacts = contacts.len();
        own.last = work.interface.numbers(&model.grains, &state.grains, &work.surface, contacts);
        own.largest = own.largest.max(&own.last.at(model.window()));
    }
    let now = own.last.at(model.window());
    own.growth += f64::from(model.division) * interface_growth(model.scheme, model.theta, &now);
    if !automatic || interface_excess(model.scheme, model.theta, &now) <= 1.0 {
        return Ok(());
    }
    let whole = model.window() * f64::from(model.division);
    let suits = |parts: &u32| {
        let window = whole / f64::from(*parts);
        let possible = model.grains.measured().is_some() || model.substeps.is_multiple_of(*parts);
        possible && interface_excess(model.scheme, model.theta, &own.last.at(window)) <= 1.0
    };
    // Shortest windows if none is stable.
    let most = if model.grains.measured().is_some() { PARTS } else { model.substeps };
    let parts = (model.division + 1..=most).find(suits).unwrap_or(most.max(model.division));
    if parts != model.division {
        (model.division, own.division) = (parts, parts);
        work.refactor(model, state.solid.points.is_empty())?;
    }
    Ok(())
}
