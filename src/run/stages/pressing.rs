//! Bed after a press.

use crate::bed::Bed;
use trackbed_dem::measure::BoxRegion;

/// Bed after a press and its rest.
pub struct Pressed<'a> {
    /// Bed.
    pub bed: Bed<'a>,
    /// Steps.
    pub steps: u64,
    /// Whether it came to rest.
    pub rested: bool,
    /// Measured box, cut at a moved plane.
    pub region: BoxRegion,
    /// Force on the moved plane [N].
    pub wall_force: Option<f64>,
}

impl<'a> Pressed<'a> {
    /// Bed without a moved plane.
    pub fn new(bed: Bed<'a>, rested: bool, region: BoxRegion) -> Pressed<'a> {
        Pressed { steps: bed.state.steps, bed, rested, region, wall_force: None }
    }
}
