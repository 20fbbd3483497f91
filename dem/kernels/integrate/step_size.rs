//! Step sizes.
//!
//! Positions advance by `dt`, velocities by the mean of present and previous step: exact impulses.

use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepSize {
    /// Next step [s].
    pub dt: f64,
    /// Last step [s]; velocities are half as old.
    pub last: f64,
    /// Step by the last stability check [s]; windows may shorten `dt`.
    pub wanted: f64,
    /// Last critical time step [s]; zero if none.
    pub limit: f64,
    /// Next stability check and its interval, in steps.
    pub look: u64,
    pub interval: u64,
    /// Time [s] and dissipated energy [J] at the last window.
    pub before: [f64; 2],
    /// Dissipation rate at the last stability check [W].
    pub rate: f64,
    /// Energy received up to which the last stability check holds [J].
    pub expected: f64,
}

impl StepSize {
    pub fn new(dt: f64) -> StepSize {
        StepSize {
            dt,
            last: dt,
            wanted: dt,
            limit: 0.0,
            look: 0,
            interval: 0,
            before: [0.0; 2],
            rate: 0.0,
            expected: 0.0,
        }
    }

    /// Time increment of velocities [s].
    #[inline(always)]
    pub fn kick(&self) -> f64 {
        0.5 * (self.last + self.dt)
    }
}
