//! What acts on the bodies of a block in a step, and what it books.

use crate::base::Vec3;
use crate::base::failure::Failure;
use crate::base::ledger::Ledger;
use crate::lanes::record::Record;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Sum of the contact forces on a body, and of the torques about its centre; the fourth numbers are zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Sums(pub [Record; 2]);

impl Sums {
    #[inline(always)]
    pub fn force(&self) -> &Record {
        &self.0[0]
    }

    #[inline(always)]
    pub fn torque(&self) -> &Record {
        &self.0[1]
    }

    #[inline(always)]
    pub fn both(&mut self) -> (&mut Record, &mut Record) {
        let [force, torque] = &mut self.0;
        (force, torque)
    }

    /// Adds a force and a torque about the centre.
    #[inline(always)]
    pub fn push(&mut self, force: &Vec3, torque: &Vec3) {
        let (f, t) = self.both();
        for d in 0..3 {
            f[d] += force[d];
            t[d] += torque[d];
        }
    }
}

/// Forces on the bodies of a block in the step at hand, and what the block books.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    /// In block order; empty between steps, unless they are to be kept.
    pub sums: Vec<Sums>,
    pub ledger: Ledger,
    /// Largest speed of a point of a body [m/s].
    pub fastest: f64,
    pub failure: Option<Failure>,
}

/// What grains and other walls felt from one wall in one step.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct WallSum {
    /// Force on them [N] and its moment about the wall's centre [N m].
    pub force: Vec3,
    pub moment: Vec3,
    /// Sum over the contacts of stiffness [N/m] and of √(stiffness × mass) [N s/m]; of driven walls only.
    pub stiffness: f64,
    pub damping: f64,
    /// Force of their dashpots on the grains; of driven walls only.
    pub dashpots: DashpotSum,
}

/// Forces of dashpots by the speed of the wall that their loss was computed with [N].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct DashpotSum {
    /// The speed of half a step ago.
    pub latest: Vec3,
    /// That speed, extrapolated from the step before.
    pub extrapolated: Vec3,
}

impl DashpotSum {
    /// Loss [W] that the dashpots have beyond the computed one where the wall's speed was `now` [m/s] half a step ago, `change`
    /// more than a step before, and is `next` half a step on: the loss over a step is that of the mean speed.
    pub fn lag(&self, now: &Vec3, change: &Vec3, next: &Vec3) -> f64 {
        let beyond = (next - now) * 0.5;
        self.latest.dot(&beyond) + self.extrapolated.dot(&(beyond - change * 0.5))
    }
}

impl AddAssign<&WallSum> for WallSum {
    fn add_assign(&mut self, other: &WallSum) {
        self.force += other.force;
        self.moment += other.moment;
        self.stiffness += other.stiffness;
        self.damping += other.damping;
        self.dashpots.latest += other.dashpots.latest;
        self.dashpots.extrapolated += other.dashpots.extrapolated;
    }
}
