//! Failures of the routine of a user material.

use thiserror::Error;

/// Failed call.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CallError {
    /// PNEWDT below 1.
    #[error("a shorter step requested (PNEWDT = {pnewdt})")]
    ShorterStep {
        /// Requested fraction of the step.
        pnewdt: f64,
    },
    /// Result not finite.
    #[error("{what} not finite")]
    NotFinite {
        /// Argument.
        what: &'static str,
    },
    /// State variable beyond the declared ones.
    #[error("STATEV written beyond its {states} values")]
    Overrun {
        /// Number of state variables.
        states: usize,
    },
}
