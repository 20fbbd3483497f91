//! The state that a plastic solid starts from.

use crate::failure::Failure;
use crate::model::solid::SolidPart;
use trackbed_fem::State;

/// The state with its initial stress, and the share of the weight that this stress carries already.
///
/// # Errors
/// The stress finds no equilibrium.
pub fn state(part: &SolidPart, _gravity: &[f64]) -> Result<(State, f64), Failure> {
    Ok((State::new(&part.model), 0.0))
}
