//! Where walls are and how they move.

use crate::base::Vec3;
use crate::lanes::turn::Turn;
use crate::lanes::{Real, V3};
use crate::law::History;
use crate::pairs::meets::Meet;
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
    /// Force of grains and other walls on the wall in the last step [N], and its moment about the centre [N m].
    pub force: Vec3,
    pub moment: Vec3,
    /// Principal frame and angular momentum of a rigid body.
    pub frame: UnitQuaternion<f64>,
    pub momentum: Vec3,
    /// Acceleration of its centre in the last step [m/s²].
    pub acceleration: Vec3,
    /// Change of the velocity of a driven wall in the last step [m/s].
    pub change: Vec3,
    pub feet: Vec<Foot>,
    /// Where a body of triangles touches other walls, by these and by what touches.
    pub meets: Vec<Meet>,
}

/// Place and motion of a wall as formulas need them; see [`WallState`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<R: Real> {
    /// Centre at the start.
    pub centre: V3<R>,
    pub offset: V3<R>,
    pub orientation: Turn<R>,
    pub turned: R::Mask,
    pub velocity: V3<R>,
    pub spin: V3<R>,
}

impl<R: Real> Place<R> {
    /// A world point in the frame of the wall.
    #[inline(always)]
    pub fn to_local(self, x: V3<R>) -> V3<R> {
        let back = x - self.offset;
        if !R::any(self.turned) {
            return back;
        }
        let turned = self.orientation.inverse().times(back - self.centre) + self.centre;
        V3::select(self.turned, turned, back)
    }

    /// A point of the wall's frame in the world.
    #[inline(always)]
    pub fn to_world(self, x: V3<R>) -> V3<R> {
        let moved = x + self.offset;
        if !R::any(self.turned) {
            return moved;
        }
        let turned = self.orientation.times(x - self.centre) + self.centre + self.offset;
        V3::select(self.turned, turned, moved)
    }

    /// A direction of the wall's frame in the world.
    #[inline(always)]
    pub fn turn(self, v: V3<R>) -> V3<R> {
        if !R::any(self.turned) {
            return v;
        }
        V3::select(self.turned, self.orientation.times(v), v)
    }

    /// Velocity of the wall's point at `x` [m/s].
    #[inline(always)]
    pub fn velocity_at(self, x: V3<R>) -> V3<R> {
        self.velocity + self.spin.cross(x - self.centre - self.offset)
    }
}

impl WallState {
    /// As formulas need it; `centre`: that of the wall at the start.
    #[inline(always)]
    fn place(&self, centre: &Vec3) -> Place<f64> {
        let of = V3::from_vec;
        Place {
            centre: of(centre),
            offset: of(&self.offset),
            orientation: Turn::of(&self.orientation),
            turned: self.turned,
            velocity: of(&self.velocity),
            spin: of(&self.spin),
        }
    }

    /// A world point in the frame of the wall, whose centre was at `centre` at the start.
    #[inline(always)]
    pub fn to_local(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.place(centre).to_local(V3::from_vec(x)).to_vec()
    }

    /// A point of the wall's frame in the world.
    #[inline(always)]
    pub fn to_world(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.place(centre).to_world(V3::from_vec(x)).to_vec()
    }

    /// A direction of the wall's frame in the world.
    #[inline(always)]
    pub fn turn(&self, v: &Vec3) -> Vec3 {
        self.place(&Vec3::zeros()).turn(V3::from_vec(v)).to_vec()
    }

    /// Velocity of the wall's point at `x` [m/s].
    #[inline(always)]
    pub fn velocity_at(&self, centre: &Vec3, x: &Vec3) -> Vec3 {
        self.place(centre).velocity_at(V3::from_vec(x)).to_vec()
    }
}
