//! Pose and motion of walls.

use crate::base::Vec3;
use crate::base::force_tracking::ForceTracking;
use crate::lanes::quaternion::QuaternionLanes;
use crate::lanes::{Real, V3};
use crate::law::History;
use crate::pairs::wall_history::WallContactHistory;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Vertex–plane contact of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct VertexContact {
    pub plane: u32,
    pub vertex: u32,
    pub history: History,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WallState {
    /// Displacement of the centre, and its non-oscillating part [m].
    pub offset: Vec3,
    pub steady: Vec3,
    /// Rotation since the start; `turned`: whether nonzero.
    pub orientation: UnitQuaternion<f64>,
    pub turned: bool,
    /// Centre velocity at the last half step [m/s], and its steady part.
    pub velocity: Vec3,
    pub drive: Vec3,
    /// Angular velocity at the last half step [rad/s].
    pub spin: Vec3,
    pub open: bool,
    /// Force of the last step [N], moment about the centre [N m].
    pub force: Vec3,
    pub moment: Vec3,
    /// Principal frame and angular momentum of a rigid body.
    pub frame: UnitQuaternion<f64>,
    pub momentum: Vec3,
    /// Centre acceleration of the last step [m/s²].
    pub acceleration: Vec3,
    /// Velocity change in the last step if servo-controlled [m/s].
    pub change: Vec3,
    /// Integral part of a servo's velocity along its direction [m/s].
    pub integral: f64,
    /// Displacement at time zero [m].
    pub origin: Vec3,
    /// Force of a servo compared with its target.
    pub tracking: ForceTracking,
    pub feet: Vec<VertexContact>,
    /// Wall–wall contacts, sorted by wall and feature.
    pub meets: Vec<WallContactHistory>,
}

/// [`WallState`] for kernels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallPose<R: Real> {
    pub centre: V3<R>,
    pub offset: V3<R>,
    pub orientation: QuaternionLanes<R>,
    pub turned: R::Mask,
    pub velocity: V3<R>,
    pub spin: V3<R>,
}

impl<R: Real> WallPose<R> {
    /// World to wall frame.
    #[inline(always)]
    pub fn to_local(self, x: V3<R>) -> V3<R> {
        let back = x - self.offset;
        if !R::any(self.turned) {
            return back;
        }
        let turned = self.orientation.inverse().times(back - self.centre) + self.centre;
        V3::select(self.turned, turned, back)
    }

    /// Wall frame to world.
    #[inline(always)]
    pub fn to_world(self, x: V3<R>) -> V3<R> {
        let moved = x + self.offset;
        if !R::any(self.turned) {
            return moved;
        }
        let turned = self.orientation.times(x - self.centre) + self.centre + self.offset;
        V3::select(self.turned, turned, moved)
    }

    /// Direction to world.
    #[inline(always)]
    pub fn turn(self, v: V3<R>) -> V3<R> {
        if !R::any(self.turned) {
            return v;
        }
        V3::select(self.turned, self.orientation.times(v), v)
    }

    #[inline(always)]
    pub fn velocity_at(self, x: V3<R>) -> V3<R> {
        self.velocity + self.spin.cross(x - self.centre - self.offset)
    }
}

impl WallState {
    /// `centre`: initial centre.
    #[inline(always)]
    fn pose(&self, centre: &Vec3) -> WallPose<f64> {
        let of = V3::from_vec;
        WallPose {
            centre: of(centre),
            offset: of(&self.offset),
            orientation: QuaternionLanes::of(&self.orientation),
            turned: self.turned,
            velocity: of(&self.velocity),
            spin: of(&self.spin),
        }
    }

    /// World to wall frame; initial `centre`.
    #[inline(always)]
    pub fn to_local(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.pose(centre).to_local(V3::from_vec(x)).to_vec()
    }

    /// Wall frame to world.
    #[inline(always)]
    pub fn to_world(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.pose(centre).to_world(V3::from_vec(x)).to_vec()
    }

    /// Direction to world.
    #[inline(always)]
    pub fn turn(&self, v: &Vec3) -> Vec3 {
        self.pose(&Vec3::zeros()).turn(V3::from_vec(v)).to_vec()
    }

    #[inline(always)]
    pub fn velocity_at(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.pose(centre).velocity_at(V3::from_vec(x)).to_vec()
    }
}
