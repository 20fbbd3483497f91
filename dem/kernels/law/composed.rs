//! Composition of contact laws: normal force with dashpot, tangential spring with Coulomb friction, rolling
//! and twisting resistance, adhesion. A pair uses the smaller friction, rolling and twisting coefficients.
//!
//! The dashpot uses the last half-step approach speed with a corrected coefficient (`half_step_damping.rs`),
//! its loss the extrapolated speed: second order. Alternatives: `docs/developer/engine.md`.
//!
//! Theory manual: eq. (3.3), `docs/theory/motion.md`.

use super::adhesion;
use super::constants::{Constants, constants};
use super::contact::{History, HistoryLanes, LawInput, LawOutput, Linearised, NO_CONTACT};
use super::contact_law::ContactLaw;
use super::damping::Damping;
use super::material::{LawName, Pair, harmonic};
use super::normal::{Expected, NormalInput, NormalLaw};
use super::rolling_twisting::{self, RollingTwisting, turning};
use super::slider;
use super::tangential::TangentialLaw;
use crate::lanes::{Real, V3};

/// Pair constants with normal law `N` and tangential law `T`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<N, T> {
    /// Normal law.
    pub normal: N,
    /// Tangential law.
    pub tangential: T,
    /// Constants of every law.
    pub common: Common,
    damping: Damping,
}

/// Constants independent of `N` and `T`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common<R = f64> {
    tangential_damping: R,
    /// Friction coefficient [-].
    pub friction: R,
    rolling: R,
    twisting: R,
    /// Adhesive force over effective radius [N/m].
    pull: R,
}

constants!(Common { tangential_damping, friction, rolling, twisting, pull });

/// [`Composed`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct ComposedLanes<N, T, R> {
    normal: N,
    tangential: T,
    common: Common<R>,
}

impl<N: NormalLaw, T: TangentialLaw<N>> Constants for Composed<N, T> {
    type Lanes<R: Real> = ComposedLanes<N::Lanes<R>, T::Lanes<R>, R>;

    const ZERO: Self =
        Composed { normal: N::ZERO, tangential: T::ZERO, common: Common::ZERO, damping: Damping::None };

    #[inline(always)]
    fn splat<R: Real>(&self) -> Self::Lanes<R> {
        ComposedLanes {
            normal: self.normal.splat(),
            tangential: self.tangential.splat(),
            common: self.common.splat(),
        }
    }

    #[inline(always)]
    fn mixed<R: Real>(all: [&Self; 8], join: fn(&[f64; 8]) -> R) -> Self::Lanes<R> {
        ComposedLanes {
            normal: N::mixed(all.map(|l| &l.normal), join),
            tangential: T::mixed(all.map(|l| &l.tangential), join),
            common: Common::mixed(all.map(|l| &l.common), join),
        }
    }
}

struct Onset<R> {
    /// At the full step [m/s].
    now: R,
    /// Contact time within the step [s].
    time: R,
    /// Weight of a jumping force [-].
    weight: R,
}

/// `weighted`: whether a force jumps.
#[inline(always)]
fn onset<R: Real>(
    approach: R,
    remembered: R,
    overlap: R,
    fresh: R::Mask,
    on: R::Mask,
    step: R,
    weighted: bool,
) -> Onset<R> {
    let one = R::splat(1.0);
    let mut now = R::splat(1.5) * approach - R::splat(0.5) * remembered;
    let (mut time, mut weight) = (step, one);
    if R::any(fresh & on) {
        // Far above 1: contact since the start of the run.
        let closing = R::zero().lt(approach);
        let since = R::select(closing, overlap / (approach * step), R::splat(f64::INFINITY));
        let share = since.min(one);
        now = R::select(fresh, approach, now);
        time = R::select(fresh, step * share, step);
        if weighted {
            let initial_state = R::select(since.lt(R::splat(1.5)), share + R::splat(0.5), one);
            weight = R::select(fresh, initial_state, one);
        }
    }
    Onset { now, time, weight }
}

