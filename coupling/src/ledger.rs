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
    /// Sum of all parts [J].
    pub fn total(&self) -> f64 {
        self.grains_kinetic
            + self.contact_springs
            + self.bonds
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
    /// Work of applied loads on grains and sleeper.
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
        let grains = self.dashpot + self.friction + self.bonds + self.breaks + self.local_damping;
        let track = self.pads + self.track_beyond;
        grains + track + self.rayleigh + self.absorbed + self.plastic + self.numerical
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
}

impl Balance {
    /// Δ stored + dissipated − work [J]: zero in exact arithmetic with exact integration.
    pub fn error(&self) -> f64 {
        self.now.total() - self.start.total() + self.spent.dissipated() - self.spent.work()
    }
}
