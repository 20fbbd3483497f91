//! Rolling and twisting resistance: springs that yield, with the stiffness of the tangential one.
//!
//! Theory manual: equation (1.14) of `docs/theory/contacts.md`.

use super::slide::{Slid, line, plane};
use super::tangential::Grip;
use crate::lanes::{Real, V3};

/// Where it is published.
pub(super) const SOURCE: &str = "rolling and twisting resistance: Luding, Granular Matter 10, 2008";

/// Springs against rolling and twisting: stiffness and damping of the tangential springs, and the limits as fractions of
/// the normal force.
pub(crate) struct Turning<R> {
    pub stiffness: R,
    pub damping: R,
    pub rolling: R,
    pub twisting: R,
    pub normal_force: R,
    pub radius: R,
    pub time: R,
}

/// Moment of rolling and twisting resistance on a, and the energy it took.
///
/// With R the effective radius and ω the spin of a less that of b, the rolling velocity is R (ω − (ω·n) n) and the
/// twisting velocity R ω·n. Each stretches a spring with the stiffness of the tangential one, whose force is limited to
/// μᵣ F and μₜ F; times R it is the moment (Luding, Granular Matter 10, 2008, sections 2.5 to 2.7; with moments
/// against angles: stiffness Ks R², limit μ R F, as in Ai, Chen, Rotter & Ooi, Powder Technology 206, 2011, model C).
#[inline(always)]
pub(crate) fn turning<R: Real>(
    t: &Turning<R>,
    roll: &mut V3<R>,
    twist: &mut R,
    normal: V3<R>,
    spin: V3<R>,
    step: R,
    on: R::Mask,
) -> Slid<V3<R>, R> {
    let about = spin.dot(normal);
    let rolling = (spin - normal * about) * t.radius;
    // Without a limit there is no resistance and no spring.
    let rolls = R::zero().lt(t.rolling);
    let twists = R::zero().lt(t.twisting);
    let r = plane(
        roll,
        normal,
        rolling,
        &Grip { stiffness: t.stiffness.only(rolls), compliance: None },
        t.damping.only(rolls),
        t.rolling * t.normal_force,
        t.time,
        step,
        on & rolls,
    );
    let w = line(
        twist,
        about * t.radius,
        t.stiffness.only(twists),
        t.damping.only(twists),
        t.twisting * t.normal_force,
        t.time,
        step,
    );
    *roll = roll.only(rolls);
    *twist = twist.only(twists);
    Slid {
        force: (r.force.only(rolls) + normal * w.force.only(twists)) * t.radius,
        dashpot: r.dashpot.only(rolls) + w.dashpot.only(twists),
        friction: r.friction.only(rolls) + w.friction.only(twists),
    }
}
