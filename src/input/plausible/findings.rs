//! Findings and typical ranges.

use serde::Serialize;
use std::fmt;
use trackbed_dem::law::parameter::{Parameter, Typical};

/// Factor beyond the typical range of implausible values.
const FAR: f64 = 30.0;

/// Implausible or unusual value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Whether implausible.
    pub serious: bool,
    /// Key.
    pub key: String,
    /// Value found.
    pub found: String,
    /// Typical values.
    pub usual: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = if self.serious { "implausible" } else { "unusual" };
        write!(f, "{}: found {}, expected {} ({word})", self.key, self.found, self.usual)
    }
}

/// Findings so far.
#[derive(Debug, Default)]
pub struct Findings(pub Vec<Finding>);

/// Typical range [SI units], optionally with zero.
#[derive(Clone, Copy, Debug)]
pub struct Usual {
    low: f64,
    high: f64,
    unit: &'static str,
    zero: bool,
}

impl Usual {
    /// Creates a range.
    pub const fn new(low: f64, high: f64, unit: &'static str) -> Usual {
        Usual { low, high, unit, zero: false }
    }

    /// Returns the typical range of a parameter.
    pub fn of<T>(parameter: &Parameter<T>) -> Usual {
        let Typical { low, high, or_zero } = parameter.typical;
        Usual { low, high, unit: parameter.unit, zero: or_zero }
    }

    /// Creates a range with zero, which disables a feature.
    pub const fn or_zero(low: f64, high: f64, unit: &'static str) -> Usual {
        Usual { low, high, unit, zero: true }
    }
}

impl Findings {
    /// Checks a value against its range.
    pub fn weigh(&mut self, key: impl Into<String>, value: f64, usual: Usual) {
        let Usual { low, high, unit, zero } = usual;
        if (low..=high).contains(&value) || zero && value == 0.0 {
            return;
        }
        let far = value > FAR * high || value < low / FAR;
        let or = if zero { "0 or " } else { "" };
        let range = format!("{or}{} to {}", shown(low, ""), shown(high, unit));
        self.add(far, key, shown(value, unit), range);
    }

    /// Checks an optional value.
    pub fn weigh_some(&mut self, key: impl Into<String>, value: Option<f64>, usual: Usual) {
        if let Some(value) = value {
            self.weigh(key, value, usual);
        }
    }

    /// Adds a finding.
    pub fn add(
        &mut self,
        serious: bool,
        key: impl Into<String>,
        found: impl Into<String>,
        usual: impl Into<String>,
    ) {
        self.0.push(Finding { serious, key: key.into(), found: found.into(), usual: usual.into() });
    }
}

/// Formats a value with unit.
pub fn shown(value: f64, unit: &str) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return format!("more than 1e308 {unit}").trim_end().to_string();
    }
    let digits = match value == 0.0 || (1e-3..1e5).contains(&size) {
        true => format!("{}", (value * 1e4).round() / 1e4),
        false => format!("{value:.3e}"),
    };
    format!("{digits} {unit}").trim_end().to_string()
}
