//! Check of cycle jumps.

use super::{Check, Limits};
use trackbed_track::cycle_jump::JumpSummary;

/// Estimated error over the settlement.
const ERROR: Limits = Limits { warn: 0.1, fail: None };

/// Checks the estimated error of the settlement after jumps.
pub fn jump_error(jump: &JumpSummary) -> Check {
    Check::new("settlement error of cycle jumps", jump.relative_error_estimate, ERROR, || {
        format!(
            "the settlement after {} simulated and {} skipped cycles has an estimated error of {:.3} mm. Simulate more cycles before the \
             jumps (`track.jump.first`), shorten them (`track.jump.largest`), or give the settlement as a range.",
            jump.simulated,
            jump.skipped,
            1e3 * jump.error_estimate
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    #[test]
    fn warns_of_errors_beyond_a_tenth() {
        let of = |relative_error_estimate| JumpSummary {
            method: "extrapolate",
            simulated: 100,
            skipped: 900,
            error_estimate: 1e-3,
            relative_error_estimate,
            energy: 0.0,
            jumps: Vec::new(),
            forecasts: Vec::new(),
            delays: Vec::new(),
        };
        assert_eq!([0.05, 0.15].map(|e| jump_error(&of(e)).status), [Outcome::Passed, Outcome::Warned]);
    }
}
