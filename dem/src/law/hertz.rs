//! Elastic spheres after Hertz, with Mindlin's tangential stiffness and Coulomb friction.
//!
//! With d the overlap, R = R₁R₂/(R₁ + R₂), a = √(R d) the radius of the contact circle,
//! 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ and 1/G* = (2 − ν₁)/G₁ + (2 − ν₂)/G₂, G = E/(2(1 + ν)):
//!
//! * normal: F = max(0, 4/3 E* √R d^(3/2) + C ḋ) (Hertz 1882; Johnson, Contact Mechanics, 1985, sec. 4.2), with
//!   C = √5 ζ √(4/3 E* √R m*) d^(1/4) (Tsuji, Tanaka & Ishida, Powder Technology 71, 1992);
//! * tangential: a spring of stiffness 8 G* a (Mindlin 1949), turned, damped, limited and shortened as the linear
//!   law's (`slide.rs`).
//!
//! Restitution. With s = d^(5/4) as the coordinate and dτ = d^(1/4) dt·5/4 as the time, m* d̈ = −F becomes
//! v dv/ds = −(4/5)(s + √5 ζ v) in units of the impact: the damped *linear* oscillator, with damping ratio ζ. It ends,
//! clipped, where the linear one does, so ζ(e) is that of `restitution.rs`, and e does not depend on the speed. (The
//! usual −ln e/√(π² + ln² e) belongs to the force that is not clipped.)
//!
//! Changing overlap. The stiffness of the tangential spring changes with a. While the overlap grows the force is
//! kept, so the spring is shortened by a₀/a; while it falls the spring's length is kept, so the force falls as a does
//! (the rule of Elata & Berryman, Mech. Mater. 24, 1996: a force kept on unloading would create energy). The energy
//! of the spring falls in both cases and is booked as friction: in the real contact it goes into slip near the rim.
//! Rolling and twisting springs have the same stiffness and follow the same rule. The overlap before is d − ḋ dt.
//!
//! Second order in time as the linear law: the dashpot sees the approach speed extrapolated to the full step.
//!
//! Adhesion, where the pair has it: `adhesion.rs`; with this law it is the model of Derjaguin, Muller & Toporov.
//!
//! Limits: smooth elastic spheres, contact circle small against the radii; the partial slip near the rim under
//! oscillating tangential force (Mindlin & Deresiewicz 1953) only as the rule above has it.

use super::restitution::damping_ratio;
use super::slide::{self, Turning};
use super::{ContactLaw, FRESH, History, LawInput, LawOutput, Memory, adhesion, harmonic, law_lanes};
use crate::lanes::{Real, V3};
use crate::law::material::{Material, PairOverride};

/// 2 √(5/6): with the tangent stiffness S = 2 E* a the dashpot is 2 √(5/6) ζ √(S m*).
const DASHPOT: f64 = 1.825_741_858_350_553_8;

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz<R = f64> {
    /// Effective modulus E* [Pa].
    pub modulus: R,
    /// Effective shear modulus G* [Pa].
    pub shear: R,
    /// Damping ratio ζ [-].
    pub damping_ratio: R,
    /// Tangential over normal dashpot [-].
    tangential_damping: R,
    /// Friction coefficient [-].
    pub friction: R,
    /// Coefficient of rolling resistance [-].
    rolling: R,
    /// Coefficient of twisting resistance [-].
    twisting: R,
    /// Adhesive force over the effective radius [N/m].
    pull: R,
}

impl ContactLaw for Hertz {
    type Lanes<R: Real> = Hertz<R>;

    fn mix(a: &Material, b: &Material, exception: Option<&PairOverride>) -> Hertz {
        let given = |pick: fn(&PairOverride) -> Option<f64>| exception.and_then(pick);
        let soft = |m: &Material| m.young.map_or(0.0, |e| (1.0 - m.poisson * m.poisson) / e);
        let shear = |m: &Material| m.young.map_or(0.0, |e| (2.0 - m.poisson) * 2.0 * (1.0 + m.poisson) / e);
        let restitution = given(|e| e.restitution).unwrap_or(a.restitution.min(b.restitution));
        Hertz {
            modulus: 1.0 / (soft(a) + soft(b)),
            shear: 1.0 / (shear(a) + shear(b)),
            damping_ratio: damping_ratio(restitution),
            tangential_damping: harmonic(a.tangential_damping_ratio, b.tangential_damping_ratio),
            friction: given(|e| e.friction).unwrap_or(a.friction.min(b.friction)),
            rolling: a.rolling_friction.min(b.rolling_friction),
            twisting: a.twisting_friction.min(b.twisting_friction),
            pull: adhesion::pull(exception),
        }
    }

    law_lanes!(Hertz {
        modulus,
        shear,
        damping_ratio,
        tangential_damping,
        friction,
        rolling,
        twisting,
        pull
    });

