//! The lengths of the steps.
//!
//! Positions move by a step `dt`; velocities, which belong to the middles of steps, by the mean of that step and the one
//! before. So the leapfrog stays the leapfrog when the step changes, impulses stay sums of force times time, and only what
//! contacts dissipate in the one step of a change is right to first order.

use serde::{Deserialize, Serialize};

/// Length of the next step and of the last, and when the largest stable one is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pace {
    /// The next step [s].
    pub dt: f64,
    /// The last one [s]: velocities are those of half of it ago.
    pub last: f64,
    /// The step that the last look at the limit allows [s]; `dt` is shorter where a window holds a whole number of steps.
    pub wanted: f64,
    /// The largest stable step found last [s]; zero where none was found.
    pub limit: f64,
    /// Steps done at the next look, and steps between looks.
    pub look: u64,
    pub interval: u64,
}

impl Pace {
    /// Steps of `dt` [s].
    pub fn new(dt: f64) -> Pace {
        Pace { dt, last: dt, wanted: dt, limit: 0.0, look: 0, interval: 0 }
    }

    /// The time by which velocities advance [s].
    #[inline(always)]
    pub fn kick(&self) -> f64 {
        0.5 * (self.last + self.dt)
    }
}
