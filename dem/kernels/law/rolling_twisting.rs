//! Rolling and twisting resistance: friction-limited springs of tangential stiffness.
//!
//! Theory manual: eq. (1.14), `docs/theory/contacts.md`.

use super::slider::{SliderOutput, line, plane};
use super::tangential::SpringInput;
use crate::lanes::{Real, V3};

pub(super) const SOURCE: &str = "rolling and twisting resistance: Luding, Granular Matter 10, 2008";

/// Tangential stiffness and damping, limits over normal force.
pub struct RollingTwisting<R> {
    pub stiffness: R,
    pub damping: R,
    pub rolling: R,
    pub twisting: R,
    pub normal_force: R,
    pub radius: R,
    pub time: R,
}

/// Rolling and twisting moment on a, and dissipation.
///
/// Luding, Granular Matter 10, 2008, sections 2.5 to 2.7; in moments and angles: stiffness Ks R², limit μ R
/// F, as in Ai, Chen, Rotter & Ooi, Powder Technology 206, 2011, model C.
#[inline(always)]
pub fn turning<R: Real>(
    t: &RollingTwisting<R>,
    roll: &mut V3<R>,
    twist: &mut R,
    normal: V3<R>,
    spin: V3<R>,
    step: R,
    on: R::Mask,
) -> SliderOutput<V3<R>, R> {
    let about = spin.dot(normal);
    let rolling = (spin - normal * about) * t.radius;
    let rolls = R::zero().lt(t.rolling);
    let twists = R::zero().lt(t.twisting);
    let r = plane(
        roll,
        normal,
        rolling,
        &SpringInput { stiffness: t.stiffness.only(rolls), compliance: None },
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
    SliderOutput {
        force: (r.force.only(rolls) + normal * w.force.only(twists)) * t.radius,
        dashpot: r.dashpot.only(rolls) + w.dashpot.only(twists),
        friction: r.friction.only(rolls) + w.friction.only(twists),
    }
}
