//! A wall driven so that the grains press on it with a given force.
//!
//! The speed along the drive's direction d is v = g (F* − F)/Z, where F is the force on the grains along d, F* the
//! target, g the gain and Z = Σ (K Δt + 2C) over the contacts of the wall, with K their stiffness and C the bound
//! 2ζ√(mK) of their dashpots: with g = 1 an elastic contact would be set right within one step. Seen from the grains
//! this is a dashpot of impedance Z/g in series with the force F*: it takes energy out of every disturbance, so it is
//! stable for g < 1 (at g = 1 a force may ring from step to step), and at rest the force is exact. The plate has no mass and no weight. Without a contact it moves
//! towards the grains, from rest or from the speed at which the last contact let it go, by a tenth faster in every step up to its
//! greatest speed: a light target does not chatter from touch to touch at that speed.
//!
//! Source: the idea of a gain from the sum of contact stiffnesses is that of the servo walls of Cundall's programs
//! (P. A. Cundall and O. D. L. Strack, Géotechnique 29, 1979, and later manuals); the dashpot's share is added here.
//!
//! Theory manual: equation (3.11) of `docs/theory/motion.md`.

use crate::base::Vec3;

/// Growth of the speed in a step without a contact, and the least speed there over the greatest one.
const GROWTH: f64 = 1.1;
const LEAST: f64 = 1e-3;

/// Drive of a wall by a force.
#[derive(Clone, Debug, PartialEq)]
pub struct Servo {
    /// Direction in which the wall presses, any length but zero.
    pub direction: Vec3,
    /// Target force against time: (time [s], force [N]), times ascending; straight in between, constant outside.
    pub force: Vec<[f64; 2]>,
    /// Greatest speed [m/s].
    pub max_speed: f64,
    /// Gain in (0, 1]; 0.5 suits most scenes.
    pub gain: f64,
}

impl Servo {
    /// Target force at a time [N].
    pub fn target(&self, time: f64) -> f64 {
        let after = self.force.partition_point(|p| p[0] <= time);
        match (after.checked_sub(1).map(|k| self.force[k]), self.force.get(after)) {
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]),
            (Some(a), None) => a[1],
            (None, Some(b)) => b[1],
            (None, None) => 0.0,
        }
    }

    /// Speed for the next step, from the force along the direction [N], the contacts' impedance Z [N s/m] and the speed of the
    /// last step [m/s].
    pub(crate) fn speed(&self, time: f64, force: f64, impedance: f64, last: f64) -> f64 {
        let missing = self.target(time) - force;
        let speed = if impedance > 0.0 {
            self.gain * missing / impedance
        } else {
            missing.signum() * (GROWTH * last.abs()).max(LEAST * self.max_speed)
        };
        speed.clamp(-self.max_speed, self.max_speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn target_follows_its_table() {
        let servo =
            Servo { direction: Vec3::z(), force: vec![[1.0, 10.0], [3.0, 20.0]], max_speed: 1.0, gain: 0.5 };
        for (t, f) in [(0.0, 10.0), (1.0, 10.0), (1.5, 12.5), (3.0, 20.0), (9.0, 20.0)] {
            assert!((servo.target(t) - f).abs() < 1e-14, "{t}");
        }
        assert_eq!(servo.speed(0.0, 20.0, 100.0, 0.3), -0.05);
        assert_eq!(servo.speed(0.0, 1e9, 100.0, 0.3), -1.0);
    }

    /// From rest, or after a contact has let it go, the plate gains speed step by step.
    #[test]
    fn approach_begins_slowly() {
        let servo = Servo { direction: Vec3::z(), force: vec![[0.0, 10.0]], max_speed: 1.0, gain: 0.5 };
        assert_eq!(servo.speed(0.0, 0.0, 0.0, 0.0), 1e-3);
        assert!((servo.speed(0.0, 0.0, 0.0, -0.05) - 0.055).abs() < 1e-15);
        assert_eq!(servo.speed(0.0, 0.0, 0.0, 0.95), 1.0);
        let last = (0..73).fold(0.0, |v, _| servo.speed(0.0, 0.0, 0.0, v));
        assert!(last < 1.0 && servo.speed(0.0, 0.0, 0.0, last) > last, "{last}");
    }
}
