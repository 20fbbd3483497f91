//! Normal law: elastic spheres after Hertz.
//!
//! Sources: Hertz 1882; Johnson, Contact Mechanics, 1985, sec. 4.2; dashpot: Tsuji, Tanaka & Ishida, Powder
//! Technology 71, 1992.
//!
//! In s = d^(5/4) an impact is a *linear* oscillator, so ζ(e) is as in `restitution.rs` at any speed.
//!
//! Expected overlap for the time step, densest body, the larger of
//!
//! * impact: Johnson, eq. 11.24, m = 4/3 π ρ R³;
//! * rest under a column.
//!
//! Theory manual: eqs (1.2), (1.7), (3.7), `docs/theory/contacts.md`, `docs/theory/motion.md`.

use super::constants::constants;
use super::half_step_damping;
use super::material::{Material, Pair};
use super::normal::{Expected, NormalInput, NormalLaw, Response};
use crate::lanes::Real;

/// With tangent stiffness S = 2 E* a the dashpot is 2 √(5/6) ζ √(S m*).
const DASHPOT: f64 = 1.825_741_858_350_553_8;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz<R = f64> {
    /// Effective modulus E* [Pa].
    pub modulus: R,
    /// Damping ratio ζ [-].
    damping_ratio: R,
}

constants!(Hertz { modulus, damping_ratio });

/// Corrected dashpot coefficient [N s/m]; `tangent` [N/m].
#[inline(always)]
pub(super) fn dashpot<R: Real>(zeta: R, tangent: R, touch: &NormalInput<R>) -> R {
    let rate = R::splat(DASHPOT) * zeta * (tangent * touch.inverse_mass).sqrt();
    let (numerator, denominator) = half_step_damping::share(R::splat(0.5) * touch.step * rate);
    rate * numerator / (touch.inverse_mass * denominator)
}

/// E* [Pa]; rigid without a modulus.
pub(super) fn modulus(pair: &Pair<'_>) -> f64 {
    let soft = |m: &Material| m.young.map_or(0.0, |e| (1.0 - m.poisson * m.poisson) / e);
    1.0 / (soft(pair.a) + soft(pair.b))
}

pub(super) fn expected(modulus: f64, e: &Expected) -> f64 {
    let impact = libm::pow(1.25 * std::f64::consts::PI * e.density * e.speed * e.speed / modulus, 0.4);
    let rest = libm::pow(3.0 * e.density * e.gravity * e.height / modulus, 2.0 / 3.0);
    impact.max(rest)
}

impl NormalLaw for Hertz {
    const NAME: &'static str = "hertz";
    const SOURCE: &'static str = "contact: elastic spheres, Hertz 1882; Johnson, Contact Mechanics, 1985; dashpot of Tsuji, \
                                  Tanaka & Ishida, Powder Technology 71, 1992";
    const KEYS: &'static [&'static str] = &["young", "poisson"];
    const DASHPOT: bool = true;
    const REMEMBERS: bool = false;
    const JUMPS: bool = false;
    const STIFFENS: bool = true;

    fn mix(pair: &Pair<'_>, zeta: f64) -> Hertz {
        Hertz { modulus: modulus(pair), damping_ratio: zeta }
    }

    #[inline(always)]
    fn respond<R: Real>(law: &Hertz<R>, touch: &NormalInput<R>) -> Response<R> {
        let circle = (touch.radius * touch.overlap).sqrt();
        let tangent = R::splat(2.0) * law.modulus * circle;
        Response {
            elastic: R::splat(2.0 / 3.0) * tangent * touch.overlap,
            damping: dashpot(law.damping_ratio, tangent, touch),
            circle,
            circle_before: (touch.radius * touch.overlap_before()).sqrt(),
            remembered: touch.remembered,
            lost: R::zero(),
        }
    }

    #[inline(always)]
    fn force(&self, overlap: f64, radius: f64, _: f64) -> f64 {
        4.0 / 3.0 * self.modulus * (radius * overlap).sqrt() * overlap
    }

    fn stored(&self, overlap: f64, radius: f64, _: f64) -> f64 {
        8.0 / 15.0 * self.modulus * (radius * overlap).sqrt() * overlap * overlap
    }

    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64) {
        let stiffness = self.stiffness(overlap, radius);
        (2.0 / 3.0 * stiffness * overlap, stiffness)
    }

    fn stiffness(&self, overlap: f64, radius: f64) -> f64 {
        2.0 * self.modulus * (radius * overlap).sqrt()
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn expected_overlap(&self, e: &Expected) -> f64 {
        // Stiffness must not vanish for weightless bodies at rest.
        expected(self.modulus, e).clamp(1e-9, 1.0)
    }
}
