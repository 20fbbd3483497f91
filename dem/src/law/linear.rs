//! Linear spring–dashpot with Coulomb friction.
//!
//! With n from b to a, v the velocity of a relative to b at the contact point, d the overlap, ḋ = −v·n:
//!
//! * normal: F = max(0, K d + C ḋ), K = 2 k₁k₂/(k₁ + k₂), C = 2ζ√(m*K), m* = m₁m₂/(m₁ + m₂) of the *bodies*;
//!   ζ makes the clipped law give the restitution asked for (`restitution.rs`);
//! * tangential: a spring ξ, turned into the present tangent plane with its length kept, lengthened by the
//!   sliding displacement; Fs = −Ks ξ − Cs vₜ, limited to μF in magnitude, the spring then shortened so that it
//!   holds exactly the limited force. Ks = α K and Cs = β C.
//!
//! Mixing: stiffness as above; α, β harmonic like the stiffness, 2α₁α₂/(α₁ + α₂); friction and restitution the
//! smaller of the two. Sources: Cundall & Strack, Géotechnique 29 (1979); Schwager & Pöschel (2007).
//!
//! Second order in time in spite of the leapfrog's velocities at half steps: the dashpot sees the approach speed
//! extrapolated to the full step, 3/2 ḋ(n−½) − 1/2 ḋ(n−3/2); and since the dashpot's force jumps from zero at
//! first touch, the first force counts it for the part θ + ½ of the step for which the contact has been there,
//! θ = d/(ḋ dt).
//!
//! Rolling and twisting resistance, where the materials have it: `slide.rs`, with the smaller coefficients of the two.
//!
//! Adhesion, where the pair has it: `adhesion.rs`.
//!
//! Limits: overlaps small against the radii.

use super::restitution::damping_ratio;
use super::slide::{self, Turning};
use super::{ContactLaw, FRESH, History, LawInput, LawOutput, Memory, adhesion, harmonic, law_lanes};
use crate::lanes::{Real, V3};
use crate::law::material::{Material, PairOverride};

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<R = f64> {
    /// Normal stiffness K [N/m].
    pub normal: R,
    /// Tangential stiffness Ks [N/m].
    pub tangential: R,
    /// 1/Ks [m/N].
    tangential_softness: R,
    /// C/√m* = 2ζ√K [√(N/m)].
    damping: R,
    /// Cs/C [-].
    tangential_damping: R,
    /// Friction coefficient [-].
    pub friction: R,
    /// Coefficient of rolling resistance [-].
    rolling: R,
    /// Coefficient of twisting resistance [-].
    twisting: R,
    /// Adhesive force over the effective radius [N/m].
    pull: R,
    /// Damping ratio ζ [-].
    pub damping_ratio: R,
}

impl ContactLaw for Linear {
    type Lanes<R: Real> = Linear<R>;

    fn mix(a: &Material, b: &Material, exception: Option<&PairOverride>) -> Linear {
        let given = |pick: fn(&PairOverride) -> Option<f64>| exception.and_then(pick);
        let normal = given(|e| e.stiffness).unwrap_or(harmonic(a.stiffness, b.stiffness));
        let restitution = given(|e| e.restitution).unwrap_or(a.restitution.min(b.restitution));
        let zeta = damping_ratio(restitution);
        let tangential = normal * harmonic(a.tangential_ratio, b.tangential_ratio);
        Linear {
            normal,
            tangential,
            tangential_softness: 1.0 / tangential,
            damping: 2.0 * zeta * normal.sqrt(),
            tangential_damping: harmonic(a.tangential_damping_ratio, b.tangential_damping_ratio),
            friction: given(|e| e.friction).unwrap_or(a.friction.min(b.friction)),
            rolling: a.rolling_friction.min(b.rolling_friction),
            twisting: a.twisting_friction.min(b.twisting_friction),
            pull: adhesion::pull(exception),
            damping_ratio: zeta,
        }
    }

    law_lanes!(Linear {
        normal,
        tangential,
        tangential_softness,
        damping,
        tangential_damping,
        friction,
        rolling,
        twisting,
        pull,
        damping_ratio
    });

