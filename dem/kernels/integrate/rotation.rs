//! Rotation of bodies with different principal moments.
//!
//! The global angular momentum L is stored. The orientation follows the implicit midpoint rule for Euler's
//! equations.
//!
//! Second order; conserves kinetic energy and |L| to rounding for any step (Simo & Wong, Int. J. Numer. Meth.
//! Engng 31, 1991; Austin, Krishnaprasad & Wang, J. Comput. Phys. 107, 1993). Solved by fixed-point
//! iteration.
//!
//! Theory manual: equation (3.4) of `docs/theory/motion.md`.

use crate::base::Vec3;
use crate::lanes::quaternion::QuaternionLanes;
use crate::lanes::{Real, V3};
use nalgebra::{Quaternion, UnitQuaternion};

/// Reached only for ω dt of order one.
pub const ITERATIONS: usize = 60;

/// Solution c = ω dt/2.
#[derive(Clone, Copy, Debug)]
pub struct Midpoint<R> {
    /// Initial momentum in the body frame.
    pub start: V3<R>,
    /// dt/2 over the principal moments.
    pub half: V3<R>,
}

impl<R: Real> Midpoint<R> {
    #[doc(hidden)]
    #[inline(always)]
    pub fn new(orientation: QuaternionLanes<R>, momentum: V3<R>, inertia: V3<R>, dt: R) -> Midpoint<R> {
        let h = R::splat(0.5) * dt;
        let half = V3::new(h / inertia.x, h / inertia.y, h / inertia.z);
        Midpoint { start: orientation.back(momentum), half }
    }

    #[doc(hidden)]
    #[inline(always)]
    pub fn guess(&self) -> V3<R> {
        let Midpoint { start, half } = self;
        V3::new(start.x * half.x, start.y * half.y, start.z * half.z)
    }

    /// One iteration of Π + c × Π = Π₀.
    #[inline(always)]
    pub fn iterate(&self, c: V3<R>) -> (V3<R>, R::Mask) {
        let Midpoint { start, half } = *self;
        let one = R::splat(1.0);
        let c2 = c.norm2();
        let mid = (start - c.cross(start) + c * c.dot(start)) * (one / (one + c2));
        let next = V3::new(mid.x * half.x, mid.y * half.y, mid.z * half.z);
        let change = (next - c).norm2();
        (next, (R::splat(1e-33) * c2).lt(change))
    }

    #[inline(always)]
    fn solve(&self) -> V3<R> {
        let mut c = self.guess();
        let one = R::splat(1.0);
        // Converged lanes are frozen: independent of their neighbours.
        let mut open = one.equals(one);
        for _ in 0..ITERATIONS {
            let (next, more) = self.iterate(c);
            c = V3::select(open, next, c);
            open = open & more;
            if !R::any(open) {
                break;
            }
        }
        c
    }
}

/// q ∘ (1, c), normalised.
#[inline(always)]
pub fn turned<R: Real>(orientation: QuaternionLanes<R>, c: V3<R>) -> QuaternionLanes<R> {
    let QuaternionLanes { v, s } = orientation;
    let (vector, scalar) = (v + c * s + v.cross(c), s - v.dot(c));
    let scale = R::splat(1.0) / (vector.norm2() + scalar * scalar).sqrt();
    QuaternionLanes { v: vector * scale, s: scalar * scale }
}

/// Orientation after free rotation; `momentum` global.
#[inline(always)]
pub fn free<R: Real>(
    orientation: QuaternionLanes<R>,
    momentum: V3<R>,
    inertia: V3<R>,
    dt: R,
) -> QuaternionLanes<R> {
    turned(orientation, Midpoint::new(orientation, momentum, inertia, dt).solve())
}

/// As `free`, for one body.
pub fn free_one(
    orientation: &UnitQuaternion<f64>,
    momentum: &Vec3,
    inertia: &Vec3,
    dt: f64,
) -> UnitQuaternion<f64> {
    free(QuaternionLanes::of(orientation), V3::from_vec(momentum), V3::from_vec(inertia), dt).quaternion()
}

/// Orientation after rotation at constant global angular velocity.
#[inline(always)]
pub fn steadily<R: Real>(q: QuaternionLanes<R>, spin: V3<R>, dt: R) -> QuaternionLanes<R> {
    let (one, V3 { x: i, y: j, z: k }) = (R::splat(1.0), spin * (R::splat(0.5) * dt));
    let QuaternionLanes { v, s } = q;
    let scalar = one * s - i * v.x - j * v.y - k * v.z;
    let x = one * v.x + i * s + j * v.z - k * v.y;
    let y = one * v.y - i * v.z + j * s + k * v.x;
    let z = one * v.z + i * v.y - j * v.x + k * s;
    let norm = ((x * x + z * z) + (y * y + scalar * scalar)).sqrt();
    QuaternionLanes { v: V3::new(x / norm, y / norm, z / norm), s: scalar / norm }
}

