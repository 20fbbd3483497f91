//! Normal law: linear loading, stiffer unloading, permanent deformation (Walton & Braun).
//!
//! Plastic work is counted as the largest overlap D grows. Separation resets D.
//!
//! Source: Walton & Braun, J. Rheol. 30, 949 (1986), constant stiffness ratio.
//!
//! Theory manual: eq. (1.9), `docs/theory/contacts.md`.

use super::constants::constants;
use super::contact::NO_CONTACT;
use super::material::Pair;
use super::normal::{ConstantStiffness, NormalInput, NormalLaw, Response};
use crate::lanes::Real;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaltonBraun<R = f64> {
    /// Loading stiffness k₁ [N/m].
    pub loading: R,
    /// Unloading stiffness k₂ [N/m].
    pub unloading: R,
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
    fn respond<R: Real>(law: &WaltonBraun<R>, touch: &NormalInput<R>) -> Response<R> {
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
        let before = if remembered == NO_CONTACT { 0.0 } else { remembered };
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
