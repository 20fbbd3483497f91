//! Springs and dashpots that hold a rigid body of a wall: a structure with one to three degrees of freedom, or a mooring.
//!
//! Along each axis of the world the body feels −k u − c v, u the way of its centre of mass since the start and v its velocity. The spring is taken at
//! the place of the step, the dashpot with the mean of the velocities before and after the kick:
//!
//! v₊ = [(1 − a) v₋ + (F − k u) h/m]/(1 + a),  a = c h/2m,
//!
//! h the time of the kick. That is the method of central differences: of second order, stable for ω h < 2 whatever the dashpot (e.g.
//! T. J. R. Hughes, The Finite Element Method, 1987, ch. 9), and what the dashpot takes, c v̄² h, is never below zero. The frequency and the decay of a
//! free vibration tend to ω √(1 − ζ²) and ζ ω with h².
//!
//! Limits: linear; axes of the world; turning is held by `fixed` or not at all.
//!
//! Theory manual: equation (3.12) of `docs/theory/motion.md`.

use super::input::Mount;
use crate::base::Vec3;
use crate::base::ledger::Ledger;

/// Kicks a velocity [m/s] by `kick` [s] under `force` [N] and a mount on a body of a mass [kg] whose centre is at `x`, `offset` from where it started
/// [m]. Books what the mount does.
pub(super) fn kick(
    mount: &Mount,
    mass: f64,
    velocity: &Vec3,
    force: &Vec3,
    (x, offset): (&Vec3, &Vec3),
    kick: f64,
    ledger: &mut Ledger,
) -> Vec3 {
    let spring = -mount.stiffness.component_mul(offset);
    let next = Vec3::from_fn(|d, _| {
        let a = 0.5 * mount.damping[d] * kick / mass;
        ((1.0 - a) * velocity[d] + (force[d] + spring[d]) * kick / mass) / (1.0 + a)
    });
    let mean = (velocity + next) * 0.5;
    let dashpot = -mount.damping.component_mul(&mean);
    ledger.mounts.add(x, &((spring + dashpot) * kick));
    ledger.dissipated_mounts -= dashpot.dot(&mean) * kick;
    next
}

/// Energy in the springs at an offset [J].
pub(super) fn stored(mount: &Mount, offset: &Vec3) -> f64 {
    0.5 * mount.stiffness.dot(&offset.component_mul(offset))
}

/// Square of the highest frequency that a mount gives a mass [1/s²].
pub(super) fn highest(mount: &Mount, mass: f64) -> f64 {
    mount.stiffness.max() / mass
}
