//! Soil drag on a scarring rock (`law/scarring.rs`).

use super::work::{ForceInput, ForceWork};
use crate::base::Vec3;
use crate::lanes::vec4::xyz;

/// Adds the drag, implicit in the speed so that it cannot reverse the motion: −R |u| u/(1 + R |u| dt/m).
pub(super) fn act(seen: &ForceInput<'_>, work: &mut ForceWork) {
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
