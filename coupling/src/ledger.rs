//! Energy of the whole system: grains, solid and interface in one account.
//!
//! Stored energy is a function of the state: kinetic energy of grains and solid, contact springs, strain, and the
//! potential of gravity on both. Work and dissipation are summed step by step. The account closes when
//!
//! Δ stored + dissipated − work done from outside = 0.
//!
//! What remains is the error of the run. One part of it is known by itself: the two sides of the interface compute
//! its work separately (grains with the predicted motion of the surface, solid with its own displacement), and their
//! sum should vanish.
//!
//! Theory manual: equations (5.13), (5.14), (5.15) of `docs/theory/coupling.md`.

use serde::{Deserialize, Serialize};

/// Energy stored in the system at one instant [J].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Stored {
    /// Kinetic energy of the grains, translation and rotation.
    pub grains_kinetic: f64,
    /// Normal and tangential contact springs.
    pub contact_springs: f64,
    /// Bonds between grains.
    #[serde(default)]
    pub bonds: f64,
    /// Springs of mounts of rigid bodies.
    #[serde(default)]
    pub mounts: f64,
    /// Potential of gravity on the grains.
    pub grains_gravity: f64,
    /// Kinetic energy of the solid.
    pub solid_kinetic: f64,
    /// Strain energy of the solid.
    pub solid_strain: f64,
    /// Potential of gravity on the solid.
    pub solid_gravity: f64,
    /// Rails, their pads, and the track beyond the model: motion, bending and springs.
    #[serde(default)]
    pub rail: f64,
}

impl Stored {
    /// The parts that springs and motion hold [J]; never below zero, but for gravity's.
    fn held(&self) -> f64 {
        let grains = self.grains_kinetic + self.contact_springs + self.bonds + self.mounts;
        grains + self.solid_kinetic + self.solid_strain + self.rail
    }

    /// Sum of the sizes of the changes of all parts since `start` [J].
    fn changes(&self, start: &Stored) -> f64 {
        let parts = |s: &Stored| {
            let grains = [s.grains_kinetic, s.contact_springs, s.bonds, s.mounts, s.grains_gravity];
            let rest = [s.solid_kinetic, s.solid_strain, s.solid_gravity, s.rail];
            grains.into_iter().chain(rest)
        };
        parts(self).zip(parts(start)).map(|(now, before)| (now - before).abs()).sum()
    }

    /// Sum of all parts [J].
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

/// Energy that has come in and gone since the start of the run [J].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spent {
    /// Work of applied loads on grains and sleeper, and of body forces on grains, gravity excepted.
    pub applied_work: f64,
    /// Work of moving walls, and of what holds motions fixed, on grains; and the energy that grains brought in through
    /// inlets less what they took out.
    pub wall_work: f64,
    /// Work of the loads on the solid other than contact and gravity.
    pub solid_load_work: f64,
    /// Dissipated by contact dashpots.
    pub dashpot: f64,
    /// The part of it by which those at the solid's surface took more than their law has for the motion they knew: they act on
    /// the velocity that the surface was said to have in a window, the solid answers with another. Below zero as a rule.
    #[serde(default)]
    pub dashpot_lag: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by the dashpots of bonds.
    #[serde(default)]
    pub bonds: f64,
    /// Dissipated by the dashpots of mounts of rigid bodies.
    #[serde(default)]
    pub mounts: f64,
    /// Set free by breaking bonds.
    #[serde(default)]
    pub breaks: f64,
    /// Dissipated by local damping of the grains.
    pub local_damping: f64,
    /// Dissipated by Rayleigh damping of the solid.
    pub rayleigh: f64,
    /// Taken up by the solid's absorbing boundaries.
    #[serde(default)]
    pub absorbed: f64,
    /// Dissipated by plastic flow of the solid.
    #[serde(default)]
    pub plastic: f64,
    /// Dissipated by the solid's time integration (zero for θ = ½).
    pub numerical: f64,
    /// Work that the surface did on the grains, as the grains saw it.
    pub surface_on_grains: f64,
    /// Work that the contacts did on the solid, as the solid saw it.
    pub contacts_on_solid: f64,
    /// Brought in by cycle jumps, which set grains elsewhere.
    #[serde(default)]
    pub jumps: f64,
    /// Work of wheels on rails, and of the rails' weight.
    #[serde(default)]
    pub wheels: f64,
    /// Work that the pads under rails did on sleepers, as the rails saw it; the sleepers see it as work of applied loads.
    #[serde(default)]
    pub pads_on_sleepers: f64,
    /// Dissipated in the pads on the modelled sleepers.
    #[serde(default)]
    pub pads: f64,
    /// Dissipated in the track beyond the model.
    #[serde(default)]
    pub track_beyond: f64,
}

impl Spent {
    /// Work done on the system from outside [J].
    pub fn work(&self) -> f64 {
        let outside = self.applied_work - self.pads_on_sleepers + self.wheels + self.wall_work;
        outside + self.solid_load_work + self.jumps
    }

    /// Energy dissipated [J].
    pub fn dissipated(&self) -> f64 {
        let grains =
            self.dashpot + self.friction + self.bonds + self.breaks + self.local_damping + self.mounts;
        let track = self.pads + self.track_beyond;
        grains + track + self.rayleigh + self.absorbed + self.plastic + self.numerical
    }

