//! Tangential law: Mindlin's stiffness of the contact circle.
//!
//! Source: Mindlin 1949; slider as in `slider.rs`.
//!
//! Loading keeps the force: the spring shortens by a₀/a. Unloading keeps the length (Elata & Berryman, Mech.
//! Mater. 24, 1996: constant force would create energy). Lost spring energy counts as friction. The previous
//! circle belongs to overlap d − ḋ dt.
//!
//! Theory manual: eqs (1.2), (1.8), `docs/theory/contacts.md`.

use super::constants::constants;
use super::hertz::Hertz;
use super::material::{LawName, Material, Pair};
use super::normal::NormalLaw;
use super::tangential::{SpringInput, SpringTransfer, TangentialLaw};
use crate::lanes::Real;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mindlin<R = f64> {
    /// Shear modulus G* [Pa].
    pub shear: R,
}

constants!(Mindlin { shear });

/// G* [Pa]; rigid without a modulus, zero without tangential force.
pub(super) fn shear(pair: &Pair<'_>) -> f64 {
    if pair.given(|e| e.tangential) == Some(LawName::NONE) {
        return 0.0;
    }
    let soft = |m: &Material| m.young.map_or(0.0, |e| (2.0 - m.poisson) * 2.0 * (1.0 + m.poisson) / e);
    1.0 / (soft(pair.a) + soft(pair.b))
}

/// Normal law whose contact has a circle of radius √(R d).
pub trait CircularContact: NormalLaw {}

impl CircularContact for Hertz {}

impl<N: CircularContact> TangentialLaw<N> for Mindlin {
    const NAME: &'static str = "mindlin";
    const SOURCE: &'static str =
        "contact, tangential: Mindlin, J. Appl. Mech. 16, 1949; Elata & Berryman, Mech. Mater. 24, 1996";
    const KEYS: &'static [&'static str] = &["young", "poisson"];

    fn mix(pair: &Pair<'_>, _: &N) -> Mindlin {
        Mindlin { shear: shear(pair) }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &Mindlin<R>, circle: R) -> SpringInput<R> {
        SpringInput { stiffness: R::splat(8.0) * law.shear * circle, compliance: None }
    }

    #[inline(always)]
    fn transfer_spring<R: Real>(law: &Mindlin<R>, circle: R, before: R) -> Option<SpringTransfer<R>> {
        let kept = (before / circle).min(R::splat(1.0));
        let loss = R::splat(4.0) * law.shear * (before - circle * kept * kept);
        Some(SpringTransfer { kept, loss })
    }

    #[inline(always)]
    fn at_end<R: Real>(_: &Mindlin<R>) -> Option<R> {
        None
    }

    #[inline(always)]
    fn stiffness(&self, circle: f64) -> f64 {
        8.0 * self.shear * circle
    }
}
