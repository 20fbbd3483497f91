//! Slots for bond forces between blocks.

use crate::base::Vec3;
use crate::bodies::sums::ForceTorque;
use crate::lanes::vec4::Vec4;
use crate::lanes::{Portable, Simd4};

#[derive(Clone, Copy, Debug, Default)]
pub struct BondSlot {
    pub force: Vec4,
    pub torque_a: Vec4,
    pub torque_b: Vec4,
}

impl BondSlot {
    pub fn new(force: Vec3, torque_a: Vec3, torque_b: Vec3) -> BondSlot {
        let record = |v: Vec3| Vec4::of(&v, 0.0);
        BondSlot { force: record(force), torque_a: record(torque_a), torque_b: record(torque_b) }
    }
}

#[inline(always)]
fn add<R: Simd4>(to: &mut Vec4, v: R) {
    (R::load(to) + v).store(to);
}

#[inline(always)]
fn subtract<R: Simd4>(to: &mut Vec4, v: R) {
    (R::load(to) - v).store(to);
}

impl BondSlot {
    #[inline(always)]
    pub fn share(&self, sums: &mut ForceTorque, first: bool) {
        let (force, torque) = sums.both();
        if first {
            add(force, Portable::load(&self.force));
            add(torque, Portable::load(&self.torque_a));
        } else {
            subtract(force, Portable::load(&self.force));
            add(torque, Portable::load(&self.torque_b));
        }
    }
}