/// As `steadily`, for one body.
#[inline]
pub fn steady(orientation: &UnitQuaternion<f64>, spin: &Vec3, dt: f64) -> UnitQuaternion<f64> {
    steadily(QuaternionLanes::of(orientation), V3::from_vec(spin), dt).quaternion()
}

/// Rotation by the angle |v| [rad] about v.
pub fn by(v: &Vec3) -> UnitQuaternion<f64> {
    let half = 0.5 * v.norm();
    let (sin, cos) = libm::sincos(half);
    // Limit ½ at zero.
    let scale = if half > 1e-8 { 0.5 * sin / half } else { 0.5 };
    normalised(Quaternion::from_parts(cos, v * scale))
}

/// Rotation vector: angle [rad] (at most π) times axis.
pub fn vector(turn: &UnitQuaternion<f64>) -> Vec3 {
    let (v, s) = (turn.imag(), turn.w);
    let length = v.norm();
    let angle = 2.0 * libm::atan2(length, s.abs());
    let scale = if length > 1e-8 { angle / length } else { 2.0 };
    v * if s < 0.0 { -scale } else { scale }
}

#[inline(always)]
fn normalised(q: Quaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_and_their_vectors() {
        for v in
            [Vec3::zeros(), Vec3::new(1e-12, 0.0, 2e-12), Vec3::new(0.3, -0.2, 0.7), Vec3::new(0.0, 3.0, 0.1)]
        {
            let q = by(&v);
            let error = q.angle_to(&UnitQuaternion::from_scaled_axis(v));
            assert!(error < 1e-7 && (vector(&q) - v).norm() < 1e-14 + 1e-14 * v.norm(), "{v} {error}");
            let same = UnitQuaternion::new_unchecked(-q.into_inner());
            assert!((vector(&same) - v).norm() < 1e-14 + 1e-14 * v.norm());
        }
    }

    fn spin(q: &UnitQuaternion<f64>, momentum: &Vec3, inertia: &Vec3) -> Vec3 {
        q * q.inverse_transform_vector(momentum).component_div(inertia)
    }

    #[test]
    fn steady_rotation_matches_nalgebra_bits() {
        for k in 0..1000_i32 {
            let x = |i: i32| libm::sin(f64::from(7 * k + i) * 1.7);
            let q = UnitQuaternion::new_normalize(Quaternion::new(x(0), x(1), x(2), x(3)));
            let spin = Vec3::new(x(4), x(5), x(6));
            let product = normalised(Quaternion::from_parts(1.0, spin * (0.5 * 1e-3)) * q.quaternion());
            assert_eq!(steady(&q, &spin, 1e-3), product);
        }
    }

    #[test]
    fn asymmetric_top_conserves_energy() {
        let inertia = Vec3::new(1.0, 2.0, 3.0);
        let momentum = Vec3::new(0.02, 2.0, 0.05);
        let mut q = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.7);
        let momentum = q * momentum;
        let energy = |q: &UnitQuaternion<f64>| 0.5 * momentum.dot(&spin(q, &momentum, &inertia));
        let start = energy(&q);
        let (mut worst, mut flips) = (0.0_f64, 0);
        let mut side = true;
        for _ in 0..1_000_000 {
            q = free_one(&q, &momentum, &inertia, 1e-3);
            worst = worst.max((energy(&q) / start - 1.0).abs());
            let up = q.inverse_transform_vector(&momentum).y > 0.0;
            flips += usize::from(up != side);
            side = up;
        }
        assert!(worst < 1e-12, "energy drift {worst:e}");
        assert!((q.quaternion().norm() - 1.0).abs() < 1e-14);
        assert!(flips > 50, "the top must tumble, {flips}");
    }

    /// Reference: steps a hundred times smaller.
    #[test]
    fn second_order() {
        let inertia = Vec3::new(1.0, 2.0, 3.0);
        let momentum = Vec3::new(1.0, 2.0, 0.7);
        let run = |n: usize| {
            let mut q = UnitQuaternion::identity();
            for _ in 0..n {
                q = free_one(&q, &momentum, &inertia, 4.0 / n as f64);
            }
            q
        };
        let exact = run(40_000);
        let errors = [100, 200, 400].map(|n| run(n).angle_to(&exact));
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.02, "order {order}");
        }
    }
}