    /// Dissipated energies with their names [J]: each is zero or above but for the error of the run.
    pub fn losses(&self) -> [(&'static str, f64); 11] {
        [
            ("dashpots of contacts", self.dashpot - self.dashpot_lag.min(0.0)),
            ("friction", self.friction),
            ("dashpots of bonds", self.bonds),
            ("dashpots of mounts", self.mounts),
            ("local damping", self.local_damping),
            ("Rayleigh damping", self.rayleigh),
            ("absorbing boundaries", self.absorbed),
            ("plastic flow", self.plastic),
            ("time integration of the solid", self.numerical),
            ("dashpots under rails", self.pads),
            ("track outside the model", self.track_beyond),
        ]
    }

    /// Sum of the sizes of all works and losses [J].
    fn turned_over(&self) -> f64 {
        let works = [self.applied_work - self.pads_on_sleepers, self.wheels, self.wall_work];
        let rest = [self.solid_load_work, self.jumps, self.breaks];
        let losses = self.losses().into_iter().map(|(_, loss)| loss);
        works.into_iter().chain(rest).chain(losses).map(f64::abs).sum()
    }

    /// Interface work of both sides, which should cancel [J].
    pub fn interface(&self) -> f64 {
        self.surface_on_grains + self.contacts_on_solid
    }
}

/// The account of a run.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Balance {
    /// Stored energy at the start.
    pub start: Stored,
    /// Stored energy now.
    pub now: Stored,
    /// Work and dissipation since the start.
    pub spent: Spent,
    /// Energy below which an error means nothing, whatever has been turned over [J]: of the grains, see
    /// [`reference_energy`](trackbed_dem::measure::reference_energy).
    #[serde(default)]
    pub reference: f64,
}

impl Balance {
    /// Δ stored + dissipated − work [J]: zero in exact arithmetic with exact integration.
    pub fn error(&self) -> f64 {
        self.now.total() - self.start.total() + self.spent.dissipated() - self.spent.work()
    }

    /// What springs and motion hold now [J].
    pub fn held(&self) -> f64 {
        self.now.held()
    }

    /// The error with what a solid has gained in its time integration [J]: alone, it books there whatever does not close.
    pub fn unexplained(&self) -> f64 {
        self.error().abs() + (-self.spent.numerical).max(0.0)
    }

    /// Energy that has changed its form or come and gone since the start [J]: the larger of the sum of all works and losses
    /// and of the sum of all changes of stored energies, each by its size.
    pub fn turnover(&self) -> f64 {
        self.spent.turned_over().max(self.now.changes(&self.start))
    }

    /// Below this an error means nothing [J]: a thousandth of the energy in springs and motion, the rounding of
    /// the potential of gravity, whose zero is anywhere, or the reference energy.
    pub fn floor(&self) -> f64 {
        let gravity = |s: &Stored| s.grains_gravity.abs() + s.solid_gravity.abs();
        let held = 1e-3 * self.start.held().max(self.now.held());
        (held + 1e-9 * gravity(&self.start).max(gravity(&self.now))).max(self.reference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Losses below zero with no work, and energies that only change places, count as turned over.
    #[test]
    fn nothing_hides_behind_a_sum() {
        let spent = Spent { friction: -27e9, dashpot: 27e9, ..Spent::default() };
        let balance = Balance { spent, ..Balance::default() };
        assert_eq!((balance.error(), balance.turnover()), (0.0, 54e9));
        let start = Stored { contact_springs: 2.0, ..Stored::default() };
        let now = Stored { grains_kinetic: 3.0, ..Stored::default() };
        let balance = Balance { start, now, ..Balance::default() };
        assert_eq!((balance.error(), balance.turnover(), balance.floor()), (1.0, 5.0, 3e-3));
    }

    /// What one part gives to another is no work from outside, and every loss is counted once: each case closes to rounding, and
    /// the losses by name are all of what is dissipated, breaks apart.
    #[test]
    fn every_way_of_energy_closes() {
        let none = Spent::default;
        let cases: [(&str, Spent, f64); 13] = [
            ("pads on sleepers", Spent { applied_work: 1.0, pads_on_sleepers: 1.0, ..none() }, 0.0),
            ("applied loads", Spent { applied_work: 1.0, ..none() }, 1.0),
            ("walls", Spent { wall_work: 1.0, ..none() }, 1.0),
            ("wheels", Spent { wheels: 1.0, ..none() }, 1.0),
            ("loads on the solid", Spent { solid_load_work: 1.0, ..none() }, 1.0),
            ("jumps", Spent { jumps: 1.0, ..none() }, 1.0),
            ("dashpots", Spent { dashpot: 1.0, ..none() }, -1.0),
            ("friction", Spent { friction: 1.0, ..none() }, -1.0),
            ("Rayleigh damping", Spent { rayleigh: 1.0, ..none() }, -1.0),
            ("absorbing boundaries", Spent { absorbed: 1.0, ..none() }, -1.0),
            ("plastic flow", Spent { plastic: 1.0, ..none() }, -1.0),
            ("pads", Spent { pads: 1.0, ..none() }, -1.0),
            ("track outside the model", Spent { track_beyond: 1.0, ..none() }, -1.0),
        ];
        for (name, spent, gain) in cases {
            let start = Stored { solid_strain: 5.0, ..Stored::default() };
            let now = Stored { solid_strain: 5.0 + gain, ..Stored::default() };
            assert_eq!(Balance { start, now, spent, ..Balance::default() }.error(), 0.0, "{name}");
            let named: f64 = spent.losses().into_iter().map(|(_, loss)| loss).sum();
            assert_eq!(named, spent.dissipated(), "{name}");
        }
    }

    /// Dashpots at the surface that act on a velocity which the solid does not have may take less than nothing: what they lag
    /// behind is no gain of theirs. What they take too much is theirs.
    #[test]
    fn the_lag_of_dashpots_is_no_gain_of_theirs() {
        let dashpots =
            |dashpot, dashpot_lag| Spent { dashpot, dashpot_lag, ..Spent::default() }.losses()[0].1;
        assert_eq!((dashpots(-2.0, -3.0), dashpots(5.0, 3.0)), (1.0, 5.0));
    }
}
