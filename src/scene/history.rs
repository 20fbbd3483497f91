//! Time histories of loads.

use super::units::{Frequency, Quantity, Time};
use super::{Problem, setting};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Shape of a load in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HistoryKind {
    /// Constant.
    Constant,
    /// From 0 to 1 over `duration`.
    Ramp,
    /// As sin 2πft.
    Sine,
    /// As sin² πft.
    Haversine,
    /// Linear between points, constant beyond.
    Table,
}

/// A dimensionless factor as a function of time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// Factor on the load.
    pub kind: HistoryKind,
    /// Frequency [Hz]; > 0; with `"sine"`, `"haversine"`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Number of periods, then 0; default unlimited; with `"sine"`, `"haversine"`.
    pub cycles: Option<f64>,
    /// Rise time [s]; > 0; with `"ramp"`.
    pub duration: Option<Quantity<Time>>,
    /// Points `[[time, factor], …]`, ascending [s]; or `file`; with `"table"`.
    pub points: Option<Vec<(Quantity<Time>, f64)>>,
    /// CSV file `time, factor`, header optional (`time [ms]`) [s]; or `points`; with `"table"`.
    #[schemars(extend("format" = "path"))]
    pub file: Option<PathBuf>,
    /// Time before which it is 0 [s]; default 0.
    pub start: Option<Quantity<Time>>,
}

/// Checked time history.
#[derive(Clone, Debug)]
pub struct TimeFunction {
    kind: HistoryKind,
    frequency: f64,
    start: f64,
    end: f64,
    /// (time [s], factor), times ascending.
    points: Vec<(f64, f64)>,
}

/// Least number of samples per period.
const SAMPLES: f64 = 8.0;
/// Largest relative deviation of a table point from the sampled line.
const STRAY: f64 = 0.1;

/// Undersampled feature of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missed {
    /// Undersampled period.
    Period {
        /// Samples in a period.
        samples: f64,
    },
    /// Table point off the sampled line.
    Point {
        /// Time [s].
        time: f64,
        /// Factor [1].
        factor: f64,
    },
}

impl std::fmt::Display for Missed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Missed::Period { samples } => {
                write!(f, "{samples:.2} points per period (8 or more needed)")
            }
            Missed::Point { time, factor } => write!(f, "points that miss the factor {factor} at {time} s"),
        }
    }
}

impl TimeFunction {
    /// Constant factor 1.
    pub const CONSTANT: TimeFunction = TimeFunction {
        kind: HistoryKind::Constant,
        frequency: 0.0,
        start: 0.0,
        end: f64::INFINITY,
        points: Vec::new(),
    };

    /// Checks the scene table; `rows` are the content of `history.file`.
    ///
    /// # Errors
    /// Missing or unused keys, values out of range.
    pub fn new(
        history: &History,
        rows: Option<Vec<(f64, f64)>>,
    ) -> Result<TimeFunction, (&'static str, Problem)> {
        let periodic = matches!(history.kind, HistoryKind::Sine | HistoryKind::Haversine);
        let start = history.start.map_or(0.0, |s| s.si);
        let mut function = TimeFunction { kind: history.kind, start, ..TimeFunction::CONSTANT };
        let table = history.kind == HistoryKind::Table;
        let value = |found: String, expected: &str| Problem::value(found, expected);
        let without = |kinds: &[&str]| Problem::no_effect(setting("kind", kinds));
        for (key, present) in [("points", history.points.is_some()), ("file", history.file.is_some())] {
            if present && !table {
                return Err((key, without(&["table"])));
            }
        }
        if table {
            let points = history.points.as_ref().map(|p| p.iter().map(|(t, f)| (t.si, *f)).collect());
            function.points = match (points, rows) {
                (Some(points), None) => points,
                (None, Some(rows)) => rows,
                (Some(_), Some(_)) => return Err(("points", Problem::conflict("`file`"))),
                (None, None) => return Err(("points", Problem::missing("`points` or `file`"))),
            };
            let points = &function.points;
            if points.is_empty() || points.windows(2).any(|w| w[1].0 <= w[0].0) {
                let found = format!("{} points", points.len());
                return Err(("points", value(found, "points with ascending times")));
            }
            if points.iter().any(|p| !p.1.is_finite()) {
                return Err(("points", value("a factor that is not finite".into(), "finite factors")));
            }
        }
        match history.frequency {
            Some(_) if !periodic => return Err(("frequency", without(&["sine", "haversine"]))),
            Some(f) if f.si <= 0.0 => {
                return Err(("frequency", value(f.si.to_string(), "a positive frequency")));
            }
            None if periodic => {
                return Err(("frequency", Problem::missing("a frequency for this kind of history")));
            }
            Some(f) => function.frequency = f.si,
            None => {}
        }
        match history.cycles {
            Some(_) if !periodic => return Err(("cycles", without(&["sine", "haversine"]))),
            Some(c) if !(c > 0.0 && c.is_finite()) => {
                return Err(("cycles", value(c.to_string(), "a positive number of cycles")));
            }
            Some(c) => function.end = start + c / function.frequency,
            None => {}
        }
        match (history.duration, history.kind) {
            (Some(d), HistoryKind::Ramp) if d.si > 0.0 => function.frequency = 1.0 / d.si,
            (Some(d), HistoryKind::Ramp) => {
                return Err(("duration", value(d.si.to_string(), "a positive time")));
            }
            (None, HistoryKind::Ramp) => {
                return Err(("duration", Problem::missing("the rise time of the ramp")));
            }
            (Some(_), _) => return Err(("duration", without(&["ramp"]))),
            (None, _) => {}
        }
        Ok(function)
    }

