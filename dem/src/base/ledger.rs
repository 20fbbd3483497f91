//! Where energy and momentum went: sums over all steps since the start.
//!
//! A step at time t carries the bodies from t − dt/2 to t + dt/2, so the sums belong to half steps, as the
//! velocities do. Work is force × mean of the velocities before and after, which is exactly the change of kinetic
//! energy in a leapfrog; energy that contacts dissipate uses the speed extrapolated to t, right to second order.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Impulse and angular impulse about the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// ∫ F dt [N s].
    pub linear: Vec3,
    /// ∫ x × F dt about the origin [N m s].
    pub angular: Vec3,
}

impl Impulse {
    /// Adds the impulse of a force at a point.
    #[inline(always)]
    pub(crate) fn add(&mut self, point: &Vec3, impulse: &Vec3) {
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

/// The ledger. Signs: dissipated energies are positive when lost; works and impulses are what the bodies received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Energy lost in dashpots [J].
    pub dissipated_dashpot: f64,
    /// Energy lost in sliding [J].
    pub dissipated_friction: f64,
    /// Energy lost in the dashpots of bonds [J].
    #[serde(default)]
    pub dissipated_bonds: f64,
    /// Energy set free by breaking bonds [J].
    #[serde(default)]
    pub released_by_breaks: f64,
    /// Energy taken by local damping [J].
    pub dissipated_local_damping: f64,
    /// Energy lost in the dashpots of mounts of rigid bodies [J].
    #[serde(default)]
    pub dissipated_mounts: f64,
    /// Work of applied forces [J].
    pub work_applied: f64,
    /// Work of body forces, gravity excepted [J].
    pub work_body_forces: f64,
    /// Work of planes and walls with prescribed motion on the bodies [J].
    pub work_walls: f64,
    /// Work of walls that are driven by a force on the bodies [J].
    pub work_servo: f64,
    /// Work of the external surface's motion on the bodies [J].
    pub work_surface: f64,
    /// Potential energy that bodies gained when they were put back into a periodic box [J].
    #[serde(default)]
    pub work_periodic: f64,
    /// Work of what keeps fixed motions at their speed [J].
    pub work_constraints: f64,
    /// Energy that bodies brought along when they were put in, less what went with those taken out [J]: kinetic, of gravity,
    /// and of the contact springs that ceased to be.
    #[serde(default)]
    pub work_flow: f64,
    /// Impulse of gravity.
    pub gravity: Impulse,
    /// Impulse of planes and walls, rigid bodies excepted: they count among the bodies.
    pub walls: Impulse,
    /// Impulse of the external surface.
    pub surface: Impulse,
    /// Impulse of applied forces.
    pub applied: Impulse,
    /// Impulse of body forces, gravity excepted.
    pub body_forces: Impulse,
    /// Impulse of what keeps fixed motions at their speed.
    pub constraints: Impulse,
    /// Angular impulse of periodic borders: of contacts across them, whose two forces do not act at one point, and of
    /// bodies put back into the box. Its linear part is zero.
    #[serde(default)]
    pub periodic: Impulse,
    /// Impulse of local damping.
    pub local_damping: Impulse,
    /// Impulse of the mounts of rigid bodies.
    #[serde(default)]
    pub mounts: Impulse,
    /// Change of momentum by bodies that were set elsewhere.
    #[serde(default)]
    pub jumps: Impulse,
    /// Momentum that bodies brought along when they were put in, less that of those taken out.
    #[serde(default)]
    pub flow: Impulse,
}

impl Ledger {
    /// All energy lost [J].
    pub fn dissipated(&self) -> f64 {
        self.dissipated_dashpot
            + self.dissipated_friction
            + self.dissipated_local_damping
            + self.dissipated_bonds
            + self.released_by_breaks
            + self.dissipated_mounts
    }

    /// All work received from outside, gravity excepted (it has a potential) [J].
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

    /// Sum of all impulses: the change of momentum since the start.
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

impl AddAssign<&Ledger> for Ledger {
    fn add_assign(&mut self, other: &Ledger) {
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
