//! Kicks: what forces make of velocities in a step, without the arrays that these lie in (`leapfrog.rs`).
//!
//! Theory manual: equation (3.9) of `docs/theory/motion.md`.

use crate::lanes::{Real, V3};

/// Local damping of a force or a torque against a motion, component by component.
#[inline(always)]
pub(crate) fn resist<R: Real>(load: R, motion: R, damping: R) -> R {
    let (zero, one) = (R::zero(), R::splat(1.0));
    let sign = R::select(motion.gt(zero), one, (-one).only(motion.lt(zero)));
    -(damping * load.abs()) * sign
}

/// What drives a free body, component by component or in lanes of components.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push<R> {
    /// Of contacts [N].
    pub force: R,
    pub gravity: R,
    pub inverse_mass: R,
    /// Time that velocities advance by [s]; zero where nothing is kicked.
    pub step: R,
    pub damping: R,
}

/// Velocity of a free body after the kick, and the force of local damping, if there is any.
#[inline(always)]
pub(crate) fn kick_free<R: Real, const DAMPED: bool>(v: R, p: &Push<R>) -> (R, R) {
    if DAMPED {
        let push = p.force + p.gravity * (R::splat(1.0) / p.inverse_mass);
        let held = resist(push, v, p.damping);
        (v + (push + held) * (p.inverse_mass * p.step), held)
    } else {
        (v + (p.force * p.inverse_mass + p.gravity) * p.step, R::zero())
    }
}

/// Change of a free sphere's spin over the torque: its moment of inertia is 2/5 m r².
#[inline(always)]
pub(crate) fn turn_of_sphere<R: Real>(kick: R, inverse_mass: R, radius: R) -> R {
    R::splat(2.5) * kick * inverse_mass / (radius * radius)
}

/// A body kicked by itself: with applied forces, fixed motions, or in the last places of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single<R: Real> {
    pub velocity: V3<R>,
    pub spin: V3<R>,
    /// Sums of contacts, and of applied forces.
    pub force: (V3<R>, V3<R>),
    pub torque: (V3<R>, V3<R>),
    pub gravity: V3<R>,
    pub mass: R,
    /// Of a sphere.
    pub inertia: R,
    /// Which motions are fixed: translation, rotation.
    pub fixed: [[R::Mask; 3]; 2],
    pub damping: R,
}

/// What a kick makes of a [`Single`]: velocity, spin of a sphere, all forces and torques, and those of local damping.
pub(crate) struct Kicked<R> {
    pub velocity: V3<R>,
    pub spin: V3<R>,
    pub force: V3<R>,
    pub torque: V3<R>,
    pub damping: V3<R>,
    pub damping_torque: V3<R>,
}

/// Sign with sign(0) = 0: a body at rest is not damped.
#[inline(always)]
fn sign<R: Real>(x: R) -> R {
    let one = R::splat(1.0);
    R::select(x.equals(R::zero()), R::zero(), R::select(x.gt(R::zero()), one, -one))
}

/// Share of local damping in a load against a motion.
#[inline(always)]
fn held<R: Real>(load: V3<R>, motion: V3<R>, damping: R) -> V3<R> {
    let of = -damping;
    V3::new(
        of * load.x.abs() * sign(motion.x),
        of * load.y.abs() * sign(motion.y),
        of * load.z.abs() * sign(motion.z),
    )
}

/// `old` where a motion is fixed, else advanced.
#[inline(always)]
fn advanced<R: Real>(old: V3<R>, load: V3<R>, share: R, fixed: &[R::Mask; 3]) -> V3<R> {
    let new = old + load * share;
    V3::new(
        R::select(fixed[0], old.x, new.x),
        R::select(fixed[1], old.y, new.y),
        R::select(fixed[2], old.z, new.z),
    )
}

/// Kicks one body over `kick` [s].
#[inline(always)]
pub(crate) fn kick_single<R: Real>(s: &Single<R>, kick: R) -> Kicked<R> {
    let mut force = s.force.0 + s.force.1 + s.gravity * s.mass;
    let mut torque = s.torque.0 + s.torque.1;
    let damping = held(force, s.velocity, s.damping);
    let damping_torque = held(torque, s.spin, s.damping);
    force = force + damping;
    torque = torque + damping_torque;
    Kicked {
        velocity: advanced(s.velocity, force, kick / s.mass, &s.fixed[0]),
        spin: advanced(s.spin, torque, kick / s.inertia, &s.fixed[1]),
        force,
        torque,
        damping,
        damping_torque,
    }
}
