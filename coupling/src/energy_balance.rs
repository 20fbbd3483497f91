//! Energy balance of grains, solid and interface. Theory manual: eqs. (5.13), (5.14), (5.15).

use serde::{Deserialize, Serialize};

/// Stored energy [J].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct StoredEnergy {
    /// Kinetic energy of the grains, with rotation.
    pub grains_kinetic: f64,
    /// Contact springs.
    pub contact_springs: f64,
    /// Bonds.
    #[serde(default)]
    pub bonds: f64,
    /// Supports of rigid bodies.
    #[serde(default)]
    pub mounts: f64,
    /// Gravity potential of the grains.
    pub grains_gravity: f64,
    /// Kinetic energy of the solid.
    pub solid_kinetic: f64,
    /// Strain energy.
    pub solid_strain: f64,
    /// Gravity potential of the solid.
    pub solid_gravity: f64,
    /// Rails, pads and track outside the model.
    #[serde(default)]
    pub rail: f64,
}

impl StoredEnergy {
    fn kinetic_and_spring_energy(&self) -> f64 {
        let grains = self.grains_kinetic + self.contact_springs + self.bonds + self.mounts;
        grains + self.solid_kinetic + self.solid_strain + self.rail
    }

    fn sum_of_changes(&self, start: &StoredEnergy) -> f64 {
        let parts = |s: &StoredEnergy| {
            let grains = [s.grains_kinetic, s.contact_springs, s.bonds, s.mounts, s.grains_gravity];
            let rest = [s.solid_kinetic, s.solid_strain, s.solid_gravity, s.rail];
            grains.into_iter().chain(rest)
        };
        parts(self).zip(parts(start)).map(|(now, before)| (now - before).abs()).sum()
    }

    /// Total stored energy [J].
    pub fn total(&self) -> f64 {
        self.grains_kinetic
            + self.contact_springs
            + self.bonds
            + self.mounts
            + self.grains_gravity
            + self.solid_kinetic
            + self.solid_strain
            + self.solid_gravity
            + self.rail
    }
}

/// Work and dissipation since the start [J].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct WorkAndDissipation {
    /// Applied loads on grains and sleeper, body forces on grains except gravity.
    pub applied_work: f64,
    /// Moving walls and prescribed motion on grains; inlets less outlets.
    pub wall_work: f64,
    /// Loads on the solid except contact and gravity.
    pub solid_load_work: f64,
    /// Contact dashpots.
    pub dashpot: f64,
    /// Interface dashpot error: surface dashpots at the predicted velocity minus the law.
    #[serde(default)]
    pub interface_dashpot_error: f64,
    /// Friction.
    pub friction: f64,
    /// Bond dashpots.
    #[serde(default)]
    pub bonds: f64,
    /// Support dashpots of rigid bodies.
    #[serde(default)]
    pub mounts: f64,
    /// Bond breakage.
    #[serde(default)]
    pub breaks: f64,
    /// Local damping of the grains.
    pub local_damping: f64,
    /// Rayleigh damping.
    pub rayleigh: f64,
    /// Absorbing boundaries.
    #[serde(default)]
    pub absorbed: f64,
    /// Plastic flow.
    #[serde(default)]
    pub plastic: f64,
    /// Numerical dissipation of the solid (zero for θ = ½).
    pub numerical: f64,
    /// Work of the surface on the grains, from the DEM.
    pub surface_on_grains: f64,
    /// Work of the contacts on the solid, from the FEM.
    pub contacts_on_solid: f64,
    /// Cycle jumps, which displace grains.
    #[serde(default)]
    pub jumps: f64,
    /// Wheels and rail weight.
    #[serde(default)]
    pub wheels: f64,
    /// Work of rail pads on sleepers, which count it as applied loads.
    #[serde(default)]
    pub pads_on_sleepers: f64,
    /// Pads on modelled sleepers.
    #[serde(default)]
    pub pads: f64,
    /// Track outside the model.
    #[serde(default)]
    pub far_field_track: f64,
}

impl WorkAndDissipation {
    /// External work [J].
    pub fn work(&self) -> f64 {
        let outside = self.applied_work - self.pads_on_sleepers + self.wheels + self.wall_work;
        outside + self.solid_load_work + self.jumps
    }

    /// Dissipated energy [J].
    pub fn dissipated(&self) -> f64 {
        let grains =
            self.dashpot + self.friction + self.bonds + self.breaks + self.local_damping + self.mounts;
        let track = self.pads + self.far_field_track;
        grains + track + self.rayleigh + self.absorbed + self.plastic + self.numerical
    }

    /// Named dissipations [J], non-negative except for numerical error.
    pub fn dissipation_terms(&self) -> [(&'static str, f64); 11] {
        [
            ("dashpots of contacts", self.dashpot - self.interface_dashpot_error.min(0.0)),
            ("friction", self.friction),
            ("dashpots of bonds", self.bonds),
            ("dashpots of mounts", self.mounts),
            ("local damping", self.local_damping),
            ("Rayleigh damping", self.rayleigh),
            ("absorbing boundaries", self.absorbed),
            ("plastic flow", self.plastic),
            ("time integration of the solid", self.numerical),
            ("dashpots under rails", self.pads),
            ("track outside the model", self.far_field_track),
        ]
    }

    /// Sum of absolute works and dissipations [J].
    fn sum_of_magnitudes(&self) -> f64 {
        let works = [self.applied_work - self.pads_on_sleepers, self.wheels, self.wall_work];
        let rest = [self.solid_load_work, self.jumps, self.breaks];
        let dissipation_terms = self.dissipation_terms().into_iter().map(|(_, loss)| loss);
        works.into_iter().chain(rest).chain(dissipation_terms).map(f64::abs).sum()
    }

    /// Interface work error [J].
    pub fn interface(&self) -> f64 {
        self.surface_on_grains + self.contacts_on_solid
    }
}

/// Energy balance of a run.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// Stored energy at the start.
    pub start: StoredEnergy,
    /// Current stored energy.
    pub now: StoredEnergy,
    /// Work and dissipation since the start.
    pub spent: WorkAndDissipation,
    /// Smallest reference energy [J], from [`reference_energy`](trackbed_dem::measure::reference_energy).
    #[serde(default)]
    pub reference: f64,
}

