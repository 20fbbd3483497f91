//! Energy balance of a packing stage.

use crate::validity::{Check, Limits};
use serde::{Deserialize, Serialize};
use trackbed_coupling::energy_balance::{EnergyBalance, StoredEnergy};
use trackbed_coupling::step::grain_work_and_dissipation;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_io::failure::Failure;

const GAIN: Limits = Limits { warn: 0.01, fail: Some(0.2) };
/// Long steps overestimate dashpots by up to 8 %.
const ERROR: Limits = Limits { warn: 0.1, fail: Some(0.5) };
/// Over the later reference energy.
const CHANGE: Limits = Limits { warn: 0.1, fail: Some(0.5) };

/// Energy balance of a packing stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageEnergy {
    /// Stage name.
    pub stage: String,
    /// Initial and final elastic contact energy [J].
    pub springs: [f64; 2],
    /// Final kinetic energy, then dropped [J].
    pub kinetic: f64,
    /// Reference energy [J].
    pub reference_energy: f64,
    /// Energy error [J].
    pub error: f64,
    /// Relative energy error.
    pub relative_error: f64,
    /// Spurious energy over reference energy.
    pub gain: f64,
    /// Grains removed above the level.
    pub removed: usize,
    /// Kinetic energy of removed grains [J].
    pub removed_kinetic: f64,
}

impl StageEnergy {
    /// Computes the balance from initial `model` to `state`; `surface`: rigid solid.
    ///
    /// # Errors
    /// Failed initial contact detection.
    pub fn of(
        stage: &str,
        model: &dem::Model,
        state: &dem::State,
        surface: Option<&SolidSurface>,
    ) -> Result<StageEnergy, Failure> {
        let mut start = dem::State::new(model);
        let mut work = dem::Work::new(model, &start);
        match surface {
            Some(s) => dem::find_contacts(model, &mut start, &mut work, s),
            None => dem::find_contacts(model, &mut start, &mut work, &dem::surface::NoSurface),
        }
        .map_err(|e| {
            Failure::Numerical(format!("grains at the start of {stage}: {}", model.name_objects(&e)))
        })?;
        let balance = EnergyBalance {
            start: stored(model, &start),
            now: stored(model, state),
            spent: grain_work_and_dissipation(state),
            reference: dem::measure::reference_energy(model, state),
        };
        let (error, reference_energy) =
            (balance.error(), balance.reference_energy().max(balance.negligible_energy()));
        let relative_error = if error == 0.0 { 0.0 } else { error.abs() / reference_energy };
        let made = balance.now.total() - balance.start.total() - balance.spent.work();
        let gain = made.max(0.0) / reference_energy.max(f64::MIN_POSITIVE);
        let springs = [balance.start, balance.now].map(|s| s.contact_springs);
        let kinetic = balance.now.grains_kinetic;
        let stage = stage.to_string();
        Ok(StageEnergy {
            stage,
            springs,
            kinetic,
            reference_energy,
            error,
            relative_error,
            gain,
            ..StageEnergy::default()
        })
    }

    /// Checks energy gain and error of all stages.
    pub fn checks(stages: &[StageEnergy]) -> Vec<Check> {
        let worst = |of: fn(&StageEnergy) -> f64| stages.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
        let gain = worst(|stage| stage.gain).map(|worst| {
            Check::new("energy gained in a packing stage over its reference energy", worst.gain, GAIN, || {
                format!(
                    "{}: energy increased by more than the work of walls and forces. Reduce time.grain_step_fraction.",
                    worst.stage
                )
            })
        });
        let error = worst(|stage| stage.relative_error).map(|worst| {
            Check::new("energy error of a packing stage over its reference energy", worst.relative_error, ERROR, || {
                let StageEnergy { stage, error, reference_energy, .. } = worst;
                format!("{stage}: energy error {error:.3e} J, reference energy {reference_energy:.3e} J. Reduce time.grain_step_fraction.")
            })
        });
        gain.into_iter().chain(error).collect()
    }

