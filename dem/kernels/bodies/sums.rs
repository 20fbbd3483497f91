//! Forces and totals of a block in one step.

use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::failure::Failure;
use crate::lanes::vec4::Vec4;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Force and torque about the centre; fourth numbers zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct ForceTorque(pub [Vec4; 2]);

impl ForceTorque {
    #[inline(always)]
    pub fn force(&self) -> &Vec4 {
        &self.0[0]
    }

    #[inline(always)]
    pub fn torque(&self) -> &Vec4 {
        &self.0[1]
    }

    #[inline(always)]
    pub fn both(&mut self) -> (&mut Vec4, &mut Vec4) {
        let [force, torque] = &mut self.0;
        (force, torque)
    }

    #[inline(always)]
    pub fn push(&mut self, force: &Vec3, torque: &Vec3) {
        let (f, t) = self.both();
        for d in 0..3 {
            f[d] += force[d];
            t[d] += torque[d];
        }
    }
}

#[derive(Clone, Debug, Default)]
pub struct BlockTotals {
    /// Empty between steps unless retained.
    pub sums: Vec<ForceTorque>,
    pub balance: BalanceTerms,
    pub fastest: f64,
    pub failure: Option<Failure>,
}

/// Wall contact sums of one step.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct WallSum {
    /// Force on grains and other walls [N], and moment about the wall's centre [N m].
    pub force: Vec3,
    pub moment: Vec3,
    /// Σ stiffness [N/m], Σ √(stiffness × mass) [N s/m]; servo-controlled walls only.
    pub stiffness: f64,
    pub damping: f64,
    /// On the grains; servo-controlled walls only.
    pub dashpots: DashpotSum,
}

/// Dashpot force by wall velocity of its dissipation [N].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct DashpotSum {
    /// Last half step.
    pub latest: Vec3,
    /// Extrapolated from the previous step.
    pub extrapolated: Vec3,
}

impl DashpotSum {
    /// Dashpot dissipation beyond the computed one [W], based on the mean wall velocity: `now` [m/s] at the
    /// last half step, `change` since the previous one, `next` at the coming one.
    #[inline]
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
