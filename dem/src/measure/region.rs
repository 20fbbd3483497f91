//! Boxes in which quantities are measured.

use crate::base::Vec3;

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxRegion {
    /// Lower corner [m].
    pub low: Vec3,
    /// Upper corner [m].
    pub high: Vec3,
}

impl BoxRegion {
    /// Its volume [m³].
    pub fn volume(&self) -> f64 {
        (self.high - self.low).iter().map(|l| l.max(0.0)).product()
    }

    /// Whether it holds a point; its lower sides belong to it, its upper ones do not.
    pub fn holds(&self, x: &Vec3) -> bool {
        (0..3).all(|d| x[d] >= self.low[d] && x[d] < self.high[d])
    }
}
