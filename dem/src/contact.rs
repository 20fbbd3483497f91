//! Contact: detection yields a [`ContactGeometry`], a law turns it into a force; neither knows the other.

pub mod linear;
pub(crate) mod pass;
pub(crate) mod patches;
pub mod restitution;

use crate::Vec3;
use crate::material::{Material, PairOverride};
use serde::{Deserialize, Serialize};

/// Where and how two partners touch. "a" is the partner the force is computed for, "b" the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// The one point where the force acts on both [m].
    pub point: Vec3,
    /// Unit normal, from b to a.
    pub normal: Vec3,
    /// Overlap, positive in contact [m].
    pub overlap: f64,
    /// Effective radius 1/(1/R₁ + 1/R₂) [m].
    pub radius: f64,
}

/// Memory of one contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Tangential spring: displacement of a against b that still pulls back [m].
    pub spring: Vec3,
    /// Approach speed half a step before the last force [m/s]; [`FRESH`] before the first.
    pub rate: f64,
}

/// Marks a history without a contact (finite, so that every format can hold it).
pub const FRESH: f64 = f64::MAX;

impl History {
    /// Memory of a contact that has not begun.
    pub const NONE: History = History { spring: Vec3::new(0.0, 0.0, 0.0), rate: FRESH };

    /// Whether a contact goes on.
    #[inline(always)]
    pub fn is_fresh(&self) -> bool {
        self.rate == FRESH
    }
}

/// What a law answers for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// Force on a [N]; b takes the opposite.
    pub force: Vec3,
    /// Its normal part, pressure positive [N].
    pub normal: f64,
    /// Energy that dashpots took in this step [J].
    pub dashpot: f64,
    /// Energy that sliding took in this step [J].
    pub friction: f64,
}

/// A law of contact: constants of one pair of materials, and the force.
pub trait ContactLaw: Copy + Send + Sync {
    /// Mixes the constants of two materials.
    fn mix(a: &Material, b: &Material, exception: Option<&PairOverride>) -> Self;

    /// The force, given the effective mass m* = m₁m₂/(m₁ + m₂) of the bodies [kg], the velocity of a relative to b
    /// at the contact point half a step ago [m/s], and the step [s]. Advances the contact's memory.
    fn respond(
        &self,
        mass: f64,
        geometry: &ContactGeometry,
        velocity: &Vec3,
        history: &mut History,
        dt: f64,
    ) -> ContactForce;

    /// Energy stored in the normal and in the tangential spring [J].
    fn stored(&self, overlap: f64, radius: f64, spring: &Vec3) -> (f64, f64);

    /// Largest normal stiffness [N/m] at an overlap [m], for the time step.
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// Ends a contact: forgets it, and returns the energy left in the tangential spring [J].
    #[inline(always)]
    fn release(&self, history: &mut History) -> f64 {
        let left = self.stored(0.0, 1.0, &history.spring).1;
        *history = History::NONE;
        left
    }
}

/// The mixed constants of all pairs of materials.
#[derive(Clone, Debug)]
pub struct PairTable<L> {
    count: usize,
    pairs: Vec<L>,
}

impl<L: ContactLaw> PairTable<L> {
    /// Mixes every pair once. Of several exceptions for one pair the last holds.
    pub fn new(materials: &[Material], exceptions: &[PairOverride]) -> PairTable<L> {
        let mut pairs = Vec::with_capacity(materials.len() * materials.len());
        for (i, a) in materials.iter().enumerate() {
            for (j, b) in materials.iter().enumerate() {
                let exception = exceptions.iter().rfind(|e| (e.a, e.b) == (i, j) || (e.a, e.b) == (j, i));
                // In index order, so that (i, j) and (j, i) have the same bits.
                let (first, second) = if i <= j { (a, b) } else { (b, a) };
                pairs.push(L::mix(first, second, exception));
            }
        }
        PairTable { count: materials.len(), pairs }
    }

    /// Constants of materials `a` and `b`.
    #[inline(always)]
    pub fn get(&self, a: u32, b: u32) -> &L {
        &self.pairs[a as usize * self.count + b as usize]
    }
}
