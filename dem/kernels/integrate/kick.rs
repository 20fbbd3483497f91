//! Kicks: velocity changes of a step.
//!
//! Theory manual: equation (3.9) of `docs/theory/motion.md`.

use crate::lanes::{Real, V3};

/// Local damping of a force or torque component.
#[inline(always)]
pub fn resist<R: Real>(load: R, motion: R, damping: R) -> R {
    let (zero, one) = (R::zero(), R::splat(1.0));
    let sign = R::select(motion.gt(zero), one, (-one).only(motion.lt(zero)));
    -(damping * load.abs()) * sign
}

/// Loads on a free body, by component.
#[derive(Clone, Copy, Debug)]
pub struct Push<R> {
    pub force: R,
    pub gravity: R,
    pub inverse_mass: R,
    /// Zero for no kick [s].
    pub step: R,
    pub damping: R,
}

/// Velocity after the kick, and local damping force.
#[inline(always)]
pub fn kick_free<R: Real, const DAMPED: bool>(v: R, p: &Push<R>) -> (R, R) {
    if DAMPED {
        let push = p.force + p.gravity * (R::splat(1.0) / p.inverse_mass);
        let held = resist(push, v, p.damping);
        (v + (push + held) * (p.inverse_mass * p.step), held)
    } else {
        (v + (p.force * p.inverse_mass + p.gravity) * p.step, R::zero())
    }
}

/// I = 2/5 m r².
#[inline(always)]
pub fn turn_of_sphere<R: Real>(kick: R, inverse_mass: R, radius: R) -> R {
    R::splat(2.5) * kick * inverse_mass / (radius * radius)
}

#[derive(Clone, Copy, Debug)]
pub struct Single<R: Real> {
    pub velocity: V3<R>,
    pub spin: V3<R>,
    /// Contacts; applied forces.
    pub force: (V3<R>, V3<R>),
    pub torque: (V3<R>, V3<R>),
    pub gravity: V3<R>,
    pub mass: R,
    /// For a sphere.
    pub inertia: R,
    /// Fixed translations and rotations.
    pub fixed: [[R::Mask; 3]; 2],
    pub damping: R,
}

/// Velocity, angular velocity of a sphere, total force and torque, local damping.
pub struct Kicked<R> {
    pub velocity: V3<R>,
    pub spin: V3<R>,
    pub force: V3<R>,
    pub torque: V3<R>,
    pub damping: V3<R>,
    pub damping_torque: V3<R>,
}

/// Sign(0) = 0: no damping at rest.
#[inline(always)]
fn sign<R: Real>(x: R) -> R {
    let one = R::splat(1.0);
    R::select(x.equals(R::zero()), R::zero(), R::select(x.gt(R::zero()), one, -one))
}

#[inline(always)]
fn damped<R: Real>(load: V3<R>, motion: V3<R>, damping: R) -> V3<R> {
    let of = -damping;
    V3::new(
        of * load.x.abs() * sign(motion.x),
        of * load.y.abs() * sign(motion.y),
        of * load.z.abs() * sign(motion.z),
    )
}

#[inline(always)]
fn advanced<R: Real>(old: V3<R>, load: V3<R>, share: R, fixed: &[R::Mask; 3]) -> V3<R> {
    let new = old + load * share;
    V3::new(
        R::select(fixed[0], old.x, new.x),
        R::select(fixed[1], old.y, new.y),
        R::select(fixed[2], old.z, new.z),
    )
}

#[inline(always)]
pub fn kick_single<R: Real>(s: &Single<R>, kick: R) -> Kicked<R> {
    let mut force = s.force.0 + s.force.1 + s.gravity * s.mass;
    let mut torque = s.torque.0 + s.torque.1;
    let damping = damped(force, s.velocity, s.damping);
    let damping_torque = damped(torque, s.spin, s.damping);
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
