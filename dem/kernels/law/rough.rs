//! Tangential law: spring of constant stiffness with pressure-dependent friction.
//!
//! μ(F) = μ + μₐ/(1 + F/(p R²)),
//!
//! F/R² is size-independent at equal stress.
//!
//! Sources: Barton & Kjærnsli, J. Geotech. Eng. Div. ASCE 107, 1981; contacts: Suhr & Six, Powder Technol.
//! 294, 2016; Comput. Part. Mech. 4, 2017.
//!
//! Theory manual: eq. (1.13), `docs/theory/contacts.md`.

use super::constants::constants;
use super::material::{LawName, Pair};
use super::normal::ConstantStiffness;
use super::spring::Spring;
use super::tangential::{SpringInput, SpringTransfer, TangentialLaw};
use crate::lanes::Real;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rough<R = f64> {
    stiffness: R,
    compliance: R,
    asperities: R,
    /// Normal force over effective radius squared at half of it [Pa].
    pressure: R,
}

constants!(Rough { stiffness, compliance, asperities, pressure });

/// Asperity friction [-] and half-value pressure [Pa]; `None` for constant friction.
pub(super) fn asperities(pair: &Pair<'_>, law: LawName) -> Option<(f64, f64)> {
    let of_its_own =
        pair.given(|e| e.friction).is_some() || pair.given(|e| e.tangential).is_some_and(|t| t != law);
    let added = pair.a.asperity_friction.min(pair.b.asperity_friction);
    let pressure = pair.a.asperity_pressure.min(pair.b.asperity_pressure);
    (!of_its_own && added > 0.0).then_some((added, pressure))
}

pub(super) const NAME: LawName = LawName("rough");

impl<N: ConstantStiffness> TangentialLaw<N> for Rough {
    const NAME: &'static str = NAME.0;
    const SOURCE: &'static str = "contact, tangential: pressure-dependent friction, after Suhr & Six, Powder Technol. 294, 2016, \
                                  and Barton & Kjaernsli, J. Geotech. Eng. Div. ASCE 107, 1981";
    const KEYS: &'static [&'static str] = &["tangential_ratio", "asperity_friction"];

    fn mix(pair: &Pair<'_>, normal: &N) -> Rough {
        let Spring { stiffness, compliance } = Spring::mix(pair, normal);
        let (asperities, pressure) = asperities(pair, NAME).unwrap_or((0.0, 1.0));
        Rough { stiffness, compliance, asperities, pressure }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &Rough<R>, _: R) -> SpringInput<R> {
        SpringInput { stiffness: law.stiffness, compliance: Some(law.compliance) }
    }

    #[inline(always)]
    fn limit<R: Real>(law: &Rough<R>, friction: R, normal: R, radius: R) -> R {
        let half = law.pressure * radius * radius;
        (friction + law.asperities * (half / (half + normal))) * normal
    }

    #[inline(always)]
    fn transfer_spring<R: Real>(_: &Rough<R>, _: R, _: R) -> Option<SpringTransfer<R>> {
        None
    }

    #[inline(always)]
    fn at_end<R: Real>(law: &Rough<R>) -> Option<R> {
        Some(law.stiffness)
    }

    #[inline(always)]
    fn stiffness(&self, _: f64) -> f64 {
        self.stiffness
    }
}