    #[inline(always)]
    fn evaluate<R: Real, const ROLL: bool>(
        law: &Hertz<R>,
        touch: &LawInput<R>,
        memory: &mut Memory<R>,
        on: R::Mask,
        dt: f64,
    ) -> LawOutput<R> {
        let (n, d) = (touch.normal, touch.overlap);
        let rate = -touch.velocity.dot(n);
        let slip_velocity = touch.velocity + n * rate;
        let (one, step) = (R::splat(1.0), R::splat(dt));

        let fresh = memory.rate.equals(R::splat(FRESH));
        let mut now = R::splat(1.5) * rate - R::splat(0.5) * memory.rate;
        let (mut time, mut weight) = (step, one);
        if R::any(fresh & on) {
            // The share of the last step with contact; more than one: the contact is there from the start of the run.
            let since = R::select(R::zero().lt(rate), d / (rate * step), one);
            now = R::select(fresh, rate, now);
            time = R::select(fresh, step * since.min(one), step);
            if ROLL {
                let begun = R::select(
                    R::zero().lt(rate) & since.lt(R::splat(1.5)),
                    since.min(one) + R::splat(0.5),
                    one,
                );
                weight = R::select(fresh, begun, one);
            }
        }
        memory.rate = rate;

        let circle = (touch.radius * d).sqrt();
        let tangent = R::splat(2.0) * law.modulus * circle;
        let elastic = R::splat(2.0 / 3.0) * tangent * d;
        let c = R::splat(DASHPOT) * law.damping_ratio * (tangent * touch.mass).sqrt();
        let normal = (elastic + c * now).max(R::zero());
        let mut dashpot = (normal - elastic) * now * step;

        // Springs carried over from the overlap before.
        let before = (touch.radius * (d - rate * step).max(R::zero())).sqrt();
        let kept = (before / circle).min(one);
        let loss = R::splat(4.0) * law.shear * (before - circle * kept * kept);
        let stiffness = R::splat(8.0) * law.shear * circle;
        let mut friction = (loss * memory.spring.norm2()).only(!fresh);
        memory.spring = memory.spring * kept;

        let cs = c * law.tangential_damping;
        let limit = law.friction * normal;
        let slid =
            slide::plane(&mut memory.spring, n, slip_velocity, stiffness, None, cs, limit, time, dt, on);
        dashpot = dashpot + slid.dashpot;
        friction = friction + slid.friction;
        let (mut moment, mut net) = (V3::zero(), normal);
        if ROLL {
            net = normal - law.pull * touch.radius * weight;
            let length2 = memory.roll.norm2() + memory.twist * memory.twist;
            friction = friction + (loss * length2).only(!fresh);
            memory.roll = memory.roll * kept;
            memory.twist = memory.twist * kept;
            let turning = Turning {
                stiffness,
                damping: cs,
                rolling: law.rolling,
                twisting: law.twisting,
                normal_force: normal,
                radius: touch.radius,
                time,
            };
            let t = slide::turning(&turning, &mut memory.roll, &mut memory.twist, n, touch.spin, dt, on);
            moment = t.force;
            dashpot = dashpot + t.dashpot;
            friction = friction + t.friction;
        }
        LawOutput { force: n * net + slid.force, normal: net, moment, dashpot, friction }
    }

    fn stored(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        let circle = (radius * overlap).sqrt();
        let turn2: f64 = history.turn.iter().map(|x| x * x).sum();
        let held = 4.0 * self.shear * circle * (history.spring.norm_squared() + turn2);
        (8.0 / 15.0 * self.modulus * circle * overlap * overlap - self.pull * radius * overlap, held)
    }

    #[inline(always)]
    fn springs(&self, overlap: f64, radius: f64) -> (f64, f64) {
        let circle = (radius * overlap).sqrt();
        (4.0 / 3.0 * self.modulus * circle * overlap - self.pull * radius, 8.0 * self.shear * circle)
    }

    /// Nothing: the stiffness, and with it the energy, has gone to zero with the overlap, and was booked on the way
    /// but for the last step's.
    #[inline(always)]
    fn stored_in_springs<R: Real, const ROLL: bool>(_: &Hertz<R>, _: &Memory<R>) -> R {
        R::zero()
    }

    fn stiffness(&self, overlap: f64, radius: f64) -> f64 {
        2.0 * self.modulus * (radius * overlap).sqrt()
    }

    fn tangential_ratio(&self) -> f64 {
        if self.modulus.is_finite() { 4.0 * self.shear / self.modulus } else { 0.0 }
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn rolls(&self) -> bool {
        self.rolling > 0.0 || self.twisting > 0.0 || self.pull > 0.0
    }
}

#[cfg(test)]
#[path = "hertz_tests.rs"]
mod tests;
