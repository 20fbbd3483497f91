//! Tangential law: friction that falls with the pressure in the contact, as on rough rock, beside a spring of constant stiffness.
//!
//! Faces of broken stone slide over the asperities of each other where little presses them together, and shear these off where much
//! does: the friction angle of rough rock joints and of rockfill falls with the stress (Barton & Kjærnsli, J. Geotech. Eng. Div. ASCE
//! 107, 1981), and so does that of single contacts. Bulk friction of stones that falls with the stress needs an interparticle friction
//! that does (Suhr & Six, Powder Technol. 294, 2016; Comput. Part. Mech. 4, 2017). Here
//!
//! μ(F) = μ + μₐ/(1 + F/(p R²))
//!
//! with F the normal force and R the effective radius: μ is left where asperities are gone, μ + μₐ acts at vanishing force, and half
//! of μₐ is left at F = p R². Force over R² makes beds of stones of another size alike at the same stress. Fs = −Ks ξ − Cs vₜ as in
//! `spring.rs`, limited to μ(F) F.
//!
//! Mixing: the smaller μₐ, the smaller p. A pair with a friction of its own (`PairOverride::friction`) has that one alone.
//!
//! Limits: asperities do not wear, so what a contact has borne before does not count. The product μ(F) F grows with F throughout.
//!
//! Theory manual: equation (1.13) of `docs/theory/contacts.md`.

use super::constants::constants;
use super::material::{LawName, Pair};
use super::normal::ConstantStiffness;
use super::spring::Spring;
use super::tangential::{Carried, Grip, TangentialLaw};
use crate::lanes::Real;

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rough<R = f64> {
    stiffness: R,
    compliance: R,
    /// Friction that asperities add at vanishing force [-].
    asperities: R,
    /// Normal force over the square of the effective radius at which half of that is left [Pa].
    pressure: R,
}

constants!(Rough { stiffness, compliance, asperities, pressure });

/// Friction that asperities add between two materials at vanishing force [-], and the pressure at which half of it is left [Pa];
/// `None` where the pair has one coefficient. `law`: the tangential law that knows of them.
pub(super) fn asperities(pair: &Pair<'_>, law: LawName) -> Option<(f64, f64)> {
    let of_its_own =
        pair.given(|e| e.friction).is_some() || pair.given(|e| e.tangential).is_some_and(|t| t != law);
    let added = pair.a.asperity_friction.min(pair.b.asperity_friction);
    let pressure = pair.a.asperity_pressure.min(pair.b.asperity_pressure);
    (!of_its_own && added > 0.0).then_some((added, pressure))
}

/// Name in a scene.
pub(super) const NAME: LawName = LawName("rough");

impl<N: ConstantStiffness> TangentialLaw<N> for Rough {
    const NAME: &'static str = NAME.0;
    const SOURCE: &'static str = "contact, tangential: friction that falls with the pressure, after Suhr & Six, Powder Technol. 294, 2016, \
                                  and Barton & Kjaernsli, J. Geotech. Eng. Div. ASCE 107, 1981";
    const KEYS: &'static [&'static str] = &["tangential_ratio", "asperity_friction"];

    fn mix(pair: &Pair<'_>, normal: &N) -> Rough {
        let Spring { stiffness, compliance } = Spring::mix(pair, normal);
        let (asperities, pressure) = asperities(pair, NAME).unwrap_or((0.0, 1.0));
        Rough { stiffness, compliance, asperities, pressure }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &Rough<R>, _: R) -> Grip<R> {
        Grip { stiffness: law.stiffness, compliance: Some(law.compliance) }
    }

    #[inline(always)]
    fn limit<R: Real>(law: &Rough<R>, friction: R, normal: R, radius: R, _: R) -> R {
        let half = law.pressure * radius * radius;
        (friction + law.asperities * (half / (half + normal))) * normal
    }

    #[inline(always)]
    fn carry<R: Real>(_: &Rough<R>, _: R, _: R) -> Option<Carried<R>> {
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