impl EnergyBalance {
    /// Energy error [J].
    pub fn error(&self) -> f64 {
        self.now.total() - self.start.total() + self.spent.dissipated() - self.spent.work()
    }

    /// Current kinetic and spring energy [J].
    pub fn kinetic_and_spring_energy(&self) -> f64 {
        self.now.kinetic_and_spring_energy()
    }

    /// Energy error plus numerical gain of the solid [J].
    pub fn error_with_numerical_gain(&self) -> f64 {
        self.error().abs() + (-self.spent.numerical).max(0.0)
    }

    /// Reference energy [J]: the larger of Σ |work| + Σ |dissipation| and Σ |Δ stored energy|.
    pub fn reference_energy(&self) -> f64 {
        self.spent.sum_of_magnitudes().max(self.now.sum_of_changes(&self.start))
    }

    /// Limit of insignificant errors [J]: 1e-3 of kinetic and spring energy, rounding of gravity, or the
    /// smallest reference.
    pub fn negligible_energy(&self) -> f64 {
        let gravity = |s: &StoredEnergy| s.grains_gravity.abs() + s.solid_gravity.abs();
        let held = 1e-3 * self.start.kinetic_and_spring_energy().max(self.now.kinetic_and_spring_energy());
        (held + 1e-9 * gravity(&self.start).max(gravity(&self.now))).max(self.reference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_hides_behind_a_sum() {
        let spent = WorkAndDissipation { friction: -27e9, dashpot: 27e9, ..WorkAndDissipation::default() };
        let balance = EnergyBalance { spent, ..EnergyBalance::default() };
        assert_eq!((balance.error(), balance.reference_energy()), (0.0, 54e9));
        let start = StoredEnergy { contact_springs: 2.0, ..StoredEnergy::default() };
        let now = StoredEnergy { grains_kinetic: 3.0, ..StoredEnergy::default() };
        let balance = EnergyBalance { start, now, ..EnergyBalance::default() };
        assert_eq!(
            (balance.error(), balance.reference_energy(), balance.negligible_energy()),
            (1.0, 5.0, 3e-3)
        );
    }

    #[test]
    fn every_way_of_energy_closes() {
        let none = WorkAndDissipation::default;
        let cases: [(&str, WorkAndDissipation, f64); 13] = [
            (
                "pads on sleepers",
                WorkAndDissipation { applied_work: 1.0, pads_on_sleepers: 1.0, ..none() },
                0.0,
            ),
            ("applied loads", WorkAndDissipation { applied_work: 1.0, ..none() }, 1.0),
            ("walls", WorkAndDissipation { wall_work: 1.0, ..none() }, 1.0),
            ("wheels", WorkAndDissipation { wheels: 1.0, ..none() }, 1.0),
            ("loads on the solid", WorkAndDissipation { solid_load_work: 1.0, ..none() }, 1.0),
            ("jumps", WorkAndDissipation { jumps: 1.0, ..none() }, 1.0),
            ("dashpots", WorkAndDissipation { dashpot: 1.0, ..none() }, -1.0),
            ("friction", WorkAndDissipation { friction: 1.0, ..none() }, -1.0),
            ("Rayleigh damping", WorkAndDissipation { rayleigh: 1.0, ..none() }, -1.0),
            ("absorbing boundaries", WorkAndDissipation { absorbed: 1.0, ..none() }, -1.0),
            ("plastic flow", WorkAndDissipation { plastic: 1.0, ..none() }, -1.0),
            ("pads", WorkAndDissipation { pads: 1.0, ..none() }, -1.0),
            ("track outside the model", WorkAndDissipation { far_field_track: 1.0, ..none() }, -1.0),
        ];
        for (name, spent, gain) in cases {
            let start = StoredEnergy { solid_strain: 5.0, ..StoredEnergy::default() };
            let now = StoredEnergy { solid_strain: 5.0 + gain, ..StoredEnergy::default() };
            assert_eq!(
                EnergyBalance { start, now, spent, ..EnergyBalance::default() }.error(),
                0.0,
                "{name}"
            );
            let named: f64 = spent.dissipation_terms().into_iter().map(|(_, loss)| loss).sum();
            assert_eq!(named, spent.dissipated(), "{name}");
        }
    }

    #[test]
    fn dashpot_term_excludes_negative_interface_error() {
        let dashpots = |dashpot, interface_dashpot_error| {
            WorkAndDissipation { dashpot, interface_dashpot_error, ..WorkAndDissipation::default() }
                .dissipation_terms()[0]
                .1
        };
        assert_eq!((dashpots(-2.0, -3.0), dashpots(5.0, 3.0)), (1.0, 5.0));
    }
}
