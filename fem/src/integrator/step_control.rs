//! Step length control: halving after failures, growth after fast convergence.

use crate::error::SolveError;
use serde::{Deserialize, Serialize};

/// Limits of the step length [s] or pseudo-time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    /// First step.
    pub initial: f64,
    /// Minimum; failure there ends the run.
    pub min: f64,
    /// Maximum.
    pub max: f64,
    /// Target iterations: with fewer, steps grow by up to 2, with more they shrink by the root of the ratio.
    pub target_iterations: u32,
}

impl StepControl {
    /// Steps of length `dt`, which may be halved ten times.
    pub fn fixed(dt: f64) -> StepControl {
        StepControl { initial: dt, min: dt / 1024.0, max: dt, target_iterations: 12 }
    }

    /// Checks that lengths are positive and ordered.
    ///
    /// # Errors
    /// [`SolveError::Option`].
    pub fn check(&self) -> Result<(), SolveError> {
        let usable = |x: f64| x > 0.0 && x.is_finite();
        for (what, value, fine) in [
            ("the smallest step", self.min, usable(self.min)),
            ("the largest step", self.max, usable(self.max) && self.max >= self.min),
            ("the first step", self.initial, self.initial >= self.min && self.initial <= self.max),
        ] {
            if !fine {
                let expected = "a finite number above 0, with smallest <= first <= largest";
                return Err(SolveError::Option { what, value, expected });
            }
        }
        if self.target_iterations == 0 {
            let (what, expected) = ("the iterations aimed at", "1 or more");
            return Err(SolveError::Option { what, value: 0.0, expected });
        }
        Ok(())
    }
}

const ROUNDING: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StepLength {
    control: StepControl,
    length: f64,
    wait: u32,
}

impl StepLength {
    pub fn new(control: StepControl) -> StepLength {
        StepLength { control, length: control.initial, wait: 0 }
    }

    /// Length and end time of the step from `time`, up to `end`. The last two steps share the remainder.
    pub fn next(&self, time: f64, end: f64) -> (f64, f64) {
        let left = end - time;
        let dt = self.unrounded(left);
        (dt, if dt >= left * (1.0 - ROUNDING) { end } else { time + dt })
    }

    fn unrounded(&self, left: f64) -> f64 {
        if left <= self.length * (1.0 - ROUNDING) {
            left
        } else if left <= self.length * (1.0 + ROUNDING) {
            self.length
        } else if left < 2.0 * self.length {
            0.5 * left
        } else {
            self.length
        }
    }

    /// Updates after convergence.
    pub fn accept(&mut self, dt: f64, iterations: u32) {
        if self.wait > 0 {
            self.wait -= 1;
            return;
        }
        let target = f64::from(self.control.target_iterations);
        let ratio = (target / f64::from(iterations.max(1))).sqrt().clamp(0.5, 2.0);
        // A shortened final step must not reduce the length.
        let base = if ratio >= 1.0 { self.length } else { dt };
        self.length = (base * ratio).clamp(self.control.min, self.control.max);
    }

    /// Halves after failure; returns whether a shorter step is allowed.
    pub fn halve(&mut self, dt: f64) -> bool {
        if dt <= self.control.min * (1.0 + 1e-9) {
            return false;
        }
        self.length = (0.5 * dt).max(self.control.min);
        self.wait = 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_exactly_and_halve() {
        let control = StepControl { initial: 0.4, min: 0.1, max: 0.8, target_iterations: 4 };
        let mut length = StepLength::new(control);
        assert_eq!(length.next(0.0, 1.0), (0.4, 0.4));
        assert_eq!((length.next(0.0, 0.4), length.next(0.0, 0.5).0), ((0.4, 0.4), 0.25));
        assert!(length.halve(0.4) && length.next(0.0, 1.0).0 == 0.2);
        assert!(length.halve(0.2) && length.next(0.0, 1.0).0 == 0.1 && !length.halve(0.1));
        length.accept(0.1, 1);
        assert_eq!(length.next(0.0, 1.0).0, 0.1);
        length.accept(0.1, 1);
        assert_eq!(length.next(0.0, 1.0).0, 0.2);
        length.accept(0.2, 16);
        assert_eq!(length.next(0.0, 1.0).0, 0.1);
        for _ in 0..9 {
            length.accept(0.1, 1);
        }
        assert_eq!(length.next(0.0, 10.0).0, 0.8);
        assert!(control.check().is_ok() && StepControl { min: 0.5, ..control }.check().is_err());
        assert!(StepControl { target_iterations: 0, ..control }.check().is_err());
    }

    #[test]
    fn rounding_makes_no_other_length() {
        let length = StepLength::new(StepControl::fixed(0.1));
        let mut time = 0.0;
        for k in 1..100 {
            let to = f64::from(k) * 0.1;
            assert_eq!(length.next(time, to), (0.1, to));
            time = to;
        }
    }
}
