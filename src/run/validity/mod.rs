//! Validity checks: limits of the theory. Balances may close although the equations do not apply.

mod applied_loads;
mod bed_extent;
mod bed_surface;
mod below_walls;
mod bond_rotation;
mod free_sleeper;
mod jump_error;
mod lost_bodies;
mod measure_box;
mod resonance;
mod scaled_inertia;
mod small_strain;
mod stiffness_drift;

pub use applied_loads::{LoadCheck, applied_loads, load_error};
pub use bed_extent::BedExtent;
pub use below_walls::grains_below_walls;
pub use bond_rotation::bond_rotation;
pub use free_sleeper::free_sleeper;
pub use jump_error::jump_error;
pub use lost_bodies::lost_bodies;
pub use measure_box::{measure_box, region_not_filled};
pub use resonance::load_near_mode;
pub use scaled_inertia::{Fall, scaled_inertia};
pub use small_strain::{quasi_static_strain, small_strain};
pub use stiffness_drift::stiffness_drift;

use serde::Serialize;

/// Check outcome, in increasing severity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Within its limit.
    #[default]
    Passed,
    /// Interpret results with caution.
    Warned,
    /// No valid result.
    Failed,
}

impl Outcome {
    /// Returns the outcome as a word.
    pub fn word(self) -> &'static str {
        match self {
            Outcome::Passed => "passed",
            Outcome::Warned => "warned",
            Outcome::Failed => "failed",
        }
    }
}

/// Limits for warning and failure.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Warning limit.
    pub warn: f64,
    /// Failure limit, if any.
    pub fail: Option<f64>,
}

/// Validity check.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Quantity.
    pub name: String,
    /// Value, a ratio.
    pub value: f64,
    /// Warning limit.
    pub limit: f64,
    /// Failure limit, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fail_above: Option<f64>,
    /// Outcome.
    pub status: Outcome,
    /// Finding and remedy; empty if passed.
    pub message: String,
}

impl Check {
    /// Compares a value with its limits; `message` is called lazily.
    pub fn new(
        name: impl Into<String>,
        value: f64,
        limits: Limits,
        message: impl FnOnce() -> String,
    ) -> Check {
        let above = |limit: f64| value.is_nan() || value > limit;
        let status = match limits.fail {
            Some(limit) if above(limit) => Outcome::Failed,
            _ if above(limits.warn) => Outcome::Warned,
            _ => Outcome::Passed,
        };
        let message = if status == Outcome::Passed { String::new() } else { message() };
        Check { name: name.into(), value, limit: limits.warn, fail_above: limits.fail, status, message }
    }
}

/// Returns the worst outcome.
pub fn worst(checks: &[Check]) -> Outcome {
    checks.iter().map(|c| c.status).max().unwrap_or_default()
}

/// Returns the messages of checks that did not pass.
pub fn messages(checks: &[Check]) -> impl Iterator<Item = String> {
    checks.iter().filter(|c| c.status != Outcome::Passed).map(|c| c.message.clone())
}

/// Formats report lines; none without checks.
pub fn report(checks: &[Check]) -> Vec<String> {
    if checks.is_empty() {
        return Vec::new();
    }
    let noun = if checks.len() == 1 { "check" } else { "checks" };
    let mut lines = vec![format!("validity: {}, {} {noun}", worst(checks).word(), checks.len())];
    for c in checks.iter().filter(|c| c.status != Outcome::Passed) {
        let (status, limit) = match c.fail_above {
            Some(limit) if c.status == Outcome::Failed => ("failed", limit),
            _ => ("warned", c.limit),
        };
        lines.push(format!("  {status}: {}: {:.3e} (limit {limit})", c.name, c.value));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { warn: 1.0, fail: Some(2.0) };

    #[test]
    fn values_are_compared_with_both_limits() {
        let status = |value: f64| Check::new("x", value, LIMITS, || "far".into()).status;
        assert_eq!(status(1.0), Outcome::Passed);
        assert_eq!(status(1.5), Outcome::Warned);
        assert_eq!(status(2.5), Outcome::Failed);
        assert_eq!(status(f64::NAN), Outcome::Failed);
    }

    #[test]
    fn report_lists_failed_checks() {
        assert!(report(&[]).is_empty());
        let check = |name: &str, value: f64| Check::new(name, value, LIMITS, || format!("{name} is far"));
        let checks = [check("a", 0.5), check("b", 1.5), check("c", 3.0)];
        let lines = report(&checks);
        assert_eq!(lines[0], "validity: failed, 3 checks");
        assert_eq!(lines[1], "  warned: b: 1.500e0 (limit 1)");
        assert_eq!(lines[2], "  failed: c: 3.000e0 (limit 2)");
        assert_eq!(messages(&checks).collect::<Vec<_>>(), ["b is far", "c is far"]);
    }
}
