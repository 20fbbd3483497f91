//! Drag of the soil that a rock scars (`law/scarring.rs`): on its centre, against its velocity, as the square of the speed.

use super::work::{ForceWork, Seen};
use crate::base::Vec3;
use crate::lanes::record::xyz;

/// Adds the drag on the bodies of a block. It is that of the speed after the step, so that it turns no body back however
/// strong it is: −R |u| u/(1 + R |u| dt/m).
pub(super) fn act(seen: &Seen<'_>, work: &mut ForceWork) {
    for (k, &body) in seen.block.bodies.iter().enumerate() {
        let resistance = seen.scars[body as usize].resistance;
        if resistance > 0.0 {
            let u = xyz(&seen.block.velocity[k]);
            let rate = resistance * u.norm();
            let over = 1.0 + rate * seen.kick * seen.block.velocity[k][3];
            work.acting[k].push(&(u * (-rate / over)), &Vec3::zeros());
        }
    }
}
