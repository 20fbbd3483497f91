//! Measured values of quantities.

use super::file::TargetTable;
use super::quantity::{Quantity, Source};
use serde::{Deserialize, Serialize};
use trackbed_input::scene::{Document, SceneError};

/// Target of a quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Index of the quantity.
    pub quantity: usize,
    /// Measured value.
    pub value: f64,
    /// Standard deviation.
    pub tolerance: f64,
}

impl Target {
    /// Returns the deviation from the target over its tolerance.
    pub fn deviation(&self, value: f64) -> f64 {
        (value - self.value) / self.tolerance
    }
}

/// Resolves the targets.
///
/// # Errors
/// Input errors.
pub fn resolve(
    document: &Document,
    tables: &[TargetTable],
    quantities: &[Quantity],
) -> Result<Vec<Target>, SceneError> {
    let mut targets: Vec<Target> = Vec::new();
    for (k, table) in tables.iter().enumerate() {
        let fault = |key: &str, found: String, expected: &str| {
            document.error(&format!("target.{k}.{key}"), found, expected)
        };
        let quoted = || format!("{:?}", table.quantity);
        let Some(quantity) = quantities.iter().position(|q| q.name == table.quantity) else {
            let names: Vec<String> = quantities.iter().map(|q| format!("{:?}", q.name)).collect();
            return Err(fault("quantity", quoted(), &format!("one of {}", names.join(", "))));
        };
        if matches!(quantities[quantity].source, Source::Curve { .. }) {
            return Err(fault("quantity", quoted(), "a quantity without take = \"curve\""));
        }
        if targets.iter().any(|t| t.quantity == quantity) {
            return Err(fault("quantity", format!("{} twice", quoted()), "one target per quantity"));
        }
        if !table.value.is_finite() {
            return Err(fault("value", table.value.to_string(), "a finite number"));
        }
        if !(table.tolerance.is_finite() && table.tolerance > 0.0) {
            return Err(fault("tolerance", table.tolerance.to_string(), "a number above 0"));
        }
        targets.push(Target { quantity, value: table.value, tolerance: table.tolerance });
    }
    Ok(targets)
}

/// Returns √(mean of squared deviations); none without targets, or if a value is missing.
pub fn misfit(targets: &[Target], values: &[Option<f64>]) -> Option<f64> {
    let square = |t: &Target| Some(t.deviation(values[t.quantity]?)).map(|d| d * d);
    let squares = targets.iter().map(square).collect::<Option<Vec<f64>>>()?;
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misfit_is_root_mean_square() {
        let target = |quantity, value, tolerance| Target { quantity, value, tolerance };
        let targets = [target(0, 10.0, 2.0), target(2, 0.4, 0.1)];
        // Deviations of 3 and −4 tolerances: √((9 + 16) / 2).
        let found = misfit(&targets, &[Some(16.0), None, Some(0.0)]).unwrap();
        assert!((found - 12.5_f64.sqrt()).abs() < 1e-12, "{found}");
        assert_eq!(misfit(&targets, &[Some(16.0), Some(1.0), None]), None);
        assert_eq!(misfit(&[], &[Some(1.0)]), None);
    }
}
