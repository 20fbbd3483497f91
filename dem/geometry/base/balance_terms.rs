//! Energy and momentum totals since the start.
//!
//! A step at time t moves bodies from t − dt/2 to t + dt/2: totals belong to half steps. Contact dissipation
//! uses the speed extrapolated to t (second order).

use crate::base::Vec3;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Linear and angular impulse about the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// ∫ F dt [N s].
    pub linear: Vec3,
    /// ∫ x × F dt about the origin [N m s].
    pub angular: Vec3,
}

impl Impulse {
    #[inline(always)]
    pub fn add(&mut self, point: &Vec3, impulse: &Vec3) {
        self.linear += impulse;
        self.angular += point.cross(impulse);
    }
}

impl AddAssign<&Impulse> for Impulse {
    fn add_assign(&mut self, other: &Impulse) {
        self.linear += other.linear;
        self.angular += other.angular;
    }
}

/// Energy and momentum totals: dissipation lost, work and impulse received by the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BalanceTerms {
    /// Dissipation by dashpots [J].
    pub dissipated_dashpot: f64,
    /// Dissipation by sliding [J].
    pub dissipated_friction: f64,
    /// Bond dashpot dissipation [J].
    #[serde(default)]
    pub dissipated_bonds: f64,
    /// Energy released by bond breakage [J].
    #[serde(default)]
    pub released_by_breaks: f64,
    /// Dissipation by local damping [J].
    pub dissipated_local_damping: f64,
    /// Mount dashpot dissipation [J].
    #[serde(default)]
    pub dissipated_mounts: f64,
    /// Work of applied forces [J].
    pub work_applied: f64,
    /// Work of body forces without gravity [J].
    pub work_body_forces: f64,
    /// Work of planes and walls with prescribed motion [J].
    pub work_walls: f64,
    /// Work of servo-controlled walls [J].
    pub work_servo: f64,
    /// Work of the external surface [J].
    pub work_surface: f64,
    /// Potential energy gain by periodic wrapping [J].
    #[serde(default)]
    pub work_periodic: f64,
    /// Work of constraint forces [J].
    pub work_constraints: f64,
    /// Energy of inserted minus removed bodies, without their contact springs [J].
    #[serde(default)]
    pub work_flow: f64,
    /// Gravity impulse.
    pub gravity: Impulse,
    /// Impulse of planes and walls without rigid bodies.
    pub walls: Impulse,
    /// Impulse of the external surface.
    pub surface: Impulse,
    /// Impulse of applied forces.
    pub applied: Impulse,
    /// Impulse of body forces without gravity.
    pub body_forces: Impulse,
    /// Impulse of constraint forces.
    pub constraints: Impulse,
    /// Angular impulse of periodic contacts (forces at two points) and wrapped bodies; linear part zero.
    #[serde(default)]
    pub periodic: Impulse,
    /// Impulse of local damping.
    pub local_damping: Impulse,
    /// Impulse of mounts.
    #[serde(default)]
    pub mounts: Impulse,
    /// Momentum change of repositioned bodies.
    #[serde(default)]
    pub jumps: Impulse,
    /// Momentum of inserted minus removed bodies.
    #[serde(default)]
    pub flow: Impulse,
}

impl BalanceTerms {
    /// Returns total dissipation [J].
    pub fn dissipated(&self) -> f64 {
        self.dissipated_dashpot
            + self.dissipated_friction
            + self.dissipated_local_damping
            + self.dissipated_bonds
            + self.released_by_breaks
            + self.dissipated_mounts
    }

    /// Returns external work without gravity [J].
    pub fn work(&self) -> f64 {
        self.work_applied
            + self.work_body_forces
            + self.work_walls
            + self.work_servo
            + self.work_surface
            + self.work_constraints
            + self.work_periodic
            + self.work_flow
    }

    /// Returns the total impulse, the change of momentum.
    pub fn impulse(&self) -> Impulse {
        let mut sum = self.gravity;
        let own = [self.walls, self.surface, self.applied, self.body_forces, self.constraints];
        for part in
            own.into_iter().chain([self.local_damping, self.periodic, self.jumps, self.flow, self.mounts])
        {
            sum += &part;
        }
        sum
    }
}

impl AddAssign<&BalanceTerms> for BalanceTerms {
    fn add_assign(&mut self, other: &BalanceTerms) {
        self.dissipated_dashpot += other.dissipated_dashpot;
        self.dissipated_friction += other.dissipated_friction;
        self.dissipated_local_damping += other.dissipated_local_damping;
        self.dissipated_mounts += other.dissipated_mounts;
        self.dissipated_bonds += other.dissipated_bonds;
        self.released_by_breaks += other.released_by_breaks;
        self.work_applied += other.work_applied;
        self.work_body_forces += other.work_body_forces;
        self.work_walls += other.work_walls;
        self.work_servo += other.work_servo;
        self.work_surface += other.work_surface;
        self.work_constraints += other.work_constraints;
        self.work_flow += other.work_flow;
        self.work_periodic += other.work_periodic;
        self.gravity += &other.gravity;
        self.walls += &other.walls;
        self.surface += &other.surface;
        self.applied += &other.applied;
        self.body_forces += &other.body_forces;
        self.constraints += &other.constraints;
        self.periodic += &other.periodic;
        self.local_damping += &other.local_damping;
        self.mounts += &other.mounts;
        self.jumps += &other.jumps;
        self.flow += &other.flow;
    }
}
