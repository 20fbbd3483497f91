//! Comparison of an applied load with its target, once reached.
//!
//! With target a and applied load b, b − b̄ is fitted by α (a − ā) + β ȧ (least squares). With ω² =
//! var(ȧ)/var(a) the transfer factor is H = α + iβω.

use serde::{Deserialize, Serialize};

/// Averaging time over step.
const AVERAGE: f64 = 200.0;

/// Reached: within this share of the target.
const REACHED: f64 = 0.05;

/// Targets vary if their standard deviation exceeds this share of their mean.
const VARIES: f64 = 1e-3;

/// Running sums of target and applied load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceTracking {
    started: bool,
    reached: bool,
    /// First and last target; origin of the sums.
    origin: f64,
    last: f64,
    /// Averages of target and applied load.
    average: [f64; 2],
    /// Time, ∫a, ∫b, ∫a², ∫ab, ∫ȧ, ∫ȧ², ∫aȧ, ∫ȧb, of values less the origin.
    sums: [f64; 9],
    /// ∫ (average b − average a)².
    deviation: f64,
    /// Smallest and largest averages: target, applied load.
    range: [[f64; 2]; 2],
}

/// Smallest, mean and largest load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LoadRange {
    /// Smallest.
    pub min: f64,
    /// Mean.
    pub mean: f64,
    /// Largest.
    pub max: f64,
}

/// Applied load compared with its target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AppliedLoad {
    /// Target.
    pub target: LoadRange,
    /// Applied load.
    pub applied: LoadRange,
    /// Amplitude over target amplitude; varying targets only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude_ratio: Option<f64>,
    /// Phase, negative if late [degrees]; varying targets only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<f64>,
    /// Error over the target's range, or over a constant target: the larger of the error of the mean and |H − 1|,
    /// or the RMS error of a constant load. 1 if the target was never reached.
    pub error: f64,
}

impl ForceTracking {
    /// Adds a step of length `dt` [s].
    #[inline]
    pub fn add(&mut self, dt: f64, target: f64, applied: f64) {
        if !self.started {
            (self.started, self.origin, self.last) = (true, target, target);
            self.average = [target, applied];
            self.range = [[target; 2], [applied; 2]];
        }
        let rate = (target - self.last) / dt;
        self.last = target;
        for (average, value) in self.average.iter_mut().zip([target, applied]) {
            *average += (value - *average) / AVERAGE;
        }
        if !self.reached {
            self.reached = (self.average[1] - self.average[0]).abs() <= REACHED * self.average[0].abs();
            self.range = self.average.map(|a| [a; 2]);
            return;
        }
        let (a, b) = (target - self.origin, applied - self.origin);
        for (sum, term) in
            self.sums.iter_mut().zip([1.0, a, b, a * a, a * b, rate, rate * rate, a * rate, rate * b])
        {
            *sum += term * dt;
        }
        self.deviation += (self.average[1] - self.average[0]).powi(2) * dt;
        for (range, average) in self.range.iter_mut().zip(self.average) {
            *range = [range[0].min(average), range[1].max(average)];
        }
    }

    /// Evaluates the sums; none before the first step.
    pub fn result(&self) -> Option<AppliedLoad> {
        if !self.started {
            return None;
        }
        let mean = |k: usize| {
            let time = self.sums[0];
            if time > 0.0 { self.origin + self.sums[k] / time } else { self.average[k - 1] }
        };
        let [target, applied] = [0, 1].map(|k| {
            let [min, max] = self.range[k];
            LoadRange { min, mean: mean(k + 1), max }
        });
        let mut load = AppliedLoad { target, applied, amplitude_ratio: None, phase: None, error: 1.0 };
        if !self.reached || self.sums[0] == 0.0 {
            return Some(load);
        }
        let bias = (applied.mean - target.mean).abs();
        match self.transfer(target.mean) {
            Some((in_phase, quadrature)) => {
                load.amplitude_ratio = Some(libm::hypot(in_phase, quadrature));
                load.phase = Some(libm::atan2(quadrature, in_phase).to_degrees());
                load.error = (bias / (target.max - target.min)).max(libm::hypot(in_phase - 1.0, quadrature));
            }
            None => {
                let rms = (self.deviation / self.sums[0]).sqrt();
                load.error = bias.max(rms) / target.mean.abs().max(f64::MIN_POSITIVE);
            }
        }
        Some(load)
    }

