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
//! Limits: no rolling or twisting resistance, no cohesion; overlaps small against the radii.

use super::restitution::damping_ratio;
use super::{ContactForce, ContactGeometry, ContactLaw, History};
use crate::Vec3;
use crate::material::{Material, PairOverride};

/// Constants of one pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Normal stiffness K [N/m].
    pub normal: f64,
    /// Tangential stiffness Ks [N/m].
    pub tangential: f64,
    /// 1/Ks [m/N], zero without a tangential spring.
    compliance: f64,
    /// C/√m* = 2ζ√K [√(N/m)].
    damping: f64,
    /// Cs/C [-].
    tangential_damping: f64,
    /// Friction coefficient [-].
    pub friction: f64,
    /// Damping ratio ζ [-].
    pub damping_ratio: f64,
}

/// 2xy/(x + y), also for infinite values.
fn harmonic(x: f64, y: f64) -> f64 {
    if x.is_infinite() {
        2.0 * y
    } else if y.is_infinite() {
        2.0 * x
    } else if x + y > 0.0 {
        2.0 * x * y / (x + y)
    } else {
        0.0
    }
}

impl ContactLaw for Linear {
    fn mix(a: &Material, b: &Material, exception: Option<&PairOverride>) -> Linear {
        let given = |pick: fn(&PairOverride) -> Option<f64>| exception.and_then(pick);
        let normal = given(|e| e.stiffness).unwrap_or(harmonic(a.stiffness, b.stiffness));
        let restitution = given(|e| e.restitution).unwrap_or(a.restitution.min(b.restitution));
        let tangential = normal * harmonic(a.tangential_ratio, b.tangential_ratio);
        let zeta = damping_ratio(restitution);
        Linear {
            normal,
            tangential,
            compliance: if tangential > 0.0 { 1.0 / tangential } else { 0.0 },
            damping: 2.0 * zeta * normal.sqrt(),
            tangential_damping: harmonic(a.tangential_damping_ratio, b.tangential_damping_ratio),
            friction: given(|e| e.friction).unwrap_or(a.friction.min(b.friction)),
            damping_ratio: zeta,
        }
    }

    #[inline(always)]
    fn respond(
        &self,
        mass: f64,
        geometry: &ContactGeometry,
        velocity: &Vec3,
        history: &mut History,
        dt: f64,
    ) -> ContactForce {
        let n = &geometry.normal;
        let rate = -velocity.dot(n);
        let slip_velocity = velocity + n * rate;

        // `now`: approach speed at this instant; `part`: share of the last step with contact; `weight`: of the dashpot.
        let (now, part, weight) = if history.is_fresh() {
            // Far above 1: the contact is there from the start of the run, not from within this step.
            let since = if rate > 0.0 { geometry.overlap / (rate * dt) } else { f64::INFINITY };
            let part = since.min(1.0);
            (rate, part, if since < 1.5 { part + 0.5 } else { 1.0 })
        } else {
            (1.5 * rate - 0.5 * history.rate, 1.0, 1.0)
        };
        history.rate = rate;

        let c = self.damping * mass.sqrt();
        let elastic = self.normal * geometry.overlap;
        let normal = (elastic + weight * c * now).max(0.0);
        let mut dashpot = (normal - elastic) * now * dt;

        let along = history.spring.dot(n);
        let flat = history.spring - n * along;
        let flat2 = flat.norm_squared();
        // The projection shortens by half the square of the turn. Below a microradian per step that adds up to less
        // than 5e-7 of the whole angle turned, and the root and the division are spared.
        let before = if along * along > 1e-12 * flat2 {
            if flat2 > 0.0 { flat * (1.0 + along * along / flat2).sqrt() } else { Vec3::zeros() }
        } else {
            flat
        };
        let stretched = before + slip_velocity * (dt * part);
        let cs = c * self.tangential_damping;
        let viscous = slip_velocity * cs;
        let mut tangential = -(stretched * self.tangential + viscous);
        let mut friction = 0.0;
        let limit = self.friction * normal;
        let size2 = tangential.norm_squared();
        history.spring = stretched;
        dashpot += viscous.dot(&slip_velocity) * dt;
        if size2 > limit * limit {
            tangential *= limit / size2.sqrt();
            history.spring = -(tangential + viscous) * self.compliance;
            let slid = stretched - history.spring;
            // The spring's mean force over the slide; without a spring the dashpot did all the work.
            friction = if self.compliance > 0.0 {
                0.5 * self.tangential * slid.dot(&(history.spring + before))
            } else {
                -(tangential + viscous).dot(&slip_velocity) * dt
            };
        }
        ContactForce { force: n * normal + tangential, normal, dashpot, friction }
    }

    #[inline(always)]
    fn stored(&self, overlap: f64, _: f64, spring: &Vec3) -> (f64, f64) {
        (0.5 * self.normal * overlap * overlap, 0.5 * self.tangential * spring.norm_squared())
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STONE: Material = Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction: 0.5,
        restitution: 0.5,
    };

    fn touch(overlap: f64) -> ContactGeometry {
        ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: 0.01 }
    }

    #[test]
    fn stiffness_of_like_pair_and_rigid_wall() {
        let wall = Material { stiffness: f64::INFINITY, ..STONE };
        assert_eq!(Linear::mix(&STONE, &STONE, None).normal, 1e5);
        assert_eq!(Linear::mix(&STONE, &wall, None).normal, 2e5);
        assert!(Linear::mix(&wall, &wall, None).normal.is_infinite());
    }

    #[test]
    fn coulomb_limit_in_every_direction_and_spring_shortened() {
        let law = Linear::mix(&STONE, &STONE, None);
        for k in 0..8 {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let velocity = Vec3::new(angle.cos(), angle.sin(), 0.0);
            let mut h = History { spring: Vec3::zeros(), rate: 0.0 };
            let mut force = Vec3::zeros();
            for _ in 0..100 {
                force = law.respond(0.1, &touch(1e-4), &velocity, &mut h, 1e-4).force;
            }
            let friction = Vec3::new(force.x, force.y, 0.0);
            assert!((friction + velocity * 5.0).norm() < 1e-12, "{friction}");
            assert!((h.spring * law.tangential + friction).norm() < 1e-12);
        }
    }

    #[test]
    fn spring_turns_with_the_tangent_plane_and_keeps_its_length() {
        let law = Linear::mix(&STONE, &STONE, None);
        let mut h = History { spring: Vec3::new(1e-6, 0.0, 0.0), rate: 0.0 };
        for k in 0..=100 {
            let a = f64::from(k) * 0.01;
            let normal = Vec3::new(-a.sin(), 0.0, a.cos());
            law.respond(0.1, &ContactGeometry { normal, ..touch(1e-4) }, &Vec3::zeros(), &mut h, 1e-4);
        }
        let expected = Vec3::new(1.0_f64.cos(), 0.0, 1.0_f64.sin()) * 1e-6;
        assert!((h.spring - expected).norm() < 1e-18, "{}", h.spring);
    }
}
