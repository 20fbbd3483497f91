//! Single contacts of boxes, corners, images, debonded pairs, vertices and measures.

use crate::base::Vec3;
use crate::bodies::block::PointMotion;
use crate::bodies::sums::DashpotSum;
use crate::lanes::vec4::xyz;
use crate::lanes::{Real, Simd, V3};
use crate::law::{ContactForce, ContactGeometry, ContactLaw, History, Laws, with_law};

#[derive(Clone, Copy)]
pub struct StepContext<'a> {
    pub laws: &'a Laws,
    pub simd: Simd,
    pub dt: f64,
}

pub struct PairForce {
    /// Force on a, opposite on b [N].
    pub force: Vec3,
    /// Torques about the centres [N m].
    pub torque_a: Vec3,
    pub torque_b: Vec3,
    /// Rolling and twisting moment on a [N m].
    pub moment: Vec3,
    /// Dashpot; sliding, rolling and twisting loss [J].
    pub dashpot: f64,
    pub friction: f64,
}

/// Force over a step `dt` [s]. `share`: contacts sharing the pair's mass; `friction` replaces the law's
/// coefficient.
pub fn between(
    laws: &Laws,
    materials: [u32; 2],
    friction: Option<f64>,
    geometry: &ContactGeometry,
    (a, b): (&PointMotion, &PointMotion),
    share: f64,
    history: &mut History,
    dt: f64,
) -> PairForce {
    let (p, q) = (moving(a), moving(b));
    let inverse_mass = (p.inverse_mass + q.inverse_mass) * share;
    let (velocity, spin) = p.against(&q);
    let (velocity, spin) = (velocity.to_vec(), spin.to_vec());
    let f = evaluate(laws, materials, friction, inverse_mass, geometry, &velocity, &spin, history, dt);
    let (torque_a, torque_b) = p.torques(&q, V3::from_vec(&f.force), V3::from_vec(&f.moment));
    PairForce {
        force: f.force,
        torque_a: torque_a.to_vec(),
        torque_b: torque_b.to_vec(),
        moment: f.moment,
        dashpot: f.dashpot,
        friction: f.friction,
    }
}

fn moving(m: &PointMotion) -> Moving<f64> {
    let [velocity, spin, arm] = [xyz(&m.velocity), m.spin(), m.arm].map(|v| V3::from_vec(&v));
    Moving { velocity, spin, arm, inverse_mass: m.inverse_mass() }
}

#[derive(Clone, Copy, Debug)]
pub struct Moving<R> {
    pub velocity: V3<R>,
    pub spin: V3<R>,
    pub arm: V3<R>,
    pub inverse_mass: R,
}

impl<R: Real> Moving<R> {
    #[inline(always)]
    fn at_point(&self) -> V3<R> {
        self.velocity + self.spin.cross(self.arm)
    }

    #[inline(always)]
    pub fn against(&self, other: &Moving<R>) -> (V3<R>, V3<R>) {
        (self.at_point() - other.at_point(), self.spin - other.spin)
    }

    /// Torques on both bodies of force and moment on this one.
    #[inline(always)]
    pub fn torques(&self, other: &Moving<R>, force: V3<R>, moment: V3<R>) -> (V3<R>, V3<R>) {
        (self.arm.cross(force) + moment, -(other.arm.cross(force) + moment))
    }
}

/// `friction` replaces the law's coefficient.
pub fn evaluate(
    laws: &Laws,
    [a, b]: [u32; 2],
    friction: Option<f64>,
    inverse_mass: f64,
    geometry: &ContactGeometry,
    velocity: &Vec3,
    spin: &Vec3,
    history: &mut History,
    dt: f64,
) -> ContactForce {
    with_law!(laws, laws => match friction {
        None => laws.get(a, b).evaluate_one(inverse_mass, geometry, velocity, spin, history, dt),
        Some(it) => {
            let law = laws.get(a, b).with_friction(it);
            law.evaluate_one(inverse_mass, geometry, velocity, spin, history, dt)
        }
    })
}

/// Ends a contact; returns the energy left [J].
pub fn end(laws: &Laws, [a, b]: [u32; 2], history: &mut History) -> f64 {
    if history.is_new() {
        return 0.0;
    }
    with_law!(laws, laws => laws.get(a, b).release(history))
}

/// Normal spring force [N] and tangential stiffness [N/m].
pub fn springs(laws: &Laws, [a, b]: [u32; 2], overlap: f64, radius: f64, history: &History) -> (f64, f64) {
    with_law!(laws, laws => laws.get(a, b).springs(overlap, radius, history))
}

/// Adds the dashpot part of `force` [N] to `sum`; `before`, `after`: history.
pub fn add_dashpot(
    sum: &mut DashpotSum,
    laws: &Laws,
    [a, b]: [u32; 2],
    geometry: &ContactGeometry,
    [before, after]: [&History; 2],
    force: &Vec3,
    weight: f64,
) {
    let (normal, tangential) = springs(laws, [a, b], geometry.overlap, geometry.radius, after);
    let dashpot = (force - geometry.normal * normal + after.spring * tangential) * weight;
    // Other history than approach speed: no extrapolation.
    if before.is_new() || laws.initial_state(a, b, 1.0) == 0.0 {
        sum.latest += dashpot;
    } else {
        sum.extrapolated += dashpot;
    }
}