    /// Checks elastic energy gained between stages; `run`: initial elastic and reference energy [J].
    pub fn check_changes(stages: &[StageEnergy], run: [f64; 2]) -> Option<Check> {
        let run = StageEnergy {
            stage: "run".into(),
            springs: [run[0]; 2],
            reference_energy: run[1],
            ..StageEnergy::default()
        };
        let next = stages.iter().skip(1).chain([&run]);
        let made = |(before, after): (&StageEnergy, &StageEnergy)| {
            let energy = (after.springs[0] - before.springs[1]).max(0.0);
            (energy / after.reference_energy.max(f64::MIN_POSITIVE), energy, after.stage.clone())
        };
        let (share, energy, stage) = stages.iter().zip(next).map(made).max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Check::new(
            "energy gained between packing stages over the reference energy",
            share,
            CHANGE,
            || {
                format!(
                    "{stage}: energy of contact springs increased by {energy:.3e} J since the end of the previous stage (stiffening contacts). Increase stiffness_factor of the previous stage."
                )
            },
        ))
    }

    /// Records removed grains.
    pub fn remove(
        &mut self,
        model: &dem::Model,
        state: &dem::State,
        before: &[BodyInput],
        removed: &[usize],
    ) -> Option<String> {
        let g = model.gravity().norm();
        let kinetic = |&b: &usize| 0.5 * model.mass(b) * state.velocity(b).norm_squared();
        self.removed = removed.len();
        self.removed_kinetic = removed.iter().map(kinetic).sum();
        let top = before.iter().filter(|b| !b.absent).map(|b| b.position.z).fold(f64::NEG_INFINITY, f64::max);
        let rises = |b: usize| state.position(b).z + 0.5 * state.velocity(b).norm_squared() / g - top;
        let shot = removed.iter().copied().filter(|&b| rises(b) > 1e-3 * top.abs().max(1e-3));
        let worst = shot.max_by(|&a, &b| rises(a).total_cmp(&rises(b)))?;
        Some(format!(
            "grain {worst} removed above the level at z = {:.3} m with {:.2e} m/s after {}: rises {:.2e} m above all start positions. Check for overlaps at the start of the stage.",
            state.position(worst).z,
            state.velocity(worst).norm(),
            self.stage,
            rises(worst)
        ))
    }
}

fn stored(model: &dem::Model, state: &dem::State) -> StoredEnergy {
    let e = dem::measure::energies(model, state);
    StoredEnergy {
        grains_kinetic: e.kinetic(),
        contact_springs: e.elastic_normal + e.elastic_tangential,
        bonds: e.elastic_bonds,
        mounts: e.elastic_mounts,
        grains_gravity: e.gravity,
        ..StoredEnergy::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    fn stage(name: &str, springs: [f64; 2], [error, gain]: [f64; 2]) -> StageEnergy {
        let reference_energy = 10.0;
        let relative_error = error / reference_energy;
        StageEnergy {
            stage: name.into(),
            springs,
            reference_energy,
            error,
            relative_error,
            gain,
            ..StageEnergy::default()
        }
    }

    #[test]
    fn energy_between_stages_is_checked() {
        let status = |start: f64, run: f64| {
            let stages = [stage("fill", [0.0, 1.0], [0.0; 2]), stage("pour", [start, 0.5], [0.0; 2])];
            let check = StageEnergy::check_changes(&stages, [run, 10.0]).expect("stages");
            (check.status, check.message)
        };
        assert_eq!(status(1.0, 0.5).0, Outcome::Passed);
        assert_eq!(status(0.0, 0.5).0, Outcome::Passed);
        let (outcome, message) = status(3.0, 0.5);
        assert!(
            outcome == Outcome::Warned
                && message.starts_with("pour: energy of contact springs increased by 2.000e0 J"),
            "{message}"
        );
        let (outcome, message) = status(1.0, 7.0);
        assert!(
            outcome == Outcome::Failed
                && message.starts_with("run: energy of contact springs increased by 6.500e0 J"),
            "{message}"
        );
        assert!(StageEnergy::check_changes(&[], [1.0, 1.0]).is_none());
    }

    #[test]
    fn worst_stage_decides_error_and_gain() {
        let status = |worst: [f64; 2]| {
            let stages = [stage("fill", [0.0; 2], [0.1, 0.0]), stage("pour", [0.0; 2], worst)];
            let checks = StageEnergy::checks(&stages);
            let [gain, error] = &checks[..] else { panic!("{checks:?}") };
            [gain.status, error.status]
        };
        use Outcome::{Failed, Passed, Warned};
        assert_eq!(status([0.5, 0.005]), [Passed, Passed]);
        assert_eq!(status([2.0, 0.005]), [Passed, Warned]);
        assert_eq!(status([6.0, 0.1]), [Warned, Failed]);
        assert_eq!(status([0.5, 0.3]), [Failed, Passed]);
    }
}
