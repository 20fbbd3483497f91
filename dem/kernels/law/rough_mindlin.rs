//! Tangential law: Mindlin's spring with conical damage and pressure-dependent friction.
//!
//! Spring of `mindlin.rs` on the circle of `conical_damage.rs`; asperities after Suhr & Six, Powder Technol.
//! 294, 2016.
//!
//! The mean pressure of a crushed corner is constant, so the nominal pressure on the uncrushed corner is
//! used.
//!
//! Theory manual: eq. (1.13), `docs/theory/contacts.md`.

use super::conical_damage::ConicalDamage;
use super::constants::constants;
use super::material::{LawName, Pair};
use super::mindlin::{Mindlin, shear};
use super::rough::asperities;
use super::tangential::{SpringInput, SpringTransfer, TangentialLaw};
use crate::lanes::Real;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughMindlin<R = f64> {
    /// Shear modulus G* [Pa].
    pub shear: R,
    asperities: R,
    /// π × nominal pressure at half asperity friction [Pa].
    pressure: R,
}

constants!(RoughMindlin { shear, asperities, pressure });

const NAME: LawName = LawName("mindlin");

impl TangentialLaw<ConicalDamage> for RoughMindlin {
    const NAME: &'static str = NAME.0;
    const SOURCE: &'static str = "contact, tangential: Mindlin, J. Appl. Mech. 16, 1949; pressure-dependent friction, Suhr & Six, \
                                  Powder Technol. 294, 2016";
    const KEYS: &'static [&'static str] = &["young", "poisson", "asperity_friction"];

    fn mix(pair: &Pair<'_>, _: &ConicalDamage) -> RoughMindlin {
        let (asperities, pressure) = asperities(pair, NAME).unwrap_or((0.0, 1.0));
        RoughMindlin { shear: shear(pair), asperities, pressure: std::f64::consts::PI * pressure }
    }

    #[inline(always)]
    fn grip<R: Real>(law: &RoughMindlin<R>, circle: R) -> SpringInput<R> {
        SpringInput { stiffness: R::splat(8.0) * law.shear * circle, compliance: None }
    }

    #[inline(always)]
    fn limit<R: Real>(law: &RoughMindlin<R>, friction: R, normal: R, radius: R) -> R {
        let half = law.pressure * radius * radius;
        let share = half / (half + normal).max(R::splat(f64::MIN_POSITIVE));
        (friction + law.asperities * share) * normal
    }

    #[inline(always)]
    fn transfer_spring<R: Real>(law: &RoughMindlin<R>, circle: R, before: R) -> Option<SpringTransfer<R>> {
        let mindlin = Mindlin { shear: law.shear };
        let SpringTransfer { kept, loss } =
            <Mindlin as TangentialLaw<super::hertz::Hertz>>::transfer_spring(&mindlin, circle, before)?;
        let touches = R::zero().lt(circle);
        let all = R::splat(4.0) * law.shear * before;
        Some(SpringTransfer { kept: kept.only(touches), loss: R::select(touches, loss, all) })
    }

    #[inline(always)]
    fn at_end<R: Real>(_: &RoughMindlin<R>) -> Option<R> {
        None
    }

    #[inline(always)]
    fn stiffness(&self, circle: f64) -> f64 {
        8.0 * self.shear * circle
    }
}