    /// Returns the frequency [Hz] of a sine or haversine with at least `cycles` until `end` [s].
    pub fn frequency(&self, cycles: f64, end: f64) -> Option<f64> {
        let periodic = matches!(self.kind, HistoryKind::Sine | HistoryKind::Haversine);
        let count = (self.end.min(end) - self.start) * self.frequency;
        (periodic && count >= cycles).then_some(self.frequency)
    }

    /// Returns the factor at time `t` [s].
    pub fn factor(&self, t: f64) -> f64 {
        if t < self.start || t > self.end {
            return 0.0;
        }
        let phase = (t - self.start) * self.frequency;
        match self.kind {
            HistoryKind::Constant => 1.0,
            HistoryKind::Ramp => phase.min(1.0),
            HistoryKind::Sine => libm::sin(TAU * phase),
            HistoryKind::Haversine => 0.5 * (1.0 - libm::cos(TAU * phase)),
            HistoryKind::Table => self.between(t - self.start),
        }
    }

    /// Returns the first feature undersampled at `step` [s] up to `end` [s].
    pub fn missed(&self, step: f64, end: f64) -> Option<Missed> {
        let (first, last) = (self.start.max(0.0), self.end.min(end));
        match self.kind {
            HistoryKind::Sine | HistoryKind::Haversine if first < last => {
                let per_period = 1.0 / (self.frequency * step);
                (per_period < SAMPLES).then_some(Missed::Period { samples: per_period })
            }
            HistoryKind::Table => {
                let largest = self.points.iter().fold(0.0, |m: f64, p| m.max(p.1.abs()));
                let strays = |&&(time, factor): &&(f64, f64)| {
                    let (at, before) = (time + self.start, ((time + self.start) / step).floor() * step);
                    let share = (at - before) / step;
                    let seen = (1.0 - share) * self.factor(before) + share * self.factor(before + step);
                    at > 0.0 && at < end && (factor - seen).abs() > STRAY * largest
                };
                let point = self.points.iter().find(strays);
                point.map(|&(time, factor)| Missed::Point { time: time + self.start, factor })
            }
            _ => None,
        }
    }

    /// Piecewise linear, constant beyond the table.
    fn between(&self, t: f64) -> f64 {
        let next = self.points.partition_point(|p| p.0 <= t);
        match (next.checked_sub(1).map(|i| self.points[i]), self.points.get(next)) {
            (Some((t0, f0)), Some(&(t1, f1))) => f0 + (f1 - f0) * (t - t0) / (t1 - t0),
            (Some((_, f)), None) | (None, Some(&(_, f))) => f,
            (None, None) => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(kind: HistoryKind, frequency: f64, cycles: f64) -> TimeFunction {
        let history = History {
            kind,
            frequency: Some(Quantity::new(frequency)),
            cycles: Some(cycles),
            duration: None,
            points: None,
            file: None,
            start: None,
        };
        TimeFunction::new(&history, None).unwrap()
    }

    #[test]
    fn interpolates_table_linearly() {
        let f = TimeFunction {
            kind: HistoryKind::Table,
            start: 1.0,
            points: vec![(0.0, 2.0), (1.0, 4.0), (3.0, -2.0)],
            ..TimeFunction::CONSTANT
        };
        for (t, expected) in
            [(0.5, 0.0), (1.0, 2.0), (1.5, 3.0), (2.0, 4.0), (3.0, 1.0), (4.0, -2.0), (9.0, -2.0)]
        {
            assert_eq!(f.factor(t), expected, "{t}");
        }
    }

    #[test]
    fn haversine_matches_definition_and_ends() {
        let f = history(HistoryKind::Haversine, 50.0, 1.0);
        for t in [0.0, 0.003, 0.01, 0.0173] {
            let expected = (std::f64::consts::PI * t / 0.02).sin().powi(2);
            assert!((f.factor(t) - expected).abs() < 1e-15, "{t}");
        }
        assert_eq!(f.factor(0.01), 1.0);
        assert_eq!(f.factor(0.0201), 0.0);
    }

    /// A pulse of 1 ms at steps of 10 ms and a sine of four steps are missed.
    #[test]
    fn detects_undersampled_pulse() {
        let table = |points: &[(f64, f64)]| TimeFunction {
            kind: HistoryKind::Table,
            points: points.to_vec(),
            ..TimeFunction::CONSTANT
        };
        let pulse = table(&[(0.0, 0.0), (0.0145, 0.0), (0.015, 1.0), (0.0155, 0.0)]);
        assert_eq!(pulse.missed(0.01, 0.1), Some(Missed::Point { time: 0.015, factor: 1.0 }));
        assert_eq!(pulse.missed(0.0005, 0.1), None);
        assert_eq!(pulse.missed(0.01, 0.014), None);
        assert_eq!(table(&[(0.0, 0.0), (0.05, 1.0)]).missed(0.01, 0.1), None);
        let fast = history(HistoryKind::Haversine, 25.0, 1.0);
        assert!(
            matches!(fast.missed(0.01, 0.1), Some(Missed::Period { samples }) if (samples - 4.0).abs() < 1e-12)
        );
        assert_eq!(fast.missed(0.005, 0.1), None);
        assert_eq!(TimeFunction::CONSTANT.missed(1.0, 2.0), None);
    }

    #[test]
    fn sine_cycles_have_zero_mean() {
        let f = history(HistoryKind::Sine, 4.0, 2.0);
        let sum: f64 = (0..1000).map(|i| f.factor((i as f64 + 0.5) * 0.5e-3)).sum();
        assert!(sum.abs() < 1e-9 && f.factor(0.0625) > 0.999);
    }
}
