//! Infinite planes.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};

/// An infinite plane; grains live on the side its normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane [m].
    pub point: Vec3,
    /// Normal, towards the grains; any length but zero.
    pub normal: Vec3,
    /// Material (index).
    pub material: usize,
    /// Velocity at the start [m/s]; also tangential, as of a belt. [`crate::engine::state::State::set_plane_velocity`] changes it.
    pub velocity: Vec3,
}

/// How far a plane has come, and where it goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneMotion {
    /// Displacement since the start [m].
    pub offset: Vec3,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Whether grains pass through.
    pub open: bool,
}
