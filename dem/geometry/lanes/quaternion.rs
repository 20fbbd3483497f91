//! Rotations of any number type.

use super::{Real, V3};
use nalgebra::{Quaternion, UnitQuaternion};

/// Unit quaternion: vector and scalar part.
#[derive(Clone, Copy, Debug)]
pub struct QuaternionLanes<R> {
    pub v: V3<R>,
    pub s: R,
}

impl<R: Real> QuaternionLanes<R> {
    #[inline(always)]
    pub fn apply(self, x: V3<R>) -> V3<R> {
        let t = self.v.cross(x) * R::splat(2.0);
        x + t * self.s + self.v.cross(t)
    }

    /// Inverse rotation of a vector.
    #[inline(always)]
    pub fn back(self, x: V3<R>) -> V3<R> {
        let t = x.cross(self.v) * R::splat(2.0);
        x + t * self.s + t.cross(self.v)
    }

    /// As [`QuaternionLanes::apply`], with nalgebra's bits, for bodies integrated singly.
    #[inline(always)]
    pub fn times(self, x: V3<R>) -> V3<R> {
        let t = self.v.cross(x) * R::splat(2.0);
        t * self.s + self.v.cross(t) + x
    }

    #[inline(always)]
    pub fn inverse(self) -> QuaternionLanes<R> {
        QuaternionLanes { v: -self.v, s: self.s }
    }

    /// Columns of the rotation matrix.
    #[inline(always)]
    pub fn columns(self) -> [V3<R>; 3] {
        let QuaternionLanes { v: V3 { x: i, y: j, z: k }, s } = self;
        let two = R::splat(2.0);
        let (ii, jj, kk, ss) = (i * i, j * j, k * k, s * s);
        let (ij, ik, jk) = (i * j * two, i * k * two, j * k * two);
        let (si, sj, sk) = (s * i * two, s * j * two, s * k * two);
        [
            V3::new(ss + ii - jj - kk, sk + ij, ik - sj),
            V3::new(ij - sk, ss - ii + jj - kk, si + jk),
            V3::new(sj + ik, jk - si, ss - ii - jj + kk),
        ]
    }
}

impl QuaternionLanes<f64> {
    #[inline(always)]
    pub fn of(q: &UnitQuaternion<f64>) -> QuaternionLanes<f64> {
        QuaternionLanes { v: V3::new(q.i, q.j, q.k), s: q.w }
    }

    #[inline(always)]
    pub fn quaternion(self) -> UnitQuaternion<f64> {
        UnitQuaternion::new_unchecked(Quaternion::new(self.s, self.v.x, self.v.y, self.v.z))
    }
}

/// Global position of a body point, from rotation columns and centre.
#[inline(always)]
pub fn placed<R: Real>([x, y, z]: [V3<R>; 3], centre: V3<R>, local: V3<R>) -> V3<R> {
    centre + ((x * local.x + y * local.y) + z * local.z)
}

/// Divides by principal moments.
#[inline(always)]
pub fn over<R: Real>(a: V3<R>, inertia: V3<R>) -> V3<R> {
    V3::new(a.x / inertia.x, a.y / inertia.y, a.z / inertia.z)
}

/// Angular velocity from angular momentum, global axes.
#[inline(always)]
pub fn spin<R: Real>(q: QuaternionLanes<R>, momentum: V3<R>, inertia: V3<R>) -> V3<R> {
    q.times(over(q.inverse().times(momentum), inertia))
}

/// Angular momentum from angular velocity, global axes.
#[inline(always)]
pub fn momentum<R: Real>(q: QuaternionLanes<R>, spin: V3<R>, inertia: V3<R>) -> V3<R> {
    let local = q.inverse().times(spin);
    q.times(V3::new(local.x * inertia.x, local.y * inertia.y, local.z * inertia.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Vec3;

    #[test]
    fn the_bits_are_those_of_nalgebra() {
        for k in 0..1000_i32 {
            let x = |i: i32| libm::sin(f64::from(7 * k + i) * 1.7);
            let vector = |i: i32| Vec3::new(x(i), x(i + 1), x(i + 2));
            let q = UnitQuaternion::new_normalize(Quaternion::new(x(0), x(1), x(2), x(3)));
            let (a, b, inertia) = (vector(4), vector(7), vector(10).map(|i| 1.5 + i));
            let (turn, of) = (QuaternionLanes::of(&q), V3::from_vec);
            let local = q.inverse_transform_vector(&a);
            let found = spin(turn, of(&a), of(&inertia)).to_vec();
            assert_eq!(found, q * local.component_div(&inertia));
            assert_eq!(momentum(turn, of(&a), of(&inertia)).to_vec(), q * local.component_mul(&inertia));
            assert_eq!(placed(turn.columns(), of(&a), of(&b)).to_vec(), a + q.to_rotation_matrix() * b);
        }
    }
}
