//! Motion of the bodies of a block.

use crate::base::Vec3;
use crate::base::held::held;
use crate::lanes::V3;
use crate::lanes::record::{Record, xyz};
use crate::lanes::turn::{self, Turn};
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Orientation and angular momentum of a body that is not a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rotation {
    /// Body frame to world.
    pub orientation: UnitQuaternion<f64>,
    /// Angular momentum about the centre, world axes, half a step ago [kg m²/s].
    pub momentum: Vec3,
}

/// World angular velocity from the angular momentum.
#[inline(always)]
pub(crate) fn spin_of(rotation: &Rotation, inertia: &Vec3) -> Vec3 {
    let (q, momentum) = (Turn::of(&rotation.orientation), V3::from_vec(&rotation.momentum));
    turn::spin(q, momentum, V3::from_vec(inertia)).to_vec()
}

/// Neighbouring bodies: arrays of equal length, in block order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Block {
    /// Number of each body in the input.
    pub bodies: Vec<u32>,
    /// Position and radius (of a sphere; bounding otherwise).
    pub centre: Vec<Record>,
    /// Velocity and inverse mass.
    pub velocity: Vec<Record>,
    /// Spin and material index.
    pub spin: Vec<Record>,
    /// Empty in blocks of single spheres only.
    pub rotation: Vec<Rotation>,
}

impl Block {
    /// Gives up memory that the bodies do not need.
    pub fn fit(&mut self) {
        self.bodies.shrink_to_fit();
        self.centre.shrink_to_fit();
        self.velocity.shrink_to_fit();
        self.spin.shrink_to_fit();
        self.rotation.shrink_to_fit();
    }

    /// Material (index) of a body.
    #[inline(always)]
    pub fn material(&self, k: usize) -> u32 {
        self.spin[k][3] as u32
    }

    /// Motion of a body as a contact at `point` needs it.
    #[inline(always)]
    pub fn motion(&self, body: usize, point: &Vec3) -> PointMotion {
        let arm = point - xyz(&self.centre[body]);
        PointMotion { velocity: self.velocity[body], spin: self.spin[body], arm }
    }
}

/// Motion of one body as a contact needs it.
pub(crate) struct PointMotion {
    pub velocity: Record,
    spin: Record,
    /// From the body's centre to the contact point.
    pub arm: Vec3,
}

impl PointMotion {
    /// Motion of a plane, which no force changes.
    #[inline(always)]
    pub fn of_plane(velocity: &Vec3) -> PointMotion {
        PointMotion { velocity: Record::of(velocity, 0.0), spin: Record::default(), arm: Vec3::zeros() }
    }

    /// Motion of a rigid whole at a point `arm` away from where it has a velocity [m/s], with one over its mass [1/kg].
    #[inline(always)]
    pub fn of_whole(velocity: &Vec3, spin: &Vec3, arm: Vec3, inverse_mass: f64) -> PointMotion {
        PointMotion { velocity: Record::of(velocity, inverse_mass), spin: Record::of(spin, 0.0), arm }
    }

    #[inline(always)]
    pub fn spin(&self) -> Vec3 {
        xyz(&self.spin)
    }

    #[inline(always)]
    pub fn at_point(&self) -> Vec3 {
        xyz(&self.velocity) + xyz(&self.spin).cross(&self.arm)
    }

    /// One over the body's mass [1/kg].
    #[inline(always)]
    pub fn inverse_mass(&self) -> f64 {
        self.velocity[3]
    }
}

impl Block {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let arrays = held(&self.centre) + held(&self.velocity) + held(&self.spin);
        held(&self.bodies) + arrays + held(&self.rotation)
    }
}
