//! Adds forces from other blocks' slots to a block's bodies.

use super::group_history::FAR;
use crate::bodies::sums::ForceTorque;
use crate::lanes::{self, Kernel, Real, Simd4, SimdPack};
use crate::pairs::cross::{Shares, Slots};

/// Adds slots in fixed order. `WIDE`: some contain both torques.
pub struct Gathering<'a, const WIDE: bool> {
    pub shares: &'a Shares,
    pub sums: &'a mut [ForceTorque],
    pub slots: Slots<'a>,
}

impl<const WIDE: bool> Kernel for Gathering<'_, WIDE> {
    type Output = ();

    #[inline(always)]
    fn run<R: SimdPack>(self) {
        let Gathering { shares, sums, slots } = self;
        let three = R::Quad::load(&[1.0, 1.0, 1.0, 0.0]);
        for (k, entry) in shares.list.iter().enumerate() {
            if let Some(next) = shares.list.get(k + FAR / 2) {
                let width = if WIDE { 3 } else { 2 };
                lanes::ahead(&slots.of(next.block as usize).slots, next.record(), width);
            }
            let first = entry.first();
            let slot = &slots.of(entry.block as usize).slots[entry.record()..];
            let sums = &mut sums[entry.place as usize].0;
            let sign = three * R::Quad::splat(if first { 1.0 } else { -1.0 });
            let force = R::Quad::load(&slot[0]) * sign;
            let torque = if WIDE && entry.wide() {
                R::Quad::load(&slot[if first { 1 } else { 2 }])
            } else {
                let lever = slot[usize::from(!first)][3];
                R::Quad::load(&slot[1]) * (three * R::Quad::splat(lever))
            };
            (R::Quad::load(&sums[0]) + force).store(&mut sums[0]);
            (R::Quad::load(&sums[1]) + torque).store(&mut sums[1]);
        }
    }
}
