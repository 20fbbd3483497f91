//! Kicks and rotations of oriented bodies.

use super::rotation;
use crate::lanes::quaternion::{self, QuaternionLanes, over};
use crate::lanes::{Real, V3};

#[derive(Clone, Copy, Debug)]
pub struct Rigid<R> {
    pub orientation: QuaternionLanes<R>,
    /// Global axes.
    pub momentum: V3<R>,
    pub spin: V3<R>,
    pub inertia: V3<R>,
}

#[derive(Clone, Copy, Debug)]
pub struct RotatedBody<R> {
    pub orientation: QuaternionLanes<R>,
    pub momentum: V3<R>,
    pub spin: V3<R>,
    /// Mean angular velocity of the kick.
    pub mean: V3<R>,
}

#[inline(always)]
pub fn kicked<R: Real>(body: &Rigid<R>, torque: V3<R>, kick: R) -> V3<R> {
    body.momentum + torque * kick
}

/// Orientation, angular velocity, power of the local damping torque.
#[derive(Clone, Copy, Debug)]
pub struct GroupRotation<R> {
    pub orientation: QuaternionLanes<R>,
    pub spin: V3<R>,
    pub power: R,
}

/// Single spheres keep their orientation. `momentum`, `new`: after the step.
#[inline(always)]
pub fn rotate_in_group<R: Real, const DAMPED: bool>(
    body: &Rigid<R>,
    sphere: R::Mask,
    (impulse, stop): (V3<R>, V3<R>),
    momentum: V3<R>,
    new: QuaternionLanes<R>,
) -> GroupRotation<R> {
    let Rigid { orientation: old, spin: before, inertia, .. } = *body;
    let rate = new.apply(over(new.back(momentum), inertia));
    let of_sphere = before + V3::new(impulse.x / inertia.x, impulse.y / inertia.x, impulse.z / inertia.x);
    let mut power = R::zero();
    if DAMPED {
        // After the kick, before the rotation.
        let kicked = old.apply(over(old.back(momentum), inertia));
        let kicked = V3::select(sphere, of_sphere, kicked);
        power = stop.dot(before + kicked) * R::splat(0.5);
    }
    GroupRotation {
        orientation: QuaternionLanes {
            v: V3::select(sphere, old.v, new.v),
            s: R::select(sphere, old.s, new.s),
        },
        spin: V3::select(sphere, of_sphere, rate),
        power,
    }
}

/// `momentum`, `new`: after the step.
#[inline(always)]
pub fn rotate_single<R: Real>(body: &Rigid<R>, momentum: V3<R>, new: QuaternionLanes<R>) -> RotatedBody<R> {
    let kicked = quaternion::spin(body.orientation, momentum, body.inertia);
    let spin = quaternion::spin(new, momentum, body.inertia);
    RotatedBody { orientation: new, momentum, spin, mean: (body.spin + kicked) * R::splat(0.5) }
}

/// Constrained rotation; angular impulse and work of the constraint.
#[inline(always)]
pub fn rotate_prescribed<R: Real>(
    body: &Rigid<R>,
    torque: V3<R>,
    spin: V3<R>,
    kick: R,
    dt: R,
) -> (RotatedBody<R>, V3<R>, R) {
    let orientation = rotation::steadily(body.orientation, spin, dt);
    let momentum = quaternion::momentum(orientation, spin, body.inertia);
    let half = R::splat(0.5);
    let mean = (body.spin + spin) * half;
    let impulse = momentum - body.momentum - torque * kick;
    let work = half * (momentum.dot(spin) - body.momentum.dot(body.spin)) - torque.dot(mean) * kick;
    (RotatedBody { orientation, momentum, spin, mean }, impulse, work)
}

/// Largest squared speed of a body's points, from the centre's.
#[inline(always)]
pub fn fastest2<R: Real>(speed2: R, spin: V3<R>, reach: R) -> R {
    let speed = speed2.sqrt() + spin.norm2().sqrt() * reach;
    speed * speed
}