    /// α and βω; none for a constant target.
    fn transfer(&self, mean: f64) -> Option<(f64, f64)> {
        let [time, a, b, aa, ab, r, rr, ar, rb] = self.sums;
        let (saa, sab) = (aa - a * a / time, ab - a * b / time);
        let (srr, sar, srb) = (rr - r * r / time, ar - a * r / time, rb - r * b / time);
        let determinant = saa * srr - sar * sar;
        if saa / time <= (VARIES * mean).powi(2) || determinant <= 1e-9 * saa * srr {
            return None;
        }
        let in_phase = (sab * srr - srb * sar) / determinant;
        let quadrature = (srb * saa - sab * sar) / determinant * (srr / saa).sqrt();
        Some((in_phase, quadrature))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_3, TAU};

    fn follow(target: impl Fn(f64) -> f64, applied: impl Fn(f64) -> f64, end: f64) -> AppliedLoad {
        let mut tracking = ForceTracking::default();
        let dt = 1e-5;
        for k in 0..(end / dt) as u64 {
            let t = k as f64 * dt;
            tracking.add(dt, target(t), applied(t));
        }
        tracking.result().unwrap()
    }

    fn haversine(t: f64) -> f64 {
        100.0 + 50.0 * (1.0 - libm::cos(TAU * 5.0 * t))
    }

    #[test]
    fn exact_load_has_no_error() {
        let load = follow(haversine, haversine, 1.0);
        assert!(load.error < 1e-3, "{load:?}");
        assert!((load.amplitude_ratio.unwrap() - 1.0).abs() < 1e-3 && load.phase.unwrap().abs() < 0.1);
        assert!((load.target.mean - 150.0).abs() < 0.1 && (load.target.max - 200.0).abs() < 0.5, "{load:?}");
    }

    #[test]
    fn lag_and_loss_are_measured() {
        let late = |t: f64| 160.0 - 40.0 * libm::cos(TAU * 5.0 * t - FRAC_PI_3);
        let load = follow(haversine, late, 2.0);
        assert!((load.amplitude_ratio.unwrap() - 0.8).abs() < 0.01, "{load:?}");
        assert!((load.phase.unwrap() + 60.0).abs() < 0.5, "{load:?}");
        assert!((load.applied.mean - load.target.mean - 10.0).abs() < 0.5, "{load:?}");
        // |0.8 exp(−iπ/3) − 1|.
        let expected = ((0.4_f64 - 1.0).powi(2) + (0.8 * FRAC_PI_3.sin()).powi(2)).sqrt();
        assert!((load.error - expected).abs() < 0.02, "{load:?} {expected}");
    }

    #[test]
    fn constant_target_error_is_relative_deviation() {
        let load = follow(|_| 10.0, |t| if t < 0.1 { 10.0 } else { 20.0 }, 1.0);
        assert!(load.amplitude_ratio.is_none() && (load.error - 0.95).abs() < 0.1, "{load:?}");
        assert!(follow(|_| 10.0, |_| 10.1, 1.0).error < 0.011);
    }

    #[test]
    fn target_never_reached_is_an_error() {
        let load = follow(|_| 10.0, |t| 3.0 * t, 1.0);
        assert_eq!(load.error, 1.0);
        assert!((load.applied.max - 3.0).abs() < 0.1, "{load:?}");
    }

    #[test]
    fn approach_is_left_out() {
        let load = follow(|_| 10.0, |t| (100.0 * t).min(10.0), 1.0);
        assert!(load.error < 0.01, "{load:?}");
        assert!((load.applied.mean - 10.0).abs() < 0.05, "{load:?}");
    }
}
