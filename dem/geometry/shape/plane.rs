//! Infinite planes.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};

/// Infinite plane with grains on the side of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Point of the plane [m].
    pub point: Vec3,
    /// Normal towards the grains, of any length.
    pub normal: Vec3,
    /// Material (index).
    pub material: usize,
    /// Initial velocity [m/s], also tangential (conveyor belt); see
    /// `State::set_plane_velocity`.
    pub velocity: Vec3,
}

/// Motion of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneMotion {
    /// Displacement [m].
    pub offset: Vec3,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Grains pass through.
    pub open: bool,
}
