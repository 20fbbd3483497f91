//! How a load varies in time.

use super::units::{Frequency, Quantity, Time};
use serde::Deserialize;
use std::f64::consts::TAU;

/// Shape of a load in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HistoryKind {
    /// 1 at all times.
    Constant,
    /// From 0 to 1 over `duration`, then 1.
    Ramp,
    /// sin 2πft.
    Sine,
    /// (1 − cos 2πft)/2 = sin² πft: from 0 to 1 and back in each period.
    Haversine,
}

/// A dimensionless factor as a function of time.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// Shape.
    pub kind: HistoryKind,
    /// Frequency of `sine` and `haversine` [Hz].
    pub frequency: Option<Quantity<Frequency>>,
    /// Number of periods after which the factor is 0; default: no end.
    pub cycles: Option<f64>,
    /// Rise time of `ramp` [s].
    pub duration: Option<Quantity<Time>>,
    /// Time before which the factor is 0 [s]; default 0.
    pub start: Option<Quantity<Time>>,
}

/// A checked history.
#[derive(Clone, Copy, Debug)]
pub struct TimeFunction {
    kind: HistoryKind,
    frequency: f64,
    start: f64,
    end: f64,
}

impl TimeFunction {
    /// The factor 1 at all times.
    pub const CONSTANT: TimeFunction =
        TimeFunction { kind: HistoryKind::Constant, frequency: 0.0, start: 0.0, end: f64::INFINITY };

    /// Checks what a scene wrote; the error names the key, what was found and what was expected.
    ///
    /// # Errors
    /// A key that the kind needs is missing, one it does not use is there, or a value is out of range.
    pub fn new(history: &History) -> Result<TimeFunction, (&'static str, String, &'static str)> {
        let periodic = matches!(history.kind, HistoryKind::Sine | HistoryKind::Haversine);
        let start = history.start.map_or(0.0, |s| s.si);
        let mut function = TimeFunction { kind: history.kind, frequency: 0.0, start, end: f64::INFINITY };
        match history.frequency {
            Some(f) if !periodic => {
                return Err(("frequency", format!("{}", f.si), "no such key for this kind of history"));
            }
            Some(f) if f.si <= 0.0 => return Err(("frequency", format!("{}", f.si), "a positive frequency")),
            None if periodic => {
                return Err(("frequency", "nothing".into(), "a frequency for this kind of history"));
            }
            Some(f) => function.frequency = f.si,
            None => {}
        }
        match history.cycles {
            Some(c) if !periodic => {
                return Err(("cycles", format!("{c}"), "no such key for this kind of history"));
            }
            Some(c) if !(c > 0.0 && c.is_finite()) => {
                return Err(("cycles", format!("{c}"), "a positive number of cycles"));
            }
            Some(c) => function.end = start + c / function.frequency,
            None => {}
        }
        match (history.duration, history.kind) {
            (Some(d), HistoryKind::Ramp) if d.si > 0.0 => function.frequency = 1.0 / d.si,
            (Some(d), HistoryKind::Ramp) => return Err(("duration", format!("{}", d.si), "a positive time")),
            (None, HistoryKind::Ramp) => {
                return Err(("duration", "nothing".into(), "the rise time of the ramp"));
            }
            (Some(d), _) => {
                return Err(("duration", format!("{}", d.si), "no such key for this kind of history"));
            }
            (None, _) => {}
        }
        Ok(function)
    }

    /// Factor at time `t` [s].
    pub fn factor(&self, t: f64) -> f64 {
        if t < self.start || t > self.end {
            return 0.0;
        }
        let phase = (t - self.start) * self.frequency;
        match self.kind {
            HistoryKind::Constant => 1.0,
            HistoryKind::Ramp => phase.min(1.0),
            HistoryKind::Sine => (TAU * phase).sin(),
            HistoryKind::Haversine => 0.5 * (1.0 - (TAU * phase).cos()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(kind: HistoryKind, frequency: f64, cycles: f64) -> TimeFunction {
        TimeFunction::new(&History {
            kind,
            frequency: Some(Quantity::new(frequency)),
            cycles: Some(cycles),
            duration: None,
            start: None,
        })
        .unwrap()
    }

    #[test]
    fn haversine_is_the_square_of_half_the_phase_and_ends_after_its_cycles() {
        let f = history(HistoryKind::Haversine, 50.0, 1.0);
        for t in [0.0, 0.003, 0.01, 0.0173] {
            let expected = (std::f64::consts::PI * t / 0.02).sin().powi(2);
            assert!((f.factor(t) - expected).abs() < 1e-15, "{t}");
        }
        assert_eq!(f.factor(0.01), 1.0);
        assert_eq!(f.factor(0.0201), 0.0);
    }

    #[test]
    fn sine_has_zero_mean_over_its_cycles() {
        let f = history(HistoryKind::Sine, 4.0, 2.0);
        let sum: f64 = (0..1000).map(|i| f.factor((i as f64 + 0.5) * 0.5e-3)).sum();
        assert!(sum.abs() < 1e-9 && f.factor(0.0625) > 0.999);
    }
}
