//! Interface of normal laws.

use super::constants::Constants;
use super::material::Pair;
use super::restitution::restitution;
use crate::lanes::Real;

/// Response in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Response<R> {
    /// Spring force [N].
    pub elastic: R,
    /// Corrected dashpot coefficient [N s/m] (`half_step_damping.rs`), C for zero step.
    pub damping: R,
    /// Contact circle radius [m], by default √(R d).
    pub circle: R,
    /// Previous circle radius [m].
    pub circle_before: R,
    /// History number, if [`NormalLaw::REMEMBERS`].
    pub remembered: R,
    /// Energy of permanent deformation [J].
    pub lost: R,
}

/// Input in lanes.
#[derive(Clone, Copy, Debug)]
pub struct NormalInput<R: Real> {
    /// Inverse effective mass [1/kg].
    pub inverse_mass: R,
    /// Effective radius [m].
    pub radius: R,
    /// Overlap [m].
    pub overlap: R,
    /// Overlap rate, last half step [m/s].
    pub approach: R,
    /// History number unless `fresh`.
    pub remembered: R,
    /// Whether no force has acted yet.
    pub fresh: R::Mask,
    /// Time step [s].
    pub step: R,
}

impl<R: Real> NormalInput<R> {
    /// Returns the previous overlap [m].
    #[inline(always)]
    pub fn overlap_before(&self) -> R {
        (self.overlap - self.approach * self.step).max(R::zero())
    }
}

/// Expected contact conditions.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Largest body density [kg/m³].
    pub density: f64,
    /// Impact speed [m/s].
    pub speed: f64,
    /// Gravity [m/s²].
    pub gravity: f64,
    /// Packing height [m].
    pub height: f64,
}

/// Normal law: pair constants.
pub trait NormalLaw: Constants {
    /// Scene name.
    const NAME: &'static str;
    /// Source.
    const SOURCE: &'static str;
    /// Required material keys, the first also against a rigid partner.
    const KEYS: &'static [&'static str];
    /// Whether a dashpot defines the restitution.
    const DASHPOT: bool;
    /// Whether history is [`Response::remembered`] instead of the last half-step approach speed.
    const REMEMBERS: bool;
    /// Whether the dashpot force jumps at contact.
    const JUMPS: bool;
    /// Whether stiffness grows with the overlap.
    const STIFFENS: bool;

    /// Mixes two materials; `zeta`: damping ratio.
    fn mix(pair: &Pair<'_>, zeta: f64) -> Self;

    /// Returns force and dashpot.
    fn respond<R: Real>(law: &Self::Lanes<R>, touch: &NormalInput<R>) -> Response<R>;

    /// Returns spring force [N].
    fn force(&self, overlap: f64, radius: f64, remembered: f64) -> f64;

    /// Returns spring energy [J].
    fn stored(&self, overlap: f64, radius: f64, remembered: f64) -> f64;

    /// Returns force [N] and tangent stiffness [N/m] of first loading.
    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64);

    /// Returns the largest first-loading stiffness [N/m].
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// Returns the largest stiffness with history [N/m].
    fn stiffness_with(&self, overlap: f64, radius: f64, _remembered: f64) -> f64 {
        self.stiffness(overlap, radius)
    }

    /// Returns the contact circle radius [m].
    #[inline(always)]
    fn circle(&self, overlap: f64, radius: f64, _remembered: f64) -> f64 {
        (radius * overlap).sqrt()
    }

    /// Damping ratio ζ [-].
    fn damping_ratio(&self) -> f64;

    /// Energy loss 1 − e² of a collision [-].
    fn loss(&self) -> f64 {
        1.0 - restitution(self.damping_ratio()).powi(2)
    }

    /// Returns the largest expected overlap over radius; zero for constant stiffness.
    fn expected_overlap(&self, _: &Expected) -> f64 {
        0.0
    }
}

/// Normal law of constant first-loading stiffness.
pub trait ConstantStiffness: NormalLaw {
    /// First-loading stiffness [N/m].
    fn constant(&self) -> f64;
}
