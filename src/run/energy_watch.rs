//! Energy check during a run.

use serde::{Deserialize, Serialize};
use trackbed_coupling::energy_balance::EnergyBalance;
use trackbed_io::failure::Failure;

/// Relative energy error for a warning, and for a stop.
pub const ENERGY: (f64, f64) = (0.01, 0.2);

/// Fraction of elastic and kinetic energy added to the reference energy, which is almost zero in the first
/// steps: first contacts must not stop the run.
const HELD: f64 = 0.25;

/// Checks allowed above the stop limit: the first step from rest has almost no reference energy.
const FIRST: u32 = 2;

/// Relative energy error over a run.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct EnergyWatch {
    /// Largest reference energy or floor [J].
    scale: f64,
    largest: f64,
    error: f64,
    #[serde(default)]
    first: u32,
    /// Whether a check with nonzero energy passed.
    #[serde(default)]
    begun: bool,
}

impl EnergyWatch {
    /// Adds a balance check.
    ///
    /// # Errors
    /// Above the stop limit.
    pub fn follow(&mut self, balance: &EnergyBalance) -> Result<(), Failure> {
        self.scale = self.scale.max(balance.reference_energy()).max(balance.negligible_energy());
        self.error = balance.error().abs();
        self.largest = self.largest.max(self.error);
        let scale = self.scale.max(HELD * balance.kinetic_and_spring_energy());
        let share = relative(balance.error_with_numerical_gain(), scale);
        if share <= ENERGY.1 {
            self.begun |= balance.reference_energy() > 0.0 || balance.kinetic_and_spring_energy() > 0.0;
            return Ok(());
        }
        self.first += 1;
        if !self.begun && self.first <= FIRST && share.is_finite() {
            return Ok(());
        }
        let error = balance.error_with_numerical_gain();
        Err(Failure::Numerical(format!(
            "energy error: {error:.3e} J, {:.0} % of the reference energy {scale:.3e} J (limit {:.0} %). Reduce the time steps (time.grain_step, solid.dynamics, coupling), or start without large overlaps.",
            100.0 * share,
            100.0 * ENERGY.1
        )))
    }

    /// Returns the current error over the largest reference energy.
    pub fn now(&self) -> f64 {
        relative(self.error, self.scale)
    }

    /// Returns the largest error over the largest reference energy.
    pub fn worst(&self) -> f64 {
        relative(self.largest, self.scale)
    }
}

fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};

    fn balance(kinetic: f64, friction: f64) -> EnergyBalance {
        let start = StoredEnergy { grains_kinetic: 1.0, ..StoredEnergy::default() };
        let now = StoredEnergy { grains_kinetic: kinetic, ..StoredEnergy::default() };
        EnergyBalance {
            start,
            now,
            spent: WorkAndDissipation { friction, ..WorkAndDissipation::default() },
            ..EnergyBalance::default()
        }
    }

    #[test]
    fn checks_rows_by_largest_reference_energy() {
        let mut watch = EnergyWatch::default();
        watch.follow(&balance(0.2, 0.81)).unwrap();
        assert!((watch.now() - 0.01 / 0.81).abs() < 1e-12, "{watch:?}");
        // The same error, zero current reference energy.
        watch.follow(&balance(1.01, 0.0)).unwrap();
        assert!((watch.now() - 0.01 / 0.81).abs() < 1e-12, "{watch:?}");
        let failure = watch.follow(&balance(1.5, 0.0)).unwrap_err();
        assert_eq!(failure.code(), 3);
        assert!(failure.to_string().contains("62 %"), "{failure}");
        assert!(watch.follow(&balance(f64::NAN, 0.0)).is_err());
        assert!(EnergyWatch::default().follow(&balance(f64::NAN, 0.0)).is_err());
        // At rest, rounding is no error.
        EnergyWatch::default().follow(&balance(1.0 + 1e-14, 0.0)).unwrap();
    }

    #[test]
    fn the_worst_row_is_remembered() {
        let mut watch = EnergyWatch::default();
        watch.follow(&balance(0.2, 0.75)).unwrap();
        watch.follow(&balance(0.2, 0.8)).unwrap();
        assert!(watch.now() < 1e-15, "{watch:?}");
        assert!((watch.worst() - 0.05 / 0.8).abs() < 1e-12, "{watch:?}");
    }

    #[test]
    fn numerical_gain_stops_run() {
        let closed = EnergyBalance {
            spent: WorkAndDissipation { numerical: -0.3, ..WorkAndDissipation::default() },
            ..balance(1.3, 0.0)
        };
        assert!(closed.error().abs() < 1e-15);
        let mut watch = EnergyWatch::default();
        assert!((0..3).any(|_| watch.follow(&closed).is_err()));
        let lost = EnergyBalance {
            spent: WorkAndDissipation { numerical: 0.3, ..WorkAndDissipation::default() },
            ..balance(0.7, 0.0)
        };
        EnergyWatch::default().follow(&lost).unwrap();
    }

    #[test]
    fn transient_error_continues_run() {
        let ramp = |error: f64, work: f64| {
            let now = StoredEnergy { grains_kinetic: work, ..StoredEnergy::default() };
            let spent = WorkAndDissipation { applied_work: work + error, ..WorkAndDissipation::default() };
            EnergyBalance { now, spent, ..EnergyBalance::default() }
        };
        let mut watch = EnergyWatch::default();
        for k in 1..30 {
            let time = f64::from(k);
            watch.follow(&ramp(0.3 * time, time.powi(2))).unwrap();
        }
        // Persistent, or exploding.
        let stays = |k: i32| ramp(0.3 * f64::from(k), f64::from(k));
        let explodes = |k: i32| ramp(0.3 * 3.0_f64.powi(k), 3.0_f64.powi(k));
        let mut watch = [EnergyWatch::default(); 2];
        assert!((1..4).any(|k| watch[0].follow(&stays(k)).is_err()));
        assert!((1..4).any(|k| watch[1].follow(&explodes(k)).is_err()));
    }

    #[test]
    fn initial_reference_includes_stored_energy() {
        let mut watch = EnergyWatch::default();
        watch.follow(&balance(1.001, 1e-6)).unwrap();
        assert!(watch.now() > 0.9, "the judgement at the end has no such allowance: {watch:?}");
    }
}
