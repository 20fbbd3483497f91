//! Tangential law: spring of constant stiffness.
//!
//! K is the first-loading normal stiffness. Source: Cundall & Strack, Géotechnique 29 (1979).
//!
//! Theory manual: eq. (1.6), `docs/theory/contacts.md`.

use super::constants::constants;
use super::material::{LawName, Pair, harmonic};
use super::normal::ConstantStiffness;
use super::tangential::{SpringInput, SpringTransfer, TangentialLaw};
use crate::lanes::Real;

pub(super) const SOURCE: &str =
    "contact: linear spring-dashpot with Coulomb friction, Cundall & Strack, Geotechnique 29(1), 1979";

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring<R = f64> {
    /// Stiffness Ks [N/m].
    pub stiffness: R,
    /// 1/Ks [m/N].
    pub(super) compliance: R,
}

constants!(Spring { stiffness, compliance });

impl<N: ConstantStiffness> TangentialLaw<N> for Spring {
    const NAME: &'static str = "linear";
    const SOURCE: &'static str = SOURCE;
    const KEYS: &'static [&'static str] = &["tangential_ratio"];

    fn mix(pair: &Pair<'_>, normal: &N) -> Spring {
        let ratio = harmonic(pair.a.tangential_ratio, pair.b.tangential_ratio);
        let none = pair.given(|e| e.tangential) == Some(LawName::NONE);
        let stiffness = if none { 0.0 } else { normal.constant() * ratio };
        Spring { stiffness, compliance: 1.0 / stiffness }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &Spring<R>, _: R) -> SpringInput<R> {
        SpringInput { stiffness: law.stiffness, compliance: Some(law.compliance) }
    }

    #[inline(always)]
    fn transfer_spring<R: Real>(_: &Spring<R>, _: R, _: R) -> Option<SpringTransfer<R>> {
        None
    }

    #[inline(always)]
    fn at_end<R: Real>(law: &Spring<R>) -> Option<R> {
        Some(law.stiffness)
    }

    #[inline(always)]
    fn stiffness(&self, _: f64) -> f64 {
        self.stiffness
    }
}
