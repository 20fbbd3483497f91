//! What body forces see, and what they add to.

use super::skin::Skin;
use crate::base::Vec3;
use crate::base::held::held;
use crate::base::ledger::Ledger;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::sums::Sums;
use crate::bodies::table::Bodies;
use crate::lanes::Simd;
use crate::lanes::record::xyz;
use crate::law::scarring::Scar;

/// What a body force sees of the bodies of a block.
pub(crate) struct Seen<'a> {
    pub simd: Simd,
    pub block: &'a Block,
    pub members: &'a Members,
    pub bodies: &'a Bodies,
    /// Surfaces of the shapes, where a body force asks for them.
    pub skins: &'a [Skin],
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Sums of the forces of contacts and bonds.
    pub sums: &'a [Sums],
    /// Time of the places [s].
    pub time: f64,
    /// Length of the kick [s].
    pub kick: f64,
    /// What each body does to ground that is scarred, by number; empty where no ground is.
    pub scars: &'a [Scar],
}

/// A body force: adds its forces [N] on the bodies of a block, at their centres, and the torques about them [N m].
pub(crate) trait Act {
    fn act(&self, seen: &Seen<'_>, work: &mut ForceWork);
}

/// Scratch of a block: empty in models without body forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForceWork {
    /// Radii of spheres of the bodies' volumes [m], in block order.
    pub(super) radius: Vec<f64>,
    /// Force and torque on each body in the step at hand.
    pub(super) acting: Vec<Sums>,
    /// Mass of fluid that each body takes along [kg]; empty where none does.
    pub(super) added: Vec<f64>,
    /// Heights of the points of one body.
    pub(super) heights: Vec<f64>,
    /// Their power before the kick [W].
    pub(super) power: f64,
}

impl ForceWork {
    /// Lays itself out for bodies in the order of their block, given the volume of a body [m³] by number.
    pub fn arrange(&mut self, block: &Block, volume: impl Fn(usize) -> f64) {
        let radius = |v: f64| libm::cbrt(v * 0.75 / std::f64::consts::PI);
        self.radius.clear();
        self.radius.extend(block.bodies.iter().map(|&b| radius(volume(b as usize))));
    }

    /// Adds the forces to all others.
    pub fn add_to(&self, sums: &mut [Sums]) {
        for (sum, own) in sums.iter_mut().zip(&self.acting) {
            sum.push(&xyz(own.force()), &xyz(own.torque()));
        }
    }

    /// Lets a body take a mass of fluid along [kg].
    pub(super) fn add_mass(&mut self, k: usize, mass: f64) {
        if self.added.is_empty() {
            self.added.resize(self.acting.len(), 0.0);
        }
        self.added[k] += mass;
    }

    /// Books the work of the forces of this step, after the bodies have moved.
    pub fn book(&self, block: &Block, ledger: &mut Ledger, kick: f64) {
        ledger.work_body_forces += 0.5 * (self.power + self.power_on(block)) * kick;
    }

    /// Power with the velocities of the block as they are [W].
    pub(super) fn power_on(&self, block: &Block) -> f64 {
        let of = |(k, own): (usize, &Sums)| {
            let (v, w): (Vec3, Vec3) = (xyz(&block.velocity[k]), xyz(&block.spin[k]));
            xyz(own.force()).dot(&v) + xyz(own.torque()).dot(&w)
        };
        self.acting.iter().enumerate().map(of).sum()
    }

    /// Bytes held between steps.
    pub fn bytes(&self) -> usize {
        held(&self.radius) + held(&self.acting) + held(&self.added)
    }
}
