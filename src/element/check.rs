//! Checks of a test: constitutive law and steps.

use super::point::State;
use serde::Serialize;
use trackbed_fem::element_test::{Checks, OBJECTIVITY_LIMIT, TANGENT_LIMIT, WORK_LIMIT};

/// Outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Within its limit.
    Passed,
    /// Beyond its limit.
    Failed,
    /// Without a limit.
    Reported,
    /// Law without this property.
    #[serde(rename = "not applicable")]
    NotApplicable,
}

/// Check with its value and limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Name.
    pub name: &'static str,
    /// Value.
    pub value: Option<f64>,
    /// Limit, if any.
    pub limit: Option<f64>,
    /// Outcome.
    pub outcome: Outcome,
    /// Meaning of the value.
    pub quantity: &'static str,
    /// Further numbers, or empty.
    pub note: String,
}

impl Check {
    fn new(name: &'static str, quantity: &'static str, value: f64, limit: f64, note: String) -> Check {
        let outcome = if value <= limit { Outcome::Passed } else { Outcome::Failed };
        Check { name, value: Some(value), limit: Some(limit), outcome, quantity, note }
    }

    fn without_limit(
        name: &'static str,
        quantity: &'static str,
        value: Option<f64>,
        outcome: Outcome,
    ) -> Check {
        Check { name, value, limit: None, outcome, quantity, note: String::new() }
    }

    /// Whether the limit is exceeded.
    pub fn has_failed(&self) -> bool {
        self.outcome == Outcome::Failed
    }

    /// Formats a line.
    pub fn line(&self) -> String {
        let Check { name, quantity, .. } = self;
        let note = if self.note.is_empty() { String::new() } else { format!(", {}", self.note) };
        let value = match self.value {
            None => return format!("{name}: not applicable to this law"),
            Some(0.0) => "0".into(),
            Some(value) => format!("{value:.1e}"),
        };
        match self.limit {
            None => format!("{name}: {quantity} {value}{note}"),
            Some(limit) if self.has_failed() => {
                format!("{name}: found {quantity} {value}, expected at most {limit:e}{note}")
            }
            Some(limit) => format!("{name}: passed, {value} (limit {limit:e}){note}"),
        }
    }
}

/// Checks of a test; `fine`: states with twice the steps.
pub fn checks(found: &Checks, states: &[State], fine: &[State]) -> Vec<Check> {
    let tangent = &found.tangent;
    let mut note = format!("compared {}, skipped {} at the yield surface", tangent.compared, tangent.skipped);
    if tangent.largest > TANGENT_LIMIT {
        note += &format!(", largest in step {}", tangent.step);
    }
    let rotated = "deviation of the rotated response";
    let if_applicable = |name, quantity, value, limit, note| match value {
        Some(value) => Check::new(name, quantity, value, limit, note),
        None => Check::without_limit(name, quantity, None, Outcome::NotApplicable),
    };
    let change = "change of the final stress with twice the steps";
    let plastic = format!("{} increments with plastic flow", found.plastic);
    vec![
        Check::new("tangent", "deviation from central differences", tangent.largest, TANGENT_LIMIT, note),
        if_applicable("dissipation", "negative plastic work", found.negative_work, WORK_LIMIT, plastic),
        if_applicable("objectivity", rotated, found.objectivity, OBJECTIVITY_LIMIT, String::new()),
        Check::without_limit("steps", change, Some(deviation(states, fine)), Outcome::Reported),
    ]
}

/// Largest difference of the final stresses over the largest stress.
fn deviation(states: &[State], fine: &[State]) -> f64 {
    let [end, other] = [states, fine].map(|states| states[states.len() - 1].stress);
    let size = end.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let most = (0..6).map(|k| (end[k] - other[k]).abs()).fold(0.0, f64::max);
    if size > 0.0 { most / size } else { most }
}
