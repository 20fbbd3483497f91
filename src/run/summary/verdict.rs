//! Balance checks of a run.

use super::Summary;
use crate::energy_watch::ENERGY;
use crate::validity::{self, Outcome};
use serde::Serialize;
use trackbed_io::failure::Failure;

/// Static imbalance: warning, failure.
const EQUILIBRIUM: (f64, f64) = (1e-3, 0.05);

/// Conserved to rounding.
const MOMENTUM: f64 = 1e-6;

/// Conserved to rounding.
const TRANSFER: f64 = 1e-8;

/// Negative dissipation over reference energy.
const NEGATIVE: f64 = 0.01;

/// Check.
#[derive(Clone, Debug, Serialize)]
pub struct Judged {
    /// Quantity.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Warning limit.
    pub warn_above: f64,
    /// Failure limit, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_above: Option<f64>,
    /// Outcome.
    pub outcome: Outcome,
}

impl Judged {
    fn new(name: impl Into<String>, value: f64, warn_above: f64, stop_above: Option<f64>) -> Judged {
        // NaN fails.
        let above = |limit: f64| value.is_nan() || value > limit;
        let outcome = match stop_above {
            Some(limit) if above(limit) => Outcome::Failed,
            _ if above(warn_above) => Outcome::Warned,
            _ => Outcome::Passed,
        };
        Judged { name: name.into(), value, warn_above, stop_above, outcome }
    }
}

/// Checks and overall outcome.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Verdict {
    /// Worst outcome of balance and validity checks.
    pub outcome: Outcome,
    /// Balance checks.
    pub checks: Vec<Judged>,
    /// Whether the run stopped with a failure.
    #[serde(skip)]
    stopped: bool,
}

impl Verdict {
    /// Checks the balances.
    pub fn of(summary: &Summary) -> Verdict {
        let mut checks = Vec::new();
        if let Some(e) = &summary.energy {
            // The energy check stops the run itself.
            let what = "largest energy error over reference energy";
            checks.push(Judged::new(what, e.largest_relative_error, ENERGY.0, None));
            for (name, loss) in e.flows.dissipation_terms() {
                let below = (-loss).max(0.0) / e.reference_energy.max(f64::MIN_POSITIVE);
                if below > NEGATIVE {
                    let what = format!("energy gained from {name} over reference energy");
                    checks.push(Judged::new(what, below, NEGATIVE, None));
                }
            }
        }
        if let Some(m) = &summary.momentum {
            checks.push(Judged::new("momentum error over impulses", m.linear, MOMENTUM, None));
            checks.push(Judged::new("angular momentum error over impulses", m.angular, MOMENTUM, None));
        }
        if let Some(s) = &summary.solid.statics {
            let (warn, stop) = EQUILIBRIUM;
            let what = "equilibrium error of loads and reactions";
            checks.push(Judged::new(what, s.equilibrium_error, warn, Some(stop)));
        }
        if let Some(c) = &summary.coupling {
            let transfer = c.transfer.force.max(c.transfer.moment);
            checks.push(Judged::new("force and moment error across the interface", transfer, TRANSFER, None));
            checks.push(Judged::new("windows not converged", c.passes.unconverged as f64, 0.0, None));
        }
        let balances = checks.iter().map(|j| j.outcome).max().unwrap_or_default();
        let outcome = balances.max(validity::worst(&summary.validity));
        Verdict { outcome, checks, stopped: false }
    }

    /// Marks the run as failed.
    pub fn fail(&mut self) {
        self.outcome = Outcome::Failed;
        self.stopped = true;
    }

    /// Formats report lines.
    pub fn report(&self) -> Vec<String> {
        let count = self.checks.len();
        let noun = if count == 1 { "balance" } else { "balances" };
        // Without the validity, which has its own line.
        let worst = self.checks.iter().map(|j| j.outcome).max().unwrap_or_default();
        let balances = if self.stopped { Outcome::Failed } else { worst };
        let mut lines = vec![format!("checks: {}, {count} {noun}", balances.word())];
        for j in self.checks.iter().filter(|j| j.outcome != Outcome::Passed) {
            lines.push(format!(
                "  {}: {}: {:.3e} (limit {:.0e})",
                j.outcome.word(),
                j.name,
                j.value,
                j.warn_above
            ));
        }
        lines
    }

    /// Converts a failed check to a failure.
    ///
    /// # Errors
    /// That failure.
    pub fn judge(&self) -> Result<(), Failure> {
        match self.checks.iter().find(|j| j.outcome == Outcome::Failed) {
            None => Ok(()),
            Some(j) => Err(Failure::Numerical(format!(
                "{}: {:.3e} (limit {:.0e})",
                j.name,
                j.value,
                j.stop_above.unwrap_or(j.warn_above)
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::{CouplingRecord, MomentumRecord};
    use trackbed_coupling::scheme::{IterationStats, Scheme};
    use trackbed_coupling::stability::ContactStabilityNumbers;
    use trackbed_coupling::transfer::TransferAudit;

    #[test]
    fn nan_fails() {
        assert_eq!(Judged::new("x", f64::NAN, 1.0, Some(2.0)).outcome, Outcome::Failed);
        assert_eq!(Judged::new("x", 1.5, 1.0, Some(2.0)).outcome, Outcome::Warned);
        assert_eq!(Judged::new("x", 1.0, 1.0, Some(2.0)).outcome, Outcome::Passed);
    }

    #[test]
    fn each_account_judges_its_own_figure() {
        let remarked = |summary: &Summary| -> Vec<String> {
            let checks = Verdict::of(summary).checks.into_iter();
            checks.filter(|j| j.outcome != Outcome::Passed).map(|j| j.name).collect()
        };
        let grains = |linear: f64, angular: f64| Summary {
            momentum: Some(MomentumRecord { linear, angular }),
            ..Summary::default()
        };
        assert!(remarked(&grains(0.0, 0.0)).is_empty());
        assert_eq!(remarked(&grains(1e-3, 0.0)), ["momentum error over impulses"]);
        assert_eq!(remarked(&grains(0.0, 1e-3)), ["angular momentum error over impulses"]);
        let coupled = |force: f64, moment: f64, unconverged: u64| Summary {
            coupling: Some(CouplingRecord {
                transfer: TransferAudit { exchanges: 9, force, moment },
                scheme: Scheme::default(),
                substeps: 1,
                theta: 0.5,
                interface: Default::default(),
                division: 1,
                stability: ContactStabilityNumbers::default(),
                classes: Vec::new(),
                passes: IterationStats { windows: 9, passes: 9, unconverged, solves: 0 },
                interface_work_error: 0.0,
                transfer_kind: String::new(),
                reduction: None,
            }),
            ..Summary::default()
        };
        let across = ["force and moment error across the interface"];
        assert!(remarked(&coupled(0.0, 0.0, 0)).is_empty());
        assert_eq!(remarked(&coupled(1e-6, 0.0, 0)), across);
        assert_eq!(remarked(&coupled(0.0, 1e-6, 0)), across);
        assert_eq!(remarked(&coupled(0.0, 0.0, 1)), ["windows not converged"]);
    }
}
