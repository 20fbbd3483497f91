//! Tangential law: Mindlin's stiffness of the contact circle, rescaled as the overlap changes.
//!
//! With a = √(R d) the radius of the contact circle and 1/G* = (2 − ν₁)/G₁ + (2 − ν₂)/G₂, G = E/(2(1 + ν)): a spring of
//! stiffness 8 G* a (Mindlin 1949), turned, damped, limited and shortened as any (`slide.rs`).
//!
//! The stiffness changes with a. While the overlap grows the force is kept, so the spring is shortened by a₀/a; while it
//! falls the spring's length is kept, so the force falls as a does (the rule of Elata & Berryman, Mech. Mater. 24, 1996: a
//! force kept on unloading would create energy). The energy of the spring falls in both cases and is booked as friction:
//! in the real contact it goes into slip near the rim. Rolling and twisting springs have the same stiffness and follow the
//! same rule. The circle before is that of the overlap d − ḋ dt.
//!
//! Limits: the partial slip near the rim under oscillating tangential force (Mindlin & Deresiewicz 1953) only as the rule
//! above has it.
//!
//! Theory manual: equations (1.2), (1.8) of `docs/theory/contacts.md`.

use super::constants::constants;
use super::hertz::Hertz;
use super::material::{LawName, Material, Pair};
use super::tangential::{Carried, Grip, TangentialLaw};
use crate::lanes::Real;

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mindlin<R = f64> {
    /// Effective shear modulus G* [Pa].
    pub shear: R,
}

constants!(Mindlin { shear });

/// Effective shear modulus G* of two materials [Pa], of which one without a modulus is rigid; zero where the pair has no tangential force.
pub(super) fn shear(pair: &Pair<'_>) -> f64 {
    if pair.given(|e| e.tangential) == Some(LawName::NONE) {
        return 0.0;
    }
    let soft = |m: &Material| m.young.map_or(0.0, |e| (2.0 - m.poisson) * 2.0 * (1.0 + m.poisson) / e);
    1.0 / (soft(pair.a) + soft(pair.b))
}

impl TangentialLaw<Hertz> for Mindlin {
    const NAME: &'static str = "mindlin";
    const SOURCE: &'static str =
        "contact, tangential: Mindlin, J. Appl. Mech. 16, 1949; Elata & Berryman, Mech. Mater. 24, 1996";
    const KEYS: &'static [&'static str] = &["young", "poisson"];

    fn mix(pair: &Pair<'_>, _: &Hertz) -> Mindlin {
        Mindlin { shear: shear(pair) }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &Mindlin<R>, circle: R) -> Grip<R> {
        Grip { stiffness: R::splat(8.0) * law.shear * circle, compliance: None }
    }

    #[inline(always)]
    fn carry<R: Real>(law: &Mindlin<R>, circle: R, before: R) -> Option<Carried<R>> {
        let kept = (before / circle).min(R::splat(1.0));
        let loss = R::splat(4.0) * law.shear * (before - circle * kept * kept);
        Some(Carried { kept, loss })
    }

    /// Stiffness and energy have gone to zero with the overlap, booked on the way but for the last step's.
    #[inline(always)]
    fn at_end<R: Real>(_: &Mindlin<R>) -> Option<R> {
        None
    }

    #[inline(always)]
    fn stiffness(&self, circle: f64) -> f64 {
        8.0 * self.shear * circle
    }
}
