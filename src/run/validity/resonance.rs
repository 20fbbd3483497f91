//! Check for loads near a natural frequency.

use super::{Check, Limits};
use trackbed_input::model::Job;
use trackbed_input::plausible::{AMPLIFICATION, resonance};

/// Undamped dynamic over static deflection.
const AMPLIFIED: Limits = Limits { warn: AMPLIFICATION, fail: None };

/// Checks harmonic loads; none without a frequency or modes.
pub fn load_near_mode(job: &Job) -> Option<Check> {
    let found = resonance(job)?;
    Some(Check::new("amplification by the mode nearest to the load", found.amplification, AMPLIFIED, || {
        found.message()
    }))
}
