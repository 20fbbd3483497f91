//! Normal law: linear loading and stiffer unloading, which leaves a deformation behind (Walton & Braun).
//!
//! With d the overlap and D the largest one so far: F = k₁ d while d = D grows; below it F = max(0, k₁ D − k₂ (D − d)), down to
//! the residual overlap (1 − k₁/k₂) D, where the force ends, and back up the same line. k₁ = K of the linear law; k₂ = k₁/e².
//!
//! Restitution. Loading takes up F²/(2 k₁), unloading gives back F²/(2 k₂): e = √(k₁/k₂) at any speed, without a dashpot.
//! The difference is plastic work, ½ k₁ (1 − k₁/k₂) D² in all, and is booked as D grows.
//!
//! D is the number that the contact remembers; it is forgotten when the partners part. Source: Walton & Braun, J. Rheol.
//! 30, 949 (1986), with their constant ratio of stiffnesses; beside it the spring of `spring.rs` with Ks = α k₁.
//!
//! Limits: overlaps small against the radii; no dashpot, also none beside the tangential spring.
//!
//! Theory manual: equation (1.9) of `docs/theory/contacts.md`.

use super::constants::constants;
use super::contact::FRESH;
use super::material::Pair;
use super::normal::{ConstantStiffness, NormalLaw, Response, Touch};
use crate::lanes::Real;

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaltonBraun<R = f64> {
    /// Stiffness of first loading k₁ [N/m].
    pub loading: R,
    /// Stiffness of unloading and reloading k₂ [N/m].
    pub unloading: R,
    /// Plastic work over the largest overlap squared, ½ k₁ (1 − k₁/k₂) [N/m].
    plastic: R,
}

constants!(WaltonBraun { loading, unloading, plastic });

impl NormalLaw for WaltonBraun {
    const NAME: &'static str = "walton_braun";
    const SOURCE: &'static str =
        "contact: linear loading, stiffer unloading, Walton & Braun, J. Rheol. 30, 949, 1986";
    const KEYS: &'static [&'static str] = &["stiffness"];
    const DASHPOT: bool = false;
    const REMEMBERS: bool = true;
    const JUMPS: bool = false;
    const STIFFENS: bool = false;

    fn mix(pair: &Pair<'_>, _: f64) -> WaltonBraun {
        let (loading, e) = (pair.stiffness(), pair.restitution());
        WaltonBraun { loading, unloading: loading / (e * e), plastic: 0.5 * loading * (1.0 - e * e) }
    }

    #[inline(always)]
    fn respond<R: Real>(law: &WaltonBraun<R>, touch: &Touch<R>) -> Response<R> {
        let overlap = touch.overlap;
        let before = R::select(touch.fresh, R::zero(), touch.remembered);
        let most = before.max(overlap);
        let elastic = (law.loading * most - law.unloading * (most - overlap)).max(R::zero());
        let circle = (touch.radius * overlap).sqrt();
        Response {
            elastic,
            damping: R::zero(),
            circle,
            circle_before: circle,
            remembered: most,
            lost: law.plastic * (most * most - before * before),
        }
    }

    #[inline(always)]
    fn force(&self, overlap: f64, _: f64, remembered: f64) -> f64 {
        let before = if remembered == FRESH { 0.0 } else { remembered };
        let most = before.max(overlap);
        (self.loading * most - self.unloading * (most - overlap)).max(0.0)
    }

    fn stored(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        0.5 * self.force(overlap, radius, remembered).powi(2) / self.unloading
    }

    fn loading(&self, overlap: f64, _: f64) -> (f64, f64) {
        (self.loading * overlap, self.loading)
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.unloading
    }

    fn damping_ratio(&self) -> f64 {
        0.0
    }

    fn loss(&self) -> f64 {
        1.0 - self.loading / self.unloading
    }
}

impl ConstantStiffness for WaltonBraun {
    fn constant(&self) -> f64 {
        self.loading
    }
}
