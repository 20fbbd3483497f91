//! State of the bodies of a block.

use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::lanes::V3;
use crate::lanes::quaternion::{self, QuaternionLanes};
use crate::lanes::vec4::{Vec4, xyz};
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotation {
    /// Body frame to world.
    pub orientation: UnitQuaternion<f64>,
    /// Angular momentum about the centre at the last half step, world axes [kg m²/s].
    pub momentum: Vec3,
}

#[inline(always)]
pub fn spin_of(rotation: &Rotation, inertia: &Vec3) -> Vec3 {
    let (q, momentum) = (QuaternionLanes::of(&rotation.orientation), V3::from_vec(&rotation.momentum));
    quaternion::spin(q, momentum, V3::from_vec(inertia)).to_vec()
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Block {
    /// Input indices.
    pub bodies: Vec<u32>,
    /// Centre, (bounding) radius.
    pub centre: Vec<Vec4>,
    pub velocity: Vec<Vec4>,
    /// Angular velocity, material index.
    pub spin: Vec<Vec4>,
    /// Empty for single spheres.
    pub rotation: Vec<Rotation>,
}

impl Block {
    pub fn fit(&mut self) {
        self.bodies.shrink_to_fit();
        self.centre.shrink_to_fit();
        self.velocity.shrink_to_fit();
        self.spin.shrink_to_fit();
        self.rotation.shrink_to_fit();
    }

    #[inline(always)]
    pub fn material(&self, k: usize) -> u32 {
        self.spin[k][3] as u32
    }

    #[inline(always)]
    pub fn motion(&self, body: usize, point: &Vec3) -> PointMotion {
        let arm = point - xyz(&self.centre[body]);
        PointMotion { velocity: self.velocity[body], spin: self.spin[body], arm }
    }
}

pub struct PointMotion {
    pub velocity: Vec4,
    spin: Vec4,
    pub arm: Vec3,
}

impl PointMotion {
    #[inline(always)]
    pub fn of_plane(velocity: &Vec3) -> PointMotion {
        PointMotion { velocity: Vec4::of(velocity, 0.0), spin: Vec4::default(), arm: Vec3::zeros() }
    }

    /// Motion of a rigid body at `arm` from its reference point.
    #[inline(always)]
    pub fn of_whole(velocity: &Vec3, spin: &Vec3, arm: Vec3, inverse_mass: f64) -> PointMotion {
        PointMotion { velocity: Vec4::of(velocity, inverse_mass), spin: Vec4::of(spin, 0.0), arm }
    }

    #[inline(always)]
    pub fn spin(&self) -> Vec3 {
        xyz(&self.spin)
    }

    #[inline(always)]
    pub fn at_point(&self) -> Vec3 {
        xyz(&self.velocity) + xyz(&self.spin).cross(&self.arm)
    }

    #[inline(always)]
    pub fn inverse_mass(&self) -> f64 {
        self.velocity[3]
    }
}

impl Block {
    pub fn bytes(&self) -> usize {
        let arrays =
            capacity_bytes(&self.centre) + capacity_bytes(&self.velocity) + capacity_bytes(&self.spin);
        capacity_bytes(&self.bodies) + arrays + capacity_bytes(&self.rotation)
    }
}
