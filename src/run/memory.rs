//! How much memory a solid will need, predicted before it is solved.
//!
//! What the model takes is there already and is asked of the system; what the factorization will take follows from the
//! structure of its equations; what the results take is a handful of nodal vectors. A run that will not fit is refused.

use crate::failure::Failure;
use crate::machine::{available, resident};
use crate::model::solid::{Analysis, SolidPart};
use serde_json::{Value, json};
use trackbed_fem::Method;

/// Bytes of a nodal vector's worth of results for each node: state, stresses, and the text of a frame.
const RESULT_BYTES_PER_NODE: u64 = 1200;

/// The memory that a solid will need [bytes].
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// Taken by the model by now.
    pub model: u64,
    /// Factor and fronts of the equations.
    pub solver: u64,
    /// State and results.
    pub results: u64,
    /// Floating-point operations of one factorization; 0 without one.
    pub flops: f64,
}

impl Prediction {
    /// Predicts for a solid whose model is made.
    ///
    /// # Errors
    /// The equations cannot be analysed.
    pub fn of(part: &SolidPart) -> Result<Prediction, Failure> {
        let (model, plan) = (resident().unwrap_or(0), &part.equations);
        let (mut solver, mut flops) = (0, 0.0);
        if plan.takes_factor() {
            let symmetric = part.model.symmetric_tangent() || matches!(part.analysis, Analysis::Static);
            let demand = part.model.solver_demand(symmetric).map_err(|e| part.failure(&e))?;
            (solver, flops) = (demand.bytes as u64, demand.flops);
        }
        // What the static solve takes is gone when the steps begin.
        let [statics, steps] = plan.iterates();
        if statics {
            solver = solver.max(part.model.static_iteration_memory() as u64);
        }
        if steps {
            solver = solver.max(part.model.window_iteration_memory() as u64);
        }
        solver = solver.max(mumps(part)?.unwrap_or(0));
        let results = RESULT_BYTES_PER_NODE * part.model.mesh().node_count() as u64;
        Ok(Prediction { model, solver, results, flops })
    }

    /// All of it [bytes].
    pub fn total(&self) -> u64 {
        self.model + self.solver + self.results
    }

    /// Refuses what will not fit into `limit` bytes, or into the memory that the machine has free.
    ///
    /// # Errors
    /// Bad input, with both figures.
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

/// How the equations of an elastic solid are solved, why, and with how much memory, beside that of the method not taken.
///
/// # Errors
/// As [`Prediction::of`].
pub fn methods(part: &SolidPart) -> Result<Vec<(String, Value)>, Failure> {
    let (plan, model) = (&part.equations, &part.model);
    let factor = || model.solver_demand(true).map(|d| d.bytes as u64).map_err(|e| part.failure(&e));
    let mumps = mumps(part)?;
    let mut lines = Vec::new();
    if plan.statics {
        let (factor, iteration) = (factor()?, model.static_iteration_memory() as u64);
        let memory = Memory { factor, iteration, mumps };
        lines.push(line("statics", plan.methods.statics, &plan.statics_reason, memory));
    }
    if plan.dynamics {
        let (factor, iteration) = (factor()?, model.window_iteration_memory() as u64);
        let memory = Memory { factor, iteration, mumps };
        lines.push(line("steps", plan.methods.dynamics, &plan.dynamics_reason, memory));
    }
    Ok(lines)
}

/// What MUMPS expects to take [bytes]; none where it is not used.
fn mumps(part: &SolidPart) -> Result<Option<u64>, Failure> {
    let Some(method) = part.equations.mumps() else { return Ok(None) };
    let memory = part.model.mumps_memory(method).map_err(|e| part.failure(&e))?;
    Ok(Some(memory as u64))
}

/// What each method takes [bytes].
struct Memory {
    factor: u64,
    iteration: u64,
    /// Where it is used.
    mumps: Option<u64>,
}

fn line(what: &str, method: Method, reason: &str, memory: Memory) -> (String, Value) {
    let (factor, iteration) = (size(memory.factor), size(memory.iteration));
    let (text, key) = match method {
        Method::Direct => {
            let other = format!("{factor}; conjugate gradients: {iteration}");
            (format!("equations of {what}: direct solver ({reason}), {other}"), "direct")
        }
        Method::Iterative { tolerance } => {
            let other = format!("{iteration}; direct solver: {factor}");
            let by = format!("conjugate gradients, tolerance {tolerance:e}");
            (format!("equations of {what}: {by} ({reason}), {other}"), "iterative")
        }
        Method::Mumps(method) => {
            let files = if method.out_of_core { " in files" } else { "" };
            let by = format!("MUMPS{files}");
            let own = size(memory.mumps.unwrap_or(0));
            let other = format!("{own}; direct solver: {factor}, conjugate gradients: {iteration}");
            (format!("equations of {what}: {by} ({reason}), {other}"), "mumps")
        }
    };
    let mut value = json!({
        "of": what,
        "method": key,
        "reason": reason,
        "factor_bytes": memory.factor,
        "iteration_bytes": memory.iteration,
    });
    if let (Method::Mumps(_), Some(bytes)) = (method, memory.mumps) {
        value["mumps_bytes"] = bytes.into();
    }
    (text, value)
}

fn refused(total: u64, expected: &str) -> Failure {
    Failure::Input(format!(
        "memory: found {} for the solid, expected {expected}. Use a coarser mesh or `solid.order = \"linear\"`.",
        size(total)
    ))
}

/// A size for people.
pub fn size(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes >= 1e9 { format!("{:.2} GB", bytes / 1e9) } else { format!("{:.0} MB", (bytes / 1e6).ceil()) }
}

/// Reads a size such as `800MB`, `2 GB` or a number of bytes.
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
