//! Memory prediction of a solid.

use serde_json::{Value, json};
use trackbed_fem::{Method, Regime};
use trackbed_input::model::solid::{Analysis, SolidPart};
use trackbed_io::failure::Failure;
use trackbed_io::system::{available, resident};

/// State, stresses, frame text.
const RESULT_BYTES_PER_NODE: u64 = 1200;

/// Predicted memory of a solid [bytes].
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// Model, already allocated.
    pub model: u64,
    /// Factor and frontal matrices.
    pub solver: u64,
    /// State and results.
    pub results: u64,
    /// Floating-point operations per factorization; 0 without one.
    pub flops: f64,
}

impl Prediction {
    /// Predicts memory of an assembled model.
    ///
    /// # Errors
    /// Failed analysis.
    pub fn of(part: &SolidPart) -> Result<Prediction, Failure> {
        let (model, plan) = (resident().unwrap_or(0), &part.equations);
        let (mut solver, mut flops) = (0, 0.0);
        if plan.takes_factor() {
            let symmetric = part.model.symmetric_tangent() || matches!(part.analysis, Analysis::Static);
            let demand = part.model.solver_demand(symmetric).map_err(|e| part.failure(&e))?;
            (solver, flops) = (demand.bytes as u64, demand.flops);
        }
        // The static solver is freed before time steps.
        for (regime, method) in plan.used().filter(|(_, method)| *method != Method::Direct) {
            solver = solver.max(method_bytes(part, method, regime)?);
        }
        let results = RESULT_BYTES_PER_NODE * part.model.mesh().node_count() as u64;
        Ok(Prediction { model, solver, results, flops })
    }

    /// Returns the total [bytes].
    pub fn total(&self) -> u64 {
        self.model + self.solver + self.results
    }

    /// Rejects demand above `limit` bytes or free memory.
    ///
    /// # Errors
    /// Input error.
    pub fn check(&self, limit: Option<u64>) -> Result<(), Failure> {
        let further = self.solver + self.results;
        if let Some(limit) = limit
            && self.total() > limit
        {
            return Err(refused(self.total(), &format!("at most {} (--memory)", size(limit))));
        }
        match available() {
            Some(free) if further > free => {
                Err(refused(self.total(), &format!("at most {} (free memory)", size(free + self.model))))
            }
            _ => Ok(()),
        }
    }
}

/// Returns solvers with reason and memory.
///
/// # Errors
/// As [`Prediction::of`].
pub fn methods(part: &SolidPart) -> Result<Vec<(String, Value)>, Failure> {
    part.equations.used().map(|(regime, method)| line(part, regime, method)).collect()
}

fn method_bytes(part: &SolidPart, method: Method, regime: Regime) -> Result<u64, Failure> {
    part.model.solver_memory(method, regime).map(|bytes| bytes as u64).map_err(|e| part.failure(&e))
}

fn line(part: &SolidPart, regime: Regime, method: Method) -> Result<(String, Value), Failure> {
    let (what, reason) = match regime {
        Regime::Statics => ("statics", &part.equations.statics_reason),
        Regime::Dynamics => ("steps", &part.equations.dynamics_reason),
    };
    let of = |method| method_bytes(part, method, regime);
    let factor = of(Method::Direct)?;
    let iteration = of(Method::Iterative { tolerance: Method::WINDOW_TOLERANCE })?;
    let mut value = json!({
        "of": what,
        "method": method.name(),
        "reason": reason,
        "factor_bytes": factor,
        "iteration_bytes": iteration,
    });
    let compared = [("direct", "direct solver", factor), ("iterative", "conjugate gradients", iteration)];
    let is_own = |(name, ..): &(&str, &str, u64)| *name == method.name();
    let own = match compared.iter().find(|c| is_own(c)) {
        Some((_, _, bytes)) => *bytes,
        None => {
            let bytes = of(method)?;
            value[format!("{}_bytes", method.name())] = bytes.into();
            bytes
        }
    };
    let others = compared.iter().filter(|c| !is_own(c));
    let other: Vec<String> = others.map(|(_, title, bytes)| format!("{title}: {}", size(*bytes))).collect();
    Ok((format!("equations of {what}: {method} ({reason}), {}; {}", size(own), other.join(", ")), value))
}

fn refused(total: u64, expected: &str) -> Failure {
    Failure::Input(format!(
        "memory: found {} for the solid, expected {expected}. Use a coarser mesh or `solid.order = \"linear\"`.",
        size(total)
    ))
}

/// Formats a size.
pub fn size(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes >= 1e9 { format!("{:.2} GB", bytes / 1e9) } else { format!("{:.0} MB", (bytes / 1e6).ceil()) }
}

/// Parses a size such as `800MB`, `2 GB` or bytes.
pub fn parse_size(text: &str) -> Option<u64> {
    let text = text.trim();
    let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let number: f64 = text[..split].trim().parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0)?;
    let factor = match text[split..].to_ascii_uppercase().as_str() {
        "" | "B" => 1.0,
        "KB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        "MIB" => 1024.0 * 1024.0,
        "GIB" => 1024.0 * 1024.0 * 1024.0,
        _ => return None,
    };
    Some((number * factor) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_printed() {
        assert_eq!(parse_size("800MB"), Some(800_000_000));
        assert_eq!(parse_size(" 1.5 GiB"), Some(1_610_612_736));
        assert_eq!((parse_size("4096"), parse_size("2 parsec"), parse_size("-1")), (Some(4096), None, None));
        assert_eq!((size(1_610_612_736), size(7_300_000)), ("1.61 GB".into(), "8 MB".into()));
    }
}