    #[inline(always)]
    fn evaluate<R: Real, const ROLL: bool>(
        law: &Linear<R>,
        touch: &LawInput<R>,
        memory: &mut Memory<R>,
        on: R::Mask,
        dt: f64,
    ) -> LawOutput<R> {
        let n = touch.normal;
        let rate = -touch.velocity.dot(n);
        let slip_velocity = touch.velocity + n * rate;

        // `now`: approach speed at this instant; `part`: share of the last step with contact; `weight`: of the dashpot.
        let fresh = memory.rate.equals(R::splat(FRESH));
        let mut now = R::splat(1.5) * rate - R::splat(0.5) * memory.rate;
        let one = R::splat(1.0);
        let (mut part, mut weight) = (one, one);
        if R::any(fresh & on) {
            // Far above 1: the contact is there from the start of the run, not from within this step.
            let closing = R::zero().lt(rate);
            let since = R::select(closing, touch.overlap / (rate * R::splat(dt)), R::splat(f64::INFINITY));
            let share = since.min(one);
            let begun = R::select(since.lt(R::splat(1.5)), share + R::splat(0.5), one);
            now = R::select(fresh, rate, now);
            part = R::select(fresh, share, one);
            weight = R::select(fresh, begun, one);
        }
        memory.rate = rate;

        let c = law.damping * touch.mass.sqrt();
        let elastic = law.normal * touch.overlap;
        let normal = (elastic + weight * c * now).max(R::zero());
        let mut dashpot = (normal - elastic) * now * R::splat(dt);

        let cs = c * law.tangential_damping;
        let time = R::splat(dt) * part;
        let limit = law.friction * normal;
        let softness = Some(law.tangential_softness);
        let slid = slide::plane(
            &mut memory.spring,
            n,
            slip_velocity,
            law.tangential,
            softness,
            cs,
            limit,
            time,
            dt,
            on,
        );
        dashpot = dashpot + slid.dashpot;
        let mut friction = slid.friction;
        let (mut moment, mut net) = (V3::zero(), normal);
        if ROLL {
            net = normal - law.pull * touch.radius * weight;
            let turning = Turning {
                stiffness: law.tangential,
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
        let turn2: f64 = history.turn.iter().map(|x| x * x).sum();
        let held = 0.5 * self.tangential * (history.spring.norm_squared() + turn2);
        (0.5 * self.normal * overlap * overlap - self.pull * radius * overlap, held)
    }

    #[inline(always)]
    fn springs(&self, overlap: f64, radius: f64) -> (f64, f64) {
        (self.normal * overlap - self.pull * radius, self.tangential)
    }

    #[inline(always)]
    fn stored_in_springs<R: Real, const ROLL: bool>(law: &Linear<R>, memory: &Memory<R>) -> R {
        let mut length2 = memory.spring.norm2();
        if ROLL {
            length2 = length2 + memory.roll.norm2() + memory.twist * memory.twist;
        }
        R::splat(0.5) * law.tangential * length2
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.normal
    }

    fn tangential_ratio(&self) -> f64 {
        if self.normal > 0.0 { self.tangential / self.normal } else { 0.0 }
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn rolls(&self) -> bool {
        self.rolling > 0.0 || self.twisting > 0.0 || self.pull > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Vec3;
    use crate::law::ContactGeometry;
    use crate::testing::SOFT;

    fn touch(overlap: f64) -> ContactGeometry {
        ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: 0.01 }
    }

    #[test]
    fn stiffness_of_like_pair_and_rigid_wall() {
        let wall = Material { stiffness: f64::INFINITY, ..SOFT };
        assert_eq!(Linear::mix(&SOFT, &SOFT, None).normal, 1e5);
        assert_eq!(Linear::mix(&SOFT, &wall, None).normal, 2e5);
        assert!(Linear::mix(&wall, &wall, None).normal.is_infinite());
    }

    #[test]
    fn coulomb_limit_in_every_direction_and_spring_shortened() {
        let law = Linear::mix(&SOFT, &SOFT, None);
        for k in 0..8 {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let velocity = Vec3::new(angle.cos(), angle.sin(), 0.0);
            let mut h = History { rate: 0.0, ..History::NONE };
            let mut force = Vec3::zeros();
            for _ in 0..100 {
                force = law.evaluate_one(0.1, &touch(1e-4), &velocity, &Vec3::zeros(), &mut h, 1e-4).force;
            }
            let friction = Vec3::new(force.x, force.y, 0.0);
            assert!((friction + velocity * 5.0).norm() < 1e-12, "{friction}");
            assert!((h.spring * law.tangential + friction).norm() < 1e-12);
        }
    }

    #[test]
    fn spring_turns_with_the_tangent_plane_and_keeps_its_length() {
        let law = Linear::mix(&SOFT, &SOFT, None);
        let mut h = History { spring: Vec3::new(1e-6, 0.0, 0.0), rate: 0.0, ..History::NONE };
        for k in 0..=100 {
            let a = f64::from(k) * 0.01;
            let normal = Vec3::new(-a.sin(), 0.0, a.cos());
            law.evaluate_one(
                0.1,
                &ContactGeometry { normal, ..touch(1e-4) },
                &Vec3::zeros(),
                &Vec3::zeros(),
                &mut h,
                1e-4,
            );
        }
        let expected = Vec3::new(1.0_f64.cos(), 0.0, 1.0_f64.sin()) * 1e-6;
        assert!((h.spring - expected).norm() < 1e-18, "{}", h.spring);
    }
}
