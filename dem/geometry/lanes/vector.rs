//! Vectors of lanes.

use super::real::Real;
use std::ops::{Add, Mul, Neg, Sub};

/// Vector of three lane-wide components.
#[derive(Clone, Copy, Debug)]
pub struct V3<R> {
    /// First component.
    pub x: R,
    /// Second component.
    pub y: R,
    /// Third component.
    pub z: R,
}

impl<R: Real> V3<R> {
    /// Vector of components.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> V3<R> {
        V3 { x, y, z }
    }

    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> V3<R> {
        V3 { x: R::zero(), y: R::zero(), z: R::zero() }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: &crate::base::Vec3) -> V3<R> {
        V3 { x: R::splat(v.x), y: R::splat(v.y), z: R::splat(v.z) }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: V3<R>) -> R {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: V3<R>) -> V3<R> {
        V3 { x: self.y * o.z - self.z * o.y, y: self.z * o.x - self.x * o.z, z: self.x * o.y - self.y * o.x }
    }

    /// Components.
    #[inline(always)]
    pub fn array(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }

    /// Squared length.
    #[inline(always)]
    pub fn norm2(self) -> R {
        self.dot(self)
    }

    /// `yes` if set, else `no`.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: V3<R>, no: V3<R>) -> V3<R> {
        V3 {
            x: R::select(mask, yes.x, no.x),
            y: R::select(mask, yes.y, no.y),
            z: R::select(mask, yes.z, no.z),
        }
    }

    /// `self` if set, else zero.
    #[inline(always)]
    pub fn only(self, mask: R::Mask) -> V3<R> {
        V3 { x: self.x.only(mask), y: self.y.only(mask), z: self.z.only(mask) }
    }
}

impl<R: Real> Add for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn add(self, o: V3<R>) -> V3<R> {
        V3 { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<R: Real> Sub for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn sub(self, o: V3<R>) -> V3<R> {
        V3 { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<R: Real> Neg for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn neg(self) -> V3<R> {
        V3 { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<R: Real> Mul<R> for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn mul(self, s: R) -> V3<R> {
        V3 { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

impl V3<f64> {
    /// Single-lane vector.
    #[inline(always)]
    pub fn from_vec(v: &crate::base::Vec3) -> V3<f64> {
        V3 { x: v.x, y: v.y, z: v.z }
    }

    /// Converts to `Vec3`.
    #[inline(always)]
    pub fn to_vec(self) -> crate::base::Vec3 {
        crate::base::Vec3::new(self.x, self.y, self.z)
    }
}
