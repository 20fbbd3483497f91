//! Slider of Coulomb friction, also for rolling and twisting (`rolling_twisting.rs`).
//!
//! Spring and dashpot are parallel, in series with the slider. (A dashpot at full velocity, as in LAMMPS'
//! `gran/hooke/history`, leaves a spurious −Cs v/Ks after fast grazing.)
//!
//! Theory manual: eqs (1.5), (1.6), `docs/theory/contacts.md`.

use super::tangential::SpringInput;
use crate::lanes::{Real, V3};

pub struct SliderOutput<V, R> {
    pub force: V,
    pub dashpot: R,
    pub friction: R,
}

/// Spring across `normal`. `velocity`: tangential; `time`: contact time within the step [s].
#[inline(always)]
pub fn plane<R: Real>(
    spring: &mut V3<R>,
    normal: V3<R>,
    velocity: V3<R>,
    grip: &SpringInput<R>,
    damping: R,
    limit: R,
    time: R,
    step: R,
    on: R::Mask,
) -> SliderOutput<V3<R>, R> {
    let stiffness = grip.stiffness;
    let along = spring.dot(normal);
    let flat = *spring - normal * along;
    let (along2, flat2) = (along * along, flat.norm2());
    // Projection error is half the rotation squared: below 1e-5 rad per step less than 5e-6 of the total
    // rotation.
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
    let mut dashpot = viscous.dot(velocity) * step;
    let mut friction = R::zero();
    *spring = stretched;
    let size2 = force.norm2();
    let slides = size2.gt(limit * limit) & on;
    if R::any(slides) {
        let limited = force * (limit / size2.sqrt());
        let sprung = R::zero().lt(stiffness);
        let compliance = match grip.compliance {
            Some(known) => known,
            None => R::splat(1.0) / stiffness,
        };
        let mut short = -limited * compliance;
        let mut lost = R::splat(0.5) * stiffness * (stretched - short).dot(short + before);
        let damped = R::zero().lt(damping);
        if R::any(damped & slides) {
            let own = before.only(sprung);
            let rate = -(limited + own * stiffness) * (R::splat(1.0) / (stiffness * time + damping));
            let ends = own + rate * time;
            let held = (own + ends) * (R::splat(0.5) * stiffness) + rate * damping;
            short = V3::select(damped, ends, short);
            lost = R::select(damped, held.dot(velocity - rate) * time, lost);
            let viscous = rate.norm2() * damping * step;
            dashpot = R::select(damped & slides, viscous, dashpot);
        }
        short = short.only(sprung);
        friction = lost.only(slides);
        force = V3::select(slides, limited, force);
        *spring = V3::select(slides, short, stretched);
    }
    SliderOutput { force, dashpot, friction }
}

#[inline(always)]
pub fn line<R: Real>(
    spring: &mut R,
    velocity: R,
    stiffness: R,
    damping: R,
    limit: R,
    time: R,
    step: R,
) -> SliderOutput<R, R> {
    let before = *spring;
    let stretched = before + velocity * time;
    let viscous = velocity * damping;
    let free = -(stretched * stiffness + viscous);
    let slides = free.abs().gt(limit);
    let force = R::select(slides, R::select(free.lt(R::zero()), -limit, limit), free);
    let (sprung, damped) = (R::zero().lt(stiffness), R::zero().lt(damping));
    let own = before.only(sprung);
    let rate = -(force + own * stiffness) / (stiffness * time + damping);
    let short = R::select(damped, own + rate * time, -force / stiffness).only(sprung);
    let held = R::splat(0.5) * stiffness * (own + short) + rate * damping;
    let slide = R::select(damped, (velocity - rate) * time, stretched - short);
    let lost = held.only(damped) + (R::splat(0.5) * stiffness * (short + before)).only(!damped);
    *spring = R::select(slides, short, stretched);
    let power = R::select(slides & damped, rate * rate * damping, viscous * velocity);
    SliderOutput { force, dashpot: power * step, friction: (lost * slide).only(slides) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Dissipation is work minus stored energy; the error vanishes with the step.
    #[test]
    fn friction_dissipates_and_the_account_closes() {
        let (stiffness, limit, dt) = (1e5, 10.0, 1e-5);
        for damping in [0.0, 30.0, 3000.0] {
            for velocity in [-0.5, 0.02, 0.3] {
                let (mut flat, mut straight) = (V3::new(2e-5, 0.0, 0.0), 2e-5);
                let (mut sums, mut stored) = ([[0.0; 3]; 2], 0.5 * stiffness * straight * straight);
                for _ in 0..100 {
                    let v = V3::new(velocity, 0.0, 0.0);
                    let n = V3::new(0.0, 0.0, 1.0);
                    let p = plane(
                        &mut flat,
                        n,
                        v,
                        &SpringInput { stiffness, compliance: None },
                        damping,
                        limit,
                        dt,
                        dt,
                        true,
                    );
                    let l = line(&mut straight, velocity, stiffness, damping, limit, dt, dt);
                    for (sum, (force, s)) in sums
                        .iter_mut()
                        .zip([(p.force.x, (p.dashpot, p.friction)), (l.force, (l.dashpot, l.friction))])
                    {
                        let case = format!("{s:?}, damping {damping}, velocity {velocity}");
                        assert!(s.0 >= 0.0 && s.1 >= 0.0, "{case}");
                        assert!(straight.abs() <= limit / stiffness * (1.0 + 1e-12), "{case}");
                        *sum = [sum[0] - force * velocity * dt, sum[1] + s.0, sum[2] + s.1];
                    }
                }
                stored = 0.5 * stiffness * straight * straight - stored;
                assert!((flat.x - straight).abs() < 1e-15);
                for [work, dashpot, friction] in sums {
                    assert!(
                        (work - stored - dashpot - friction).abs() < 0.02 * work,
                        "{work:e} {stored:e} {dashpot:e} {friction:e}"
                    );
                    let slides = velocity.abs() > 0.1 && damping * velocity.abs() < limit;
                    assert!(friction > 0.1 * work || !slides, "{friction:e} of {work:e}");
                }
            }
        }
    }
}