impl<N: NormalLaw, T: TangentialLaw<N>> ContactLaw for Composed<N, T> {
    fn mix(pair: &Pair<'_>) -> Self {
        let damping = pair.given(|e| e.damping).unwrap_or_default();
        let normal = N::mix(pair, if N::DASHPOT { damping.ratio(pair.restitution()) } else { 0.0 });
        let (a, b) = (pair.a, pair.b);
        let slips = pair.given(|e| e.tangential) == Some(LawName::NONE);
        let beta = harmonic(a.tangential_damping_ratio, b.tangential_damping_ratio);
        Composed {
            normal,
            tangential: T::mix(pair, &normal),
            common: Common {
                tangential_damping: if slips { 0.0 } else { beta },
                friction: if slips { 0.0 } else { pair.smaller(|e| e.friction, |m| m.friction) },
                rolling: pair.smaller(|e| e.rolling_friction, |m| m.rolling_friction),
                twisting: pair.smaller(|e| e.twisting_friction, |m| m.twisting_friction),
                pull: adhesion::pull(pair),
            },
            damping,
        }
    }

    fn with_friction(&self, friction: f64) -> Self {
        Composed { common: Common { friction, ..self.common }, ..*self }
    }

    #[inline(always)]
    fn evaluate<R: Real, const ROLLING: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut HistoryLanes<R>,
        on: R::Mask,
        step: R,
    ) -> LawOutput<R> {
        let (n, overlap, common) = (touch.normal, touch.overlap, &law.common);
        let approach = -touch.velocity.dot(n);
        let slip_velocity = touch.velocity + n * approach;
        let fresh = memory.rate.equals(R::splat(NO_CONTACT));
        // Other history: the last half-step speed serves.
        let remembered_approach = if N::REMEMBERS { approach } else { memory.rate };
        let Onset { now, time, weight } =
            onset::<R>(approach, remembered_approach, overlap, fresh, on, step, N::JUMPS || ROLLING);

        let pressed = NormalInput {
            inverse_mass: touch.inverse_mass,
            radius: touch.radius,
            overlap,
            approach,
            remembered: memory.rate,
            fresh,
            step,
        };
        let own = N::respond(&law.normal, &pressed);
        let (elastic, c) = (own.elastic, own.damping);
        let (mut normal, mut dashpot, mut cs) = (elastic, own.lost, R::zero());
        if N::DASHPOT {
            let viscous = if N::JUMPS { weight * c * approach } else { c * approach };
            normal = (elastic + viscous).max(R::zero());
            dashpot = (normal - elastic) * now * step;
            if N::REMEMBERS {
                dashpot = dashpot + own.lost;
            }
            cs = c * common.tangential_damping;
        }
        memory.rate = if N::REMEMBERS { own.remembered } else { approach };

        let carried = T::transfer_spring(&law.tangential, own.circle, own.circle_before);
        let mut lost = R::zero();
        if let Some(c) = &carried {
            lost = (c.loss * memory.spring.norm2()).only(!fresh);
            memory.spring = memory.spring * c.kept;
        }
        let grip = T::grip(&law.tangential, own.circle);
        let limit = T::limit(&law.tangential, common.friction, normal, touch.radius);
        let slid = slider::plane(&mut memory.spring, n, slip_velocity, &grip, cs, limit, time, step, on);
        dashpot = dashpot + slid.dashpot;
        let mut friction = if carried.is_some() { lost + slid.friction } else { slid.friction };

        let (mut moment, mut net) = (V3::zero(), normal);
        if ROLLING {
            net = normal - common.pull * touch.radius * weight;
            if let Some(c) = &carried {
                let length2 = memory.roll.norm2() + memory.twist * memory.twist;
                friction = friction + (c.loss * length2).only(!fresh);
                memory.roll = memory.roll * c.kept;
                memory.twist = memory.twist * c.kept;
            }
            let part = RollingTwisting {
                stiffness: grip.stiffness,
                damping: cs,
                rolling: common.rolling,
                twisting: common.twisting,
                normal_force: normal,
                radius: touch.radius,
                time,
            };
            let t = turning(&part, &mut memory.roll, &mut memory.twist, n, touch.spin, step, on);
            moment = t.force;
            dashpot = dashpot + t.dashpot;
            friction = friction + t.friction;
        }
        LawOutput { force: n * net + slid.force, normal: net, moment, dashpot, friction }
    }

    fn stored(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        let turn2: f64 = history.turn.iter().map(|x| x * x).sum();
        let stiffness = self.tangential.stiffness(self.normal.circle(overlap, radius, history.rate));
        let held = 0.5 * stiffness * (history.spring.norm_squared() + turn2);
        let normal = self.normal.stored(overlap, radius, history.rate);
        (normal - self.common.pull * radius * overlap, held)
    }

    #[inline(always)]
    fn springs(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        let force = self.normal.force(overlap, radius, history.rate);
        let stiffness = self.tangential.stiffness(self.normal.circle(overlap, radius, history.rate));
        (force - self.common.pull * radius, stiffness)
    }

    fn friction_limit(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        let (force, stiffness) = self.springs(overlap, radius, history);
        let normal = force + self.common.pull * radius;
        (T::limit(&self.tangential.splat::<f64>(), self.common.friction, normal, radius), stiffness)
    }

    #[inline(always)]
    fn tangential_energy<R: Real, const ROLLING: bool>(law: &Self::Lanes<R>, memory: &HistoryLanes<R>) -> R {
        let Some(stiffness) = T::at_end::<R>(&law.tangential) else { return R::zero() };
        let mut length2 = memory.spring.norm2();
        if ROLLING {
            length2 = length2 + memory.roll.norm2() + memory.twist * memory.twist;
        }
        R::splat(0.5) * stiffness * length2
    }

    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64) {
        self.normal.loading(overlap, radius)
    }

    fn stiffness(&self, overlap: f64, radius: f64) -> f64 {
        self.normal.stiffness(overlap, radius)
    }

    fn linearised(&self, mass: f64, radius: f64, overlap: f64, history: &History) -> Linearised {
        let law = self.normal.splat::<f64>();
        let (remembered, fresh) = (history.rate, history.is_new());
        let inverse_mass = 1.0 / mass;
        let touch =
            NormalInput { inverse_mass, radius, overlap, approach: 0.0, remembered, fresh, step: 0.0 };
        let damping = if N::DASHPOT { N::respond(&law, &touch).damping } else { 0.0 };
        let tangential = self.tangential.stiffness(self.normal.circle(overlap, radius, remembered));
        let (c, turn) = (&self.common, tangential * radius * radius);
        Linearised {
            normal: self.normal.stiffness_with(overlap, radius, remembered),
            tangential,
            damping,
            tangential_damping: damping * c.tangential_damping,
            rolling: if c.rolling > 0.0 { turn } else { 0.0 },
            twisting: if c.twisting > 0.0 { turn } else { 0.0 },
        }
    }

    fn tangential_ratio(&self) -> f64 {
        let (normal, circle) = (self.normal.stiffness(1.0, 1.0), self.normal.circle(1.0, 1.0, 1.0));
        if normal > 0.0 && normal.is_finite() { self.tangential.stiffness(circle) / normal } else { 0.0 }
    }

    fn damping_ratio(&self) -> f64 {
        self.normal.damping_ratio()
    }

    fn loss(&self) -> f64 {
        self.normal.loss()
    }

    fn expected_overlap(&self, expected: &Expected) -> f64 {
        self.normal.expected_overlap(expected)
    }

    fn initial_state(&self, approach: f64) -> f64 {
        if N::REMEMBERS { 0.0 } else { approach }
    }

    fn rolls(&self) -> bool {
        let c = &self.common;
        c.rolling > 0.0 || c.twisting > 0.0 || c.pull > 0.0
    }

    fn names(&self) -> [&'static str; 2] {
        [N::NAME, T::NAME]
    }

    fn sources(&self) -> Vec<&'static str> {
        let c = &self.common;
        let mut sources = vec![N::SOURCE];
        if self.tangential.stiffness(1.0) > 0.0 && T::SOURCE != N::SOURCE {
            sources.push(T::SOURCE);
        }
        sources.extend(if N::DASHPOT { self.damping.source() } else { None });
        sources.extend((c.rolling > 0.0 || c.twisting > 0.0).then_some(rolling_twisting::SOURCE));
        sources.extend((c.pull > 0.0).then_some(adhesion::SOURCE));
        sources
    }
}

#[cfg(test)]
#[path = "composed_tests.rs"]
mod tests;
