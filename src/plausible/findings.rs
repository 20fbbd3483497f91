//! What is found and the ranges that it is weighed by.

use serde::Serialize;
use std::fmt;
use trackbed_dem::law::parameter::{Parameter, Typical};

/// Factor beyond the usual range from which a value is implausible.
const FAR: f64 = 30.0;

/// A value that is not plausible.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Whether it cannot be meant.
    pub serious: bool,
    /// The key.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is usual.
    pub usual: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = if self.serious { "implausible" } else { "unusual" };
        write!(f, "{}: found {}, expected {} ({word})", self.key, self.found, self.usual)
    }
}

/// What was found so far.
#[derive(Debug, Default)]
pub struct Findings(pub Vec<Finding>);

/// A usual range [SI units]; zero may be usual beside it.
#[derive(Clone, Copy, Debug)]
pub struct Usual {
    low: f64,
    high: f64,
    unit: &'static str,
    zero: bool,
}

impl Usual {
    /// A range.
    pub const fn new(low: f64, high: f64, unit: &'static str) -> Usual {
        Usual { low, high, unit, zero: false }
    }

    /// The typical range of a parameter.
    pub fn of<T>(parameter: &Parameter<T>) -> Usual {
        let Typical { low, high, or_zero } = parameter.typical;
        Usual { low, high, unit: parameter.unit, zero: or_zero }
    }

    /// The same with zero, which switches something off.
    pub const fn or_zero(low: f64, high: f64, unit: &'static str) -> Usual {
        Usual { low, high, unit, zero: true }
    }
}

impl Findings {
    /// Weighs a value against its range.
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

    /// The same of a key that may be absent.
    pub fn weigh_some(&mut self, key: impl Into<String>, value: Option<f64>, usual: Usual) {
        if let Some(value) = value {
            self.weigh(key, value, usual);
        }
    }

    /// Adds what was found.
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

/// A value with its unit: plain where that is short.
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
