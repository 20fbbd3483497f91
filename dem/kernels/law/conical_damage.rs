//! Normal law: elastic spheres with conical damage of corners.
//!
//! Corner: cone of half-angle α with a spherical tip of radius R, initially the effective radius R₀, that
//! crushes where Hertz's central pressure reaches the strength σ; k = (1 − sin α)/sin α. Unloading and
//! reloading at constant R.
//!
//! h < 5k is required: crushing then dissipates. Dashpot as in `hertz.rs` on the circle √(R u). Initial
//! overlaps count as crushed: R = R₀ + δ/k.
//!
//! Sources: Harkness, Zervos, Le Pen, Aingaran & Powrie, Granular Matter 18:65, 2016; this overlap: Suhr &
//! Six, Granular Matter 19:64, 2017.
//!
//! Theory manual: eqs (1.10), (1.11), (1.12), `docs/theory/contacts.md`.

use super::constants::constants;
use super::contact::NO_CONTACT;
use super::hertz::{self, dashpot, modulus};
use super::material::Pair;
use super::normal::{Expected, NormalInput, NormalLaw, Response};
use crate::lanes::Real;
use std::f64::consts::PI;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConicalDamage<R = f64> {
    /// Effective modulus E* [Pa].
    pub modulus: R,
    /// Elastic overlap over radius at crushing, h [-].
    pub limit: R,
    /// Apex recession over radius growth, k [-].
    pub slope: R,
    growth: R,
    given_way: R,
    work: R,
    /// Damping ratio ζ [-].
    damping_ratio: R,
}

constants!(ConicalDamage { modulus, limit, slope, growth, given_way, work, damping_ratio });

/// Returns h [-] for strength σ [Pa] and modulus E* [Pa].
pub fn elastic_limit(strength: f64, modulus: f64) -> f64 {
    (0.5 * PI * strength / modulus).powi(2)
}

/// Returns the strength [Pa] above which crushing would release energy, for E* [Pa] and α [rad].
pub fn greatest_strength(modulus: f64, angle: f64) -> f64 {
    2.0 * modulus / PI * (5.0 * slope(angle)).sqrt()
}

/// Returns k [-] for half-angle α [rad].
pub fn slope(angle: f64) -> f64 {
    let sine = libm::sin(angle);
    (1.0 - sine) / sine
}

impl ConicalDamage {
    /// Radius [m] and elastic overlap [m].
    #[inline(always)]
    fn state(&self, overlap: f64, radius: f64, remembered: f64) -> (f64, f64) {
        let before =
            if remembered == NO_CONTACT { radius + overlap * self.given_way } else { radius.max(remembered) };
        let grown = before.max((overlap + radius * self.slope) * self.growth);
        (grown, (overlap - (grown - radius) * self.slope).max(0.0))
    }
}

impl NormalLaw for ConicalDamage {
    const NAME: &'static str = "conical_damage";
    const SOURCE: &'static str = "contact: conical damage of elastic spheres, Harkness and others, Granular Matter 18:65, 2016; Suhr & Six, \
                                  Granular Matter 19:64, 2017";
    const KEYS: &'static [&'static str] = &["young", "poisson", "corner_strength", "corner_angle"];
    const DASHPOT: bool = true;
    const REMEMBERS: bool = true;
    const JUMPS: bool = false;
    const STIFFENS: bool = true;

    fn mix(pair: &Pair<'_>, zeta: f64) -> ConicalDamage {
        let modulus = modulus(pair);
        let strength = pair.a.corner_strength.min(pair.b.corner_strength);
        let limit = elastic_limit(strength, modulus);
        let slope = slope(pair.a.corner_angle.min(pair.b.corner_angle));
        // A soft partner deforms before the corner crushes.
        let crushes = limit < 5.0 * slope;
        let work = if crushes {
            4.0 / 3.0 * modulus * limit * limit.sqrt() * (slope / 3.0 - limit / 15.0)
        } else {
            0.0
        };
        let growth = if crushes { 1.0 / (limit + slope) } else { 0.0 };
        let given_way = if crushes { 1.0 / slope } else { 0.0 };
        ConicalDamage { modulus, limit, slope, growth, given_way, work, damping_ratio: zeta }
    }

    #[inline(always)]
    fn respond<R: Real>(law: &ConicalDamage<R>, touch: &NormalInput<R>) -> Response<R> {
        let NormalInput { radius, overlap, .. } = *touch;
        let overlap_before = touch.overlap_before();
        // Initial overlaps count as crushed.
        let there = (overlap * R::splat(0.5)).lt(overlap_before);
        let first = radius + (overlap_before * law.given_way).only(there);
        let before = R::select(touch.fresh, first, touch.remembered.max(radius));
        let grown = before.max((overlap + radius * law.slope) * law.growth);
        let elastic = (overlap - (grown - radius) * law.slope).max(R::zero());
        let elastic_before = (overlap_before - (before - radius) * law.slope).max(R::zero());
        let circle = (grown * elastic).sqrt();
        let tangent = R::splat(2.0) * law.modulus * circle;
        Response {
            elastic: R::splat(2.0 / 3.0) * tangent * elastic,
            damping: dashpot(law.damping_ratio, tangent, touch),
            circle,
            circle_before: (before * elastic_before).sqrt(),
            remembered: grown,
            lost: law.work * (grown * grown * grown - before * before * before),
        }
    }

    #[inline(always)]
    fn force(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        let (radius, elastic) = self.state(overlap, radius, remembered);
        4.0 / 3.0 * self.modulus * (radius * elastic).sqrt() * elastic
    }

    fn stored(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        let (radius, elastic) = self.state(overlap, radius, remembered);
        8.0 / 15.0 * self.modulus * (radius * elastic).sqrt() * elastic * elastic
    }

    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64) {
        let (grown, elastic) = self.state(overlap, radius, radius);
        let force = self.force(overlap, radius, radius);
        let crushes = grown > radius;
        // F = c R² with dR/dδ = 1/(h + k).
        (
            force,
            if crushes {
                2.0 * force / grown * self.growth
            } else {
                2.0 * self.modulus * (grown * elastic).sqrt()
            },
        )
    }

    fn stiffness(&self, overlap: f64, radius: f64) -> f64 {
        self.stiffness_with(overlap, radius, radius)
    }

    fn stiffness_with(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        2.0 * self.modulus * self.circle(overlap, radius, remembered)
    }

    #[inline(always)]
    fn circle(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        let (radius, elastic) = self.state(overlap, radius, remembered);
        (radius * elastic).sqrt()
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn expected_overlap(&self, e: &Expected) -> f64 {
        let elastic = hertz::expected(self.modulus, e);
        let crushed = if self.growth > 0.0 && elastic > self.limit {
            let force = 4.0 / 3.0 * self.modulus * self.limit * self.limit.sqrt();
            let impact = libm::cbrt(1.0 + 2.0 * PI * e.density * e.speed * e.speed * self.growth / force);
            let rest = (4.0 * e.density * e.gravity * e.height / force).sqrt();
            impact.max(rest).max(1.0) / self.growth - self.slope
        } else {
            elastic
        };
        crushed.clamp(1e-9, 1.0)
    }
}

#[cfg(test)]
#[path = "conical_damage_tests.rs"]
mod tests;
