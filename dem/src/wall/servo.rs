//! Servo-controlled wall with a target force on the grains.
//!
//! Velocity along direction d: v = g (F* − F)/Z, F the force on the grains along d, F* the target, g the
//! gain, Z = Σ (K Δt + 2C) over the wall's contacts, K their stiffness, C = 2ζ√(mK) their dashpot bound. With
//! g = 1 an elastic contact is corrected in one step. The massless wall acts as a dashpot of impedance Z/g in
//! series with F*: dissipative, stable for g < 1 (at g = 1 the force may oscillate), exact at rest. Without
//! contact its velocity grows 10 % per step, which avoids chatter under a light target.
//!
//! Source: gain from the sum of contact stiffnesses, P. A. Cundall and O. D. L. Strack, Géotechnique 29,
//! 1979, and later manuals; dashpot term added.
//!
//! Theory manual: eq. (3.11), `docs/theory/motion.md`.

use crate::base::Vec3;

/// Growth per step without contact; smallest over greatest speed.
const GROWTH: f64 = 1.1;
const LEAST: f64 = 1e-3;

/// Servo control of a wall force.
#[derive(Clone, Debug, PartialEq)]
pub struct Servo {
    /// Pressing direction, nonzero.
    pub direction: Vec3,
    /// Target force: (time [s], force [N]), ascending; linear between, constant outside.
    pub force: Vec<[f64; 2]>,
    /// Greatest speed [m/s].
    pub max_speed: f64,
    /// Gain in (0, 1], usually 0.5.
    pub gain: f64,
}

impl Servo {
    /// Returns the target force [N].
    pub fn target(&self, time: f64) -> f64 {
        let after = self.force.partition_point(|p| p[0] <= time);
        match (after.checked_sub(1).map(|k| self.force[k]), self.force.get(after)) {
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]),
            (Some(a), None) => a[1],
            (None, Some(b)) => b[1],
            (None, None) => 0.0,
        }
    }

    /// Velocity [m/s] for the next step; force along the direction [N], impedance Z [N s/m].
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

    /// Gradual acceleration from rest or after loss of contact.
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
