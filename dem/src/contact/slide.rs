//! Springs that yield: the tangential spring of Coulomb friction, and the same for rolling and twisting.
//!
//! A spring in the tangent plane is turned into the present plane with its length kept, lengthened by the sliding
//! displacement, and, with a dashpot beside it, limited in force; it is then shortened so that it holds exactly the
//! limited force. The energy lost is the spring's mean force times the slide.

use crate::lanes::{Real, V3};

/// What a spring and its dashpot did in a step.
pub(crate) struct Slid<V, R> {
    pub force: V,
    pub dashpot: R,
    pub friction: R,
}

/// A spring in the plane across `normal`. `velocity` lies in that plane; `softness` is one over the stiffness, where that
/// is known; `time` is the part of the step during which
/// the contact was there [s].
#[inline(always)]
pub(crate) fn plane<R: Real>(
    spring: &mut V3<R>,
    normal: V3<R>,
    velocity: V3<R>,
    stiffness: R,
    softness: Option<R>,
    damping: R,
    limit: R,
    time: R,
    dt: f64,
    on: R::Mask,
) -> Slid<V3<R>, R> {
    let along = spring.dot(normal);
    let flat = *spring - normal * along;
    let (along2, flat2) = (along * along, flat.norm2());
    // The projection shortens by half the square of the turn. Below ten microradians per step that adds up to less
    // than 5e-6 of the whole angle turned, and the root and the division are spared.
    let turned = along2.gt(R::splat(1e-10) * flat2);
    let mut before = flat;
    if R::any(turned & on) {
        let stretch = (R::splat(1.0) + along2 / flat2).sqrt();
        let kept = (flat * stretch).only(R::zero().lt(flat2));
        before = V3::select(turned, kept, flat);
    }
    let stretched = before + velocity * time;
    let viscous = velocity * damping;
    let mut force = -(stretched * stiffness + viscous);
    let dashpot = viscous.dot(velocity) * R::splat(dt);
    let mut friction = R::zero();
    *spring = stretched;
    let size2 = force.norm2();
    let slides = size2.gt(limit * limit) & on;
    if R::any(slides) {
        let limited = force * (limit / size2.sqrt());
        let sprung = R::zero().lt(stiffness);
        let softness = match softness {
            Some(known) => known,
            None => R::splat(1.0) / stiffness,
        };
        let short = (-(limited + viscous) * softness).only(sprung);
        // The spring's mean force over the slide; without a spring the dashpot did all the work.
        let lost = R::select(
            sprung,
            R::splat(0.5) * stiffness * (stretched - short).dot(short + before),
            -(limited + viscous).dot(velocity) * R::splat(dt),
        );
        friction = lost.only(slides);
        force = V3::select(slides, limited, force);
        *spring = V3::select(slides, short, stretched);
    }
    Slid { force, dashpot, friction }
}

/// As [`plane`] for a spring in one direction.
#[inline(always)]
pub(crate) fn line<R: Real>(
    spring: &mut R,
    velocity: R,
    stiffness: R,
    damping: R,
    limit: R,
    time: R,
    dt: f64,
) -> Slid<R, R> {
    let before = *spring;
    let stretched = before + velocity * time;
    let viscous = velocity * damping;
    let free = -(stretched * stiffness + viscous);
    let slides = free.abs().gt(limit);
    let force = R::select(slides, R::select(free.lt(R::zero()), -limit, limit), free);
    let sprung = R::zero().lt(stiffness);
    let short = (-(force + viscous) / stiffness).only(sprung);
    let lost = R::select(
        sprung,
        R::splat(0.5) * stiffness * (stretched - short) * (short + before),
        -(force + viscous) * velocity * R::splat(dt),
    );
    *spring = R::select(slides, short, stretched);
    Slid { force, dashpot: viscous * velocity * R::splat(dt), friction: lost.only(slides) }
}

/// Springs against rolling and twisting as a law has them: stiffness and damping of the tangential springs, and the
/// limits as fractions of the normal force.
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
    dt: f64,
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
        t.stiffness.only(rolls),
        None,
        t.damping.only(rolls),
        t.rolling * t.normal_force,
        t.time,
        dt,
        on & rolls,
    );
    let w = line(
        twist,
        about * t.radius,
        t.stiffness.only(twists),
        t.damping.only(twists),
        t.twisting * t.normal_force,
        t.time,
        dt,
    );
    *roll = roll.only(rolls);
    *twist = twist.only(twists);
    Slid {
        force: (r.force.only(rolls) + normal * w.force.only(twists)) * t.radius,
        dashpot: r.dashpot.only(rolls) + w.dashpot.only(twists),
        friction: r.friction.only(rolls) + w.friction.only(twists),
    }
}
