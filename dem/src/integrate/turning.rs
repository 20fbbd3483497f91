//! Kicks and turns of bodies with orientations, without the arrays that these lie in (`leapfrog.rs`). How a free body turns is solved
//! by iterations (`rotation.rs`), whose result is handed in.

use super::rotation;
use crate::lanes::turn::{self, Turn, over};
use crate::lanes::{Real, V3};

/// A body before a kick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rigid<R> {
    pub orientation: Turn<R>,
    /// Angular momentum and spin in world axes.
    pub momentum: V3<R>,
    pub spin: V3<R>,
    /// Principal moments.
    pub inertia: V3<R>,
}

/// The same after the kick, at the end of the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<R> {
    pub orientation: Turn<R>,
    pub momentum: V3<R>,
    pub spin: V3<R>,
    /// Mean spin of the kick.
    pub mean: V3<R>,
}

/// What the kick makes of the momentum.
#[inline(always)]
pub(crate) fn kicked<R: Real>(body: &Rigid<R>, torque: V3<R>, kick: R) -> V3<R> {
    body.momentum + torque * kick
}

/// Orientation and spin of a free body that moves with others, and the power of local damping by the torque `stop`, where there is any.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Among<R> {
    pub orientation: Turn<R>,
    pub spin: V3<R>,
    pub power: R,
}

/// Turns free bodies, some of which may be single spheres: these have a spin, but keep their orientation. `impulse`: of all torques;
/// `momentum`: after it; `new`: the orientation that follows from it.
#[inline(always)]
pub(crate) fn among<R: Real, const DAMPED: bool>(
    body: &Rigid<R>,
    sphere: R::Mask,
    (impulse, stop): (V3<R>, V3<R>),
    momentum: V3<R>,
    new: Turn<R>,
) -> Among<R> {
    let Rigid { orientation: old, spin: before, inertia, .. } = *body;
    let rate = new.apply(over(new.back(momentum), inertia));
    let of_sphere = before + V3::new(impulse.x / inertia.x, impulse.y / inertia.x, impulse.z / inertia.x);
    let mut power = R::zero();
    if DAMPED {
        // The spin after the kick, before the turn.
        let kicked = old.apply(over(old.back(momentum), inertia));
        let kicked = V3::select(sphere, of_sphere, kicked);
        power = stop.dot(before + kicked) * R::splat(0.5);
    }
    Among {
        orientation: Turn { v: V3::select(sphere, old.v, new.v), s: R::select(sphere, old.s, new.s) },
        spin: V3::select(sphere, of_sphere, rate),
        power,
    }
}

/// Turns a free body that moves by itself; `momentum`: after the kick; `new`: the orientation that follows from it.
#[inline(always)]
pub(crate) fn alone<R: Real>(body: &Rigid<R>, momentum: V3<R>, new: Turn<R>) -> Turned<R> {
    let kicked = turn::spin(body.orientation, momentum, body.inertia);
    let spin = turn::spin(new, momentum, body.inertia);
    Turned { orientation: new, momentum, spin, mean: (body.spin + kicked) * R::splat(0.5) }
}

/// A body that something holds to a spin; the angular impulse and the work of what holds it.
#[inline(always)]
pub(crate) fn held<R: Real>(
    body: &Rigid<R>,
    torque: V3<R>,
    spin: V3<R>,
    kick: R,
    dt: R,
) -> (Turned<R>, V3<R>, R) {
    let orientation = rotation::steadily(body.orientation, spin, dt);
    let momentum = turn::momentum(orientation, spin, body.inertia);
    let half = R::splat(0.5);
    let mean = (body.spin + spin) * half;
    let impulse = momentum - body.momentum - torque * kick;
    let work = half * (momentum.dot(spin) - body.momentum.dot(body.spin)) - torque.dot(mean) * kick;
    (Turned { orientation, momentum, spin, mean }, impulse, work)
}

/// Square of the largest speed of a point of a body, given the square of that of its centre.
#[inline(always)]
pub(crate) fn fastest2<R: Real>(speed2: R, spin: V3<R>, reach: R) -> R {
    let speed = speed2.sqrt() + spin.norm2().sqrt() * reach;
    speed * speed
}
