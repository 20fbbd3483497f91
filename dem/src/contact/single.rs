//! One contact at a time: what boxes, corners, images, debonded pairs, vertices and measures share. The loops over lanes
//! (`sphere_pair.rs`, `planes.rs`, `patch_forces.rs`) do the same for many.

use crate::base::Vec3;
use crate::bodies::block::PointMotion;
use crate::bodies::sums::DashpotSum;
use crate::lanes::record::xyz;
use crate::lanes::{Real, Simd, V3};
use crate::law::{ContactForce, ContactGeometry, ContactLaw, History, Laws, with_law};

/// What all blocks share.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub laws: &'a Laws,
    pub simd: Simd,
    /// Time step [s].
    pub dt: f64,
}

/// What one contact does to both partners.
pub(crate) struct PairForce {
    /// Force on a [N]; b takes the opposite.
    pub force: Vec3,
    /// Torques about the centres [N m].
    pub torque_a: Vec3,
    pub torque_b: Vec3,
    /// Moment of rolling and twisting resistance on a, part of its torque [N m].
    pub moment: Vec3,
    /// Energy that dashpots, and that sliding, rolling and twisting took [J].
    pub dashpot: f64,
    pub friction: f64,
}

/// The force between bodies that move as `a` and `b` at the contact point, of the given materials, over a step `dt` [s]. `share`:
/// contacts of the two that carry their mass together; `friction`: a coefficient in place of that of the law.
pub(crate) fn between(
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

/// A body as a contact needs it: velocity, spin, the way from its centre to the contact point, and one over its mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving<R> {
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

    /// Velocity at the contact point and spin, relative to those of the other body.
    #[inline(always)]
    pub fn against(&self, other: &Moving<R>) -> (V3<R>, V3<R>) {
        (self.at_point() - other.at_point(), self.spin - other.spin)
    }

    /// Torques on this body and on the other of a force on this one and a moment of its own.
    #[inline(always)]
    pub fn torques(&self, other: &Moving<R>, force: V3<R>, moment: V3<R>) -> (V3<R>, V3<R>) {
        (self.arm.cross(force) + moment, -(other.arm.cross(force) + moment))
    }
}

/// The law of a pair of materials for one contact: see [`ContactLaw::evaluate_one`]. `friction`: a coefficient in place of its own.
pub(crate) fn evaluate(
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

/// Ends a contact, if it had begun: returns the energy left in its springs [J].
pub(crate) fn end(laws: &Laws, [a, b]: [u32; 2], history: &mut History) -> f64 {
    if history.is_fresh() {
        return 0.0;
    }
    with_law!(laws, laws => laws.get(a, b).release(history))
}

/// Force of the normal spring [N] and stiffness of the tangential spring [N/m] at an overlap and an effective radius [m].
pub(crate) fn springs(
    laws: &Laws,
    [a, b]: [u32; 2],
    overlap: f64,
    radius: f64,
    history: &History,
) -> (f64, f64) {
    with_law!(laws, laws => laws.get(a, b).springs(overlap, radius, history))
}

/// Adds to `sum` the part of a contact's `force` [N] that springs do not explain; `before` and `after`: memory of the contact before
/// and after this step.
pub(crate) fn add_dashpot(
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
    // A law that remembers another number than the approach speed extrapolates nothing.
    if before.is_fresh() || laws.begun(a, b, 1.0) == 0.0 {
        sum.latest += dashpot;
    } else {
        sum.extrapolated += dashpot;
    }
}
