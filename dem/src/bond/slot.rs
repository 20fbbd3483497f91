//! Slots for bond forces between blocks.

use crate::base::Vec3;
use crate::bodies::sums::Sums;
use crate::lanes::record::Record;
use crate::lanes::{Four, Portable};

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BondSlot {
    pub force: Record,
    pub torque_a: Record,
    pub torque_b: Record,
}

impl BondSlot {
    pub fn new(force: Vec3, torque_a: Vec3, torque_b: Vec3) -> BondSlot {
        let record = |v: Vec3| Record::of(&v, 0.0);
        BondSlot { force: record(force), torque_a: record(torque_a), torque_b: record(torque_b) }
    }
}

#[inline(always)]
fn add<R: Four>(to: &mut Record, v: R) {
    (R::load(to) + v).store(to);
}

#[inline(always)]
fn subtract<R: Four>(to: &mut Record, v: R) {
    (R::load(to) - v).store(to);
}

impl BondSlot {
    #[inline(always)]
    pub fn share(&self, sums: &mut Sums, first: bool) {
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
