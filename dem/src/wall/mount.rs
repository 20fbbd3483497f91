//! Spring–dashpot support of rigid-body walls.
//!
//! The central difference method is second order and stable for ω h < 2 with any dashpot (e.g. T. J. R.
//! Hughes, The Finite Element Method, 1987, ch. 9).
//!
//! Theory manual: eq. (3.12), `docs/theory/motion.md`.

use super::input::Mount;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;

/// Kicks a velocity [m/s] by `kick` [s] under `force` [N] and mount, centre at `x`, displaced by `offset`
/// [m].
pub(super) fn kick(
    mount: &Mount,
    mass: f64,
    velocity: &Vec3,
    force: &Vec3,
    (x, offset): (&Vec3, &Vec3),
    kick: f64,
    balance: &mut BalanceTerms,
) -> Vec3 {
    let spring = -mount.stiffness.component_mul(offset);
    let next = Vec3::from_fn(|d, _| {
        let a = 0.5 * mount.damping[d] * kick / mass;
        ((1.0 - a) * velocity[d] + (force[d] + spring[d]) * kick / mass) / (1.0 + a)
    });
    let mean = (velocity + next) * 0.5;
    let dashpot = -mount.damping.component_mul(&mean);
    balance.mounts.add(x, &((spring + dashpot) * kick));
    balance.dissipated_mounts -= dashpot.dot(&mean) * kick;
    next
}

/// Spring energy [J].
pub(super) fn stored(mount: &Mount, offset: &Vec3) -> f64 {
    0.5 * mount.stiffness.dot(&offset.component_mul(offset))
}

/// Square of the highest frequency [1/s²].
pub(super) fn highest(mount: &Mount, mass: f64) -> f64 {
    mount.stiffness.max() / mass
}
