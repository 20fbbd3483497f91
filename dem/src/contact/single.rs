//! One contact at a time: what boxes, corners, images, debonded pairs, vertices and measures share. The loops over lanes
//! (`sphere_pair.rs`, `planes.rs`, `patch_forces.rs`) do the same for many.

use crate::base::Vec3;
use crate::bodies::block::PointMotion;
use crate::lanes::Simd;
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
    let inverse_mass = (a.inverse_mass() + b.inverse_mass()) * share;
    let (velocity, spin) = (a.at_point() - b.at_point(), a.spin() - b.spin());
    let f = evaluate(laws, materials, friction, inverse_mass, geometry, &velocity, &spin, history, dt);
    PairForce {
        force: f.force,
        torque_a: a.arm.cross(&f.force) + f.moment,
        torque_b: -(b.arm.cross(&f.force) + f.moment),
        moment: f.moment,
        dashpot: f.dashpot,
        friction: f.friction,
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
