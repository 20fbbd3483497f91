//! Servo-controlled wall with a target force on the grains.
//!
//! To the grains a dashpot Z/g in series with a mass of 4 Z Δt/g²: passive, so the plate is stable for g ≤ 1
//! and critically damped on its own contact springs. The integral part follows ramps of the target without
//! error.
//!
//! Source: gain from the sum of contact stiffnesses, P. A. Cundall and O. D. L. Strack, Géotechnique 29,
//! 1979; dashpot term and integral part added.
//!
//! Theory manual: eq. (3.11), `docs/theory/motion.md`.

use crate::base::Vec3;

/// Growth per step without contact; smallest over greatest speed.
const GROWTH: f64 = 1.1;
const LEAST: f64 = 1e-3;

/// Integral over squared proportional gain: critical damping.
const INTEGRAL: f64 = 0.25;

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
    /// Displacement control: from a time [s] on, a constant speed along the direction [m/s].
    pub driven: Option<[f64; 2]>,
}

impl Servo {
    /// Returns the target force [N].
    pub fn target(&self, time: f64) -> f64 {
        interpolated(&self.force, time)
    }

    /// Speed [m/s] under displacement control.
    pub(crate) fn driven_speed(&self, time: f64) -> Option<f64> {
        self.driven.filter(|[from, _]| time >= *from).map(|[_, speed]| speed)
    }

    /// Velocity [m/s] for the next step; `missing` = target − force along the direction [N], impedance Z [N
    /// s/m].
    pub(crate) fn speed(&self, missing: f64, impedance: f64, last: f64, integral: &mut f64) -> f64 {
        let speed = if impedance > 0.0 {
            let per_impedance = missing / impedance;
            let greatest = self.max_speed;
            let sum = *integral + INTEGRAL * self.gain * self.gain * per_impedance;
            *integral = sum.clamp(-greatest, greatest);
            *integral + self.gain * per_impedance
        } else {
            *integral = 0.0;
            missing.signum() * (GROWTH * last.abs()).max(LEAST * self.max_speed)
        };
        speed.clamp(-self.max_speed, self.max_speed)
    }
}

/// Value of a table of times and values, constant beyond its ends; zero if it is empty.
pub(super) fn interpolated(table: &[[f64; 2]], time: f64) -> f64 {
    let after = table.partition_point(|p| p[0] <= time);
    match (after.checked_sub(1).map(|k| table[k]), table.get(after)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]),
        (Some(a), None) => a[1],
        (None, Some(b)) => b[1],
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo(gain: f64) -> Servo {
        Servo {
            direction: Vec3::z(),
            force: vec![[1.0, 10.0], [3.0, 20.0]],
            max_speed: 1.0,
            gain,
            driven: None,
        }
    }

    #[test]
    fn target_follows_its_table() {
        for (t, f) in [(0.0, 10.0), (1.0, 10.0), (1.5, 12.5), (3.0, 20.0), (9.0, 20.0)] {
            assert!((servo(0.5).target(t) - f).abs() < 1e-14, "{t}");
        }
    }

    #[test]
    fn speed_has_both_parts() {
        let mut integral = 0.0;
        assert!((servo(0.5).speed(10.0, 100.0, 0.3, &mut integral) - 0.05625).abs() < 1e-15);
        assert!((integral - 0.00625).abs() < 1e-15);
        assert_eq!(servo(0.5).speed(-1e9, 100.0, 0.3, &mut integral), -1.0);
        assert_eq!(integral, -1.0, "no wind-up beyond the greatest speed");
    }

    /// Gradual acceleration from rest or after loss of contact.
    #[test]
    fn approach_begins_slowly() {
        let speed = |last: f64| servo(0.5).speed(10.0, 0.0, last, &mut 0.7);
        assert_eq!(speed(0.0), 1e-3);
        assert!((speed(-0.05) - 0.055).abs() < 1e-15);
        assert_eq!(speed(0.95), 1.0);
        let last = (0..73).fold(0.0, |v, _| speed(v));
        assert!(last < 1.0 && speed(last) > last, "{last}");
    }

    /// Plate on a specimen of stiffness k, per unit impedance.
    fn follow(gain: f64, [stiffness, damping]: [f64; 2], target: impl Fn(f64) -> f64, steps: usize) -> f64 {
        let servo = Servo { max_speed: 1e9, ..servo(gain) };
        let (mut x, mut v, mut w, mut worst) = (0.0, 0.0, 0.0, 0.0_f64);
        for k in 0..steps {
            let force = stiffness * x + damping * v;
            let missing = target(k as f64) - force;
            if k > steps / 2 {
                worst = worst.max(missing.abs());
            }
            v = servo.speed(missing, 1.0, v, &mut w);
            x += v;
        }
        worst
    }

    #[test]
    fn servo_reaches_constant_force() {
        for gain in [0.25, 1.0] {
            for damping in [0.0, 0.3, 0.45] {
                for compliance in [1.0, 0.1, 1e-2] {
                    let stiffness = (1.0 - 2.0 * damping) * compliance;
                    let worst = follow(gain, [stiffness, damping], |_| 1.0, 400_000);
                    assert!(worst < 1e-6, "{gain} {damping} {compliance}: {worst:e}");
                }
            }
        }
    }

    /// Lag of a sine: (ω/ω₀)²; a dashpot alone lags by ωZ/(gk) = 0.63.
    #[test]
    fn ramp_and_sine_are_followed() {
        let soft = [1e-3, 0.3];
        let ramp = follow(1.0, soft, |t| 1e-4 * t, 400_000);
        assert!(ramp < 1e-6, "{ramp:e}");
        let omega = std::f64::consts::TAU / 1e4;
        let sine = follow(1.0, soft, |t| libm::sin(omega * t), 400_000);
        let expected = omega * omega / (INTEGRAL * soft[0]);
        assert!((sine / expected - 1.0).abs() < 0.1, "{sine:e} {expected:e}");
    }
}
