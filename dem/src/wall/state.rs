//! Where walls are and how they move.

use crate::base::Vec3;
use crate::law::History;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// A vertex of a rigid triangle body that touches a plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Foot {
    pub plane: u32,
    pub vertex: u32,
    pub history: History,
}

/// Place and motion of a wall of patches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WallState {
    /// Displacement of the wall's centre since the start, and the part of it that is no oscillation [m].
    pub offset: Vec3,
    pub steady: Vec3,
    /// Turn since the start; `turned` tells whether there is any.
    pub orientation: UnitQuaternion<f64>,
    pub turned: bool,
    /// Velocity of the centre half a step ago [m/s], and its prescribed steady part.
    pub velocity: Vec3,
    pub drive: Vec3,
    /// Angular velocity half a step ago [rad/s].
    pub spin: Vec3,
    pub open: bool,
    /// Force of the grains on the wall in the last step [N], and its moment about the centre [N m].
    pub force: Vec3,
    pub moment: Vec3,
    /// Principal frame and angular momentum of a rigid body.
    pub frame: UnitQuaternion<f64>,
    pub momentum: Vec3,
    /// Acceleration of its centre in the last step [m/s²].
    pub acceleration: Vec3,
    pub feet: Vec<Foot>,
}

impl WallState {
    /// A world point in the frame of the wall, whose centre was at `centre` at the start.
    #[inline(always)]
    pub fn to_local(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        let back = x - self.offset;
        if self.turned { self.orientation.inverse_transform_vector(&(back - centre)) + centre } else { back }
    }

    /// A point of the wall's frame in the world.
    #[inline(always)]
    pub fn to_world(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        if self.turned { self.orientation * (x - centre) + centre + self.offset } else { x + self.offset }
    }

    /// A direction of the wall's frame in the world.
    #[inline(always)]
    pub fn turn(&self, v: &Vec3) -> Vec3 {
        if self.turned { self.orientation * v } else { *v }
    }

    /// Velocity of the wall's point at `x` [m/s].
    #[inline(always)]
    pub fn velocity_at(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.velocity + self.spin.cross(&(x - centre - self.offset))
    }
}
