//! Boxes for measurements.

use crate::base::Vec3;

/// Axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxRegion {
    /// Lower corner [m].
    pub low: Vec3,
    /// Upper corner [m].
    pub high: Vec3,
}

impl BoxRegion {
    /// Volume [m³].
    pub fn volume(&self) -> f64 {
        (self.high - self.low).iter().map(|l| l.max(0.0)).product()
    }

    /// Whether the box contains a point; lower sides inclusive, upper exclusive.
    pub fn holds(&self, x: &Vec3) -> bool {
        (0..3).all(|d| x[d] >= self.low[d] && x[d] < self.high[d])
    }
}
