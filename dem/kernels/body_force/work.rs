//! Input and scratch of body forces.

use super::skin::Skin;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::capacity::capacity_bytes;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::ForceTorque;
use crate::bodies::table::Bodies;
use crate::lanes::Simd;
use crate::lanes::vec4::xyz;
use crate::law::scarring::Scar;

pub struct ForceInput<'a> {
    pub simd: Simd,
    pub block: &'a Block,
    pub members: &'a BlockBodies,
    pub bodies: &'a Bodies,
    /// Surfaces of the shapes, if needed.
    pub skins: &'a [Skin],
    /// Gravity [m/s²].
    pub gravity: Vec3,
    pub sums: &'a [ForceTorque],
    /// Time of the positions [s].
    pub time: f64,
    /// Length of the kick [s].
    pub kick: f64,
    /// Empty without scarring.
    pub scars: &'a [Scar],
}

/// Adds forces [N] and torques about the centres [N m].
pub trait BodyForceModel {
    fn act(&self, seen: &ForceInput<'_>, work: &mut ForceWork);
}

/// Scratch of a block; empty without body forces.
#[derive(Clone, Debug, Default)]
pub struct ForceWork {
    /// Volume-equivalent radii [m], in block order.
    pub(super) radius: Vec<f64>,
    /// In this step.
    pub(super) acting: Vec<ForceTorque>,
    /// Added mass of each body [kg]; may be empty.
    pub(super) added: Vec<f64>,
    pub(super) heights: Vec<f64>,
    /// Power before the kick [W].
    pub(super) power: f64,
}

impl ForceWork {
    /// Block order; `volume` by body index [m³].
    pub fn arrange(&mut self, block: &Block, volume: impl Fn(usize) -> f64) {
        let radius = |v: f64| libm::cbrt(v * 0.75 / std::f64::consts::PI);
        self.radius.clear();
        self.radius.extend(block.bodies.iter().map(|&b| radius(volume(b as usize))));
    }

    pub fn add_to(&self, sums: &mut [ForceTorque]) {
        for (sum, own) in sums.iter_mut().zip(&self.acting) {
            sum.push(&xyz(own.force()), &xyz(own.torque()));
        }
    }

    pub(super) fn add_mass(&mut self, k: usize, mass: f64) {
        if self.added.is_empty() {
            self.added.resize(self.acting.len(), 0.0);
        }
        self.added[k] += mass;
    }

    /// Records work, after the motion.
    pub fn add_work(&self, block: &Block, balance: &mut BalanceTerms, kick: f64) {
        balance.work_body_forces += 0.5 * (self.power + self.power_on(block)) * kick;
    }

    /// Present power [W].
    pub(super) fn power_on(&self, block: &Block) -> f64 {
        let of = |(k, own): (usize, &ForceTorque)| {
            let (v, w): (Vec3, Vec3) = (xyz(&block.velocity[k]), xyz(&block.spin[k]));
            xyz(own.force()).dot(&v) + xyz(own.torque()).dot(&w)
        };
        self.acting.iter().enumerate().map(of).sum()
    }

    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.radius) + capacity_bytes(&self.acting) + capacity_bytes(&self.added)
    }
}
