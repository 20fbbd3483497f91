//! Rotation of bodies with unlike principal moments.
//!
//! The angular momentum L is kept in world axes: torques change it, free rotation does not. The orientation then
//! follows the implicit midpoint rule for Euler's equations: with Π the momentum in the body frame and
//! ω = I⁻¹ (Π₀ + Π₁)/2,
//!
//! q₁ = q₀ ∘ (1, ω dt/2)/norm,  Π₁ = the same L seen from q₁,
//!
//! so that Π₁ − Π₀ = −dt ω × (Π₀ + Π₁)/2. It keeps every quadratic invariant: the kinetic energy as well as |L|,
//! to rounding, for any step (Simo & Wong, Int. J. Numer. Meth. Engng 31, 1991; Austin, Krishnaprasad & Wang,
//! J. Comput. Phys. 107, 1993). Second order, no trigonometric function. The implicit equation is solved by fixed
//! points, each gaining a factor of about ω dt.

use crate::base::Vec3;
use crate::lanes::{Real, V3};
use nalgebra::{Quaternion, UnitQuaternion};

/// Most iterations; reached only when ω dt is of the order of one, where results have no meaning anyway.
const ITERATIONS: usize = 60;

/// Rotations in lanes: vector and scalar part of unit quaternions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<R> {
    pub v: V3<R>,
    pub s: R,
}

impl<R: Real> Turn<R> {
    /// The vector turned.
    #[inline(always)]
    pub fn apply(self, x: V3<R>) -> V3<R> {
        let t = self.v.cross(x) * R::splat(2.0);
        x + t * self.s + self.v.cross(t)
    }

    /// The vector turned back.
    #[inline(always)]
    pub fn back(self, x: V3<R>) -> V3<R> {
        let t = x.cross(self.v) * R::splat(2.0);
        x + t * self.s + t.cross(self.v)
    }
}

/// Orientation after free rotation over `dt` with world angular momentum `momentum` and principal moments `inertia`.
#[inline(always)]
pub(crate) fn free<R: Real>(orientation: Turn<R>, momentum: V3<R>, inertia: V3<R>, dt: f64) -> Turn<R> {
    let start = orientation.back(momentum);
    let h = R::splat(0.5 * dt);
    let half = V3::new(h / inertia.x, h / inertia.y, h / inertia.z);
    // c = ω dt/2; the mid momentum solves Π + c × Π = Π₀.
    let mut c = V3::new(start.x * half.x, start.y * half.y, start.z * half.z);
    let one = R::splat(1.0);
    // Record that have converged stay as they are, so that none depends on its neighbours.
    let mut open = one.equals(one);
    for _ in 0..ITERATIONS {
        let c2 = c.norm2();
        let mid = (start - c.cross(start) + c * c.dot(start)) * (one / (one + c2));
        let next = V3::new(mid.x * half.x, mid.y * half.y, mid.z * half.z);
        let change = (next - c).norm2();
        c = V3::select(open, next, c);
        open = open & (R::splat(1e-33) * c2).lt(change);
        if !R::any(open) {
            break;
        }
    }
    // q ∘ (1, c), normalised.
    let Turn { v, s } = orientation;
    let (vector, scalar) = (v + c * s + v.cross(c), s - v.dot(c));
    let scale = one / (vector.norm2() + scalar * scalar).sqrt();
    Turn { v: vector * scale, s: scalar * scale }
}

/// As `free`, for one body.
pub fn free_one(
    orientation: &UnitQuaternion<f64>,
    momentum: &Vec3,
    inertia: &Vec3,
    dt: f64,
) -> UnitQuaternion<f64> {
    let q = Turn { v: V3::new(orientation.i, orientation.j, orientation.k), s: orientation.w };
    let Turn { v, s } = free(q, V3::from_vec(momentum), V3::from_vec(inertia), dt);
    UnitQuaternion::new_unchecked(Quaternion::new(s, v.x, v.y, v.z))
}

/// Orientation after turning over `dt` with a constant world spin, of the same order.
#[inline]
pub fn steady(orientation: &UnitQuaternion<f64>, spin: &Vec3, dt: f64) -> UnitQuaternion<f64> {
    normalised(Quaternion::from_parts(1.0, spin * (0.5 * dt)) * orientation.quaternion())
}

/// The turn by the angle |v| [rad] about v.
pub fn by(v: &Vec3) -> UnitQuaternion<f64> {
    let half = 0.5 * v.norm();
    let (sin, cos) = libm::sincos(half);
    // Near zero sin(half)/2 half is ½.
    let scale = if half > 1e-8 { 0.5 * sin / half } else { 0.5 };
    normalised(Quaternion::from_parts(cos, v * scale))
}

/// The vector of a turn by at most half a circle: angle [rad] times axis.
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

    /// Energy and momentum of an asymmetric top, turning near its unstable axis, over a million steps.
    #[test]
    fn asymmetric_top_keeps_energy_for_a_million_steps() {
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

    /// Error against a solution with steps a hundred times smaller falls fourfold when the step is halved.
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
