//! The normal part of a law: an elastic force, or one that keeps a deformation, and the dashpot beside it.

use super::constants::Constants;
use super::material::Pair;
use super::restitution::restitution;
use crate::lanes::Real;

/// What a normal law makes of contacts, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Response<R> {
    /// Force of the spring [N].
    pub elastic: R,
    /// Coefficient of the dashpot that acts in a step of the given length [N s/m] (`lag.rs`): C itself in one of none;
    /// without meaning where the law has no dashpot.
    pub damping: R,
    /// Radius of the contact circle [m], √(R d) unless the law says otherwise, and what it was a step before. Who does not use them does not
    /// pay for them: the roots are then left out.
    pub circle: R,
    /// See there [m].
    pub circle_before: R,
    /// The number to remember; without meaning where the law does not [remember](NormalLaw::REMEMBERS).
    pub remembered: R,
    /// Energy that deformation took for good in this step [J]; likewise.
    pub lost: R,
}

/// Contacts as a normal law sees them, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Touch<R: Real> {
    /// Sum of the inverse masses of the two bodies [1/kg].
    pub inverse_mass: R,
    /// Effective radius [m].
    pub radius: R,
    /// Overlap [m].
    pub overlap: R,
    /// Its rate half a step ago [m/s].
    pub approach: R,
    /// The number of the memory, without meaning where `fresh`.
    pub remembered: R,
    /// Whether there has been no force yet.
    pub fresh: R::Mask,
    /// Time step [s].
    pub step: R,
}

impl<R: Real> Touch<R> {
    /// Overlap a step before [m].
    #[inline(always)]
    pub fn overlap_before(&self) -> R {
        (self.overlap - self.approach * self.step).max(R::zero())
    }
}

/// What a model expects of its contacts, for stiffnesses that grow with the overlap.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Largest density of the bodies [kg/m³].
    pub density: f64,
    /// Speed at which they meet [m/s].
    pub speed: f64,
    /// Magnitude of gravity [m/s²].
    pub gravity: f64,
    /// Height of all bodies [m].
    pub height: f64,
}

/// A normal law: constants of one pair of materials.
pub trait NormalLaw: Constants {
    /// Name in a scene.
    const NAME: &'static str;
    /// Where it is published.
    const SOURCE: &'static str;
    /// Keys of a material that it needs, the first also when the partner is rigid.
    const KEYS: &'static [&'static str];
    /// Whether it has a dashpot, which gives the restitution.
    const DASHPOT: bool;
    /// Whether the number of its memory is the law's own, [`Response::remembered`]; else it is the approach speed half a step before.
    const REMEMBERS: bool;
    /// Whether the dashpot's force jumps at first touch, so that its first one counts for a part of the step.
    const JUMPS: bool;
    /// Whether the stiffness grows with the overlap, so that the limit of the step needs the overlap expected.
    const STIFFENS: bool;

    /// Mixes the constants of two materials; `zeta` is the damping ratio of the pair.
    fn mix(pair: &Pair<'_>, zeta: f64) -> Self;

    /// Force and dashpot of contacts in a step.
    fn respond<R: Real>(law: &Self::Lanes<R>, touch: &Touch<R>) -> Response<R>;

    /// Force of the spring [N], with the number of its memory.
    fn force(&self, overlap: f64, radius: f64, remembered: f64) -> f64;

    /// Energy stored in the spring [J], with the number of its memory.
    fn stored(&self, overlap: f64, radius: f64, remembered: f64) -> f64;

    /// Force of the spring on first loading [N] and its tangent stiffness [N/m].
    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64);

    /// Largest stiffness [N/m] at an overlap [m] on first loading.
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// Largest stiffness [N/m] at an overlap [m], with the number of its memory.
    fn stiffness_with(&self, overlap: f64, radius: f64, _remembered: f64) -> f64 {
        self.stiffness(overlap, radius)
    }

    /// Radius of the contact circle [m], with the number of its memory.
    #[inline(always)]
    fn circle(&self, overlap: f64, radius: f64, _remembered: f64) -> f64 {
        (radius * overlap).sqrt()
    }

    /// Damping ratio ζ [-].
    fn damping_ratio(&self) -> f64;

    /// Share 1 − e² of its energy that a collision takes [-].
    fn loss(&self) -> f64 {
        1.0 - restitution(self.damping_ratio()).powi(2)
    }

    /// Largest overlap expected, over the effective radius; zero where the stiffness does not depend on it.
    fn expected_overlap(&self, _: &Expected) -> f64 {
        0.0
    }
}

/// A normal law whose stiffness on first loading does not depend on the overlap.
pub trait ConstantStiffness: NormalLaw {
    /// That stiffness [N/m].
    fn constant(&self) -> f64;
}
