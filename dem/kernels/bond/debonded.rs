//! Debonded pairs, until they separate.
//!
//! The contact acts on the overlap beyond a reference d₀, so that it takes over the bond's compression but
//! stores at most its energy.
//!
//! Separated pairs become ordinary contacts, at fixed steps for reproducible restarts.
//!
//! Theory manual: equation (2.14) of `docs/theory/shapes.md`.

use super::slot::BondSlot;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::contact::scalar;
use crate::lanes::vec4::Vec4;
use crate::lanes::{Real, V3};
use crate::law::{ContactGeometry, ContactLaw, History, HistoryLanes, LawInput, Laws, with_law};
use serde::{Deserialize, Serialize};

pub const EVERY: u64 = 100;

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct DebondedPair {
    /// Bond index.
    pub number: u32,
    /// Slot of the first body; block and slot of the second.
    pub i: u32,
    pub block: u32,
    pub j: u32,
    /// Reference overlap d₀ [m].
    pub reference: f64,
    pub history: History,
}

/// Largest overlap with force at most `pressure` [N] and energy at most `energy` [J]; `stored`: contact
/// energy at an overlap.
pub fn overlap_for(stored: impl Fn(f64) -> f64, radius: f64, pressure: f64, energy: f64) -> f64 {
    let fits = |d: f64| {
        let step = 1e-4 * d;
        stored(d) <= energy && stored(d + step) - stored(d - step) <= 2.0 * step * pressure
    };
    let (mut low, mut high) = (0.0, 2.0 * radius);
    if pressure <= 0.0 || !stored(high).is_finite() {
        return 0.0;
    }
    // Find the scale, then bisect.
    while high > 1e-12 * radius && !fits(0.5 * high) {
        high *= 0.5;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

#[derive(Clone, Copy, Debug)]
pub struct Sphere<R> {
    pub x: V3<R>,
    pub radius: R,
    pub v: V3<R>,
    pub inverse_mass: R,
    pub w: V3<R>,
}

/// Normal from b to a, contact point, overlap, effective radius.
#[derive(Clone, Copy, Debug)]
pub struct DebondedContact<R> {
    pub normal: V3<R>,
    pub point: V3<R>,
    pub overlap: R,
    pub radius: R,
}

#[inline(always)]
pub fn meet<R: Real>(a: &Sphere<R>, b: &Sphere<R>) -> DebondedContact<R> {
    let between = a.x - b.x;
    let distance = between.norm2().sqrt();
    let unit = V3::new(between.x / distance, between.y / distance, between.z / distance);
    let upward = V3::new(R::zero(), R::zero(), R::splat(1.0));
    let normal = V3::select(R::zero().lt(distance), unit, upward);
    let overlap = a.radius + b.radius - distance;
    let point = a.x - normal * (a.radius - R::splat(0.5) * overlap);
    DebondedContact { normal, point, overlap, radius: a.radius * b.radius / (a.radius + b.radius) }
}

/// Force on a, torques on both, dissipation [J].
pub struct Forces<R> {
    pub force: V3<R>,
    pub torque_a: V3<R>,
    pub torque_b: V3<R>,
    pub dashpot: R,
    pub friction: R,
}

/// Force beyond the reference over a step [s]; updates contact history.
#[inline(always)]
pub fn forces<L: ContactLaw, R: Real, const ROLLING: bool>(
    law: &L::Lanes<R>,
    (a, b): (&Sphere<R>, &Sphere<R>),
    m: &DebondedContact<R>,
    reference: R,
    memory: &mut HistoryLanes<R>,
    on: R::Mask,
    step: R,
) -> Forces<R> {
    let (arm_a, arm_b) = (m.point - a.x, m.point - b.x);
    // The order of operations fixes rounding.
    let velocity = a.v + a.w.cross(arm_a) - b.v - b.w.cross(arm_b);
    let input = LawInput {
        inverse_mass: a.inverse_mass + b.inverse_mass,
        radius: m.radius,
        overlap: m.overlap - reference,
        normal: m.normal,
        velocity,
        spin: a.w - b.w,
    };
    let f = L::acting::<R, ROLLING>(law, &input, memory, on, step);
    Forces {
        force: f.force,
        torque_a: arm_a.cross(f.force) + f.moment,
        torque_b: -arm_b.cross(f.force) - f.moment,
        dashpot: f.dashpot,
        friction: f.friction,
    }
}

fn sphere(block: &Block, k: usize) -> Sphere<f64> {
    let (x, v, w) = (&block.centre[k], &block.velocity[k], &block.spin[k]);
    let vector = |r: &Vec4| V3::new(r[0], r[1], r[2]);
    Sphere { x: vector(x), radius: x[3], v: vector(v), inverse_mass: v[3], w: vector(w) }
}

/// Contact geometry with overlap beyond the reference; total overlap [m].
pub fn geometry(a: &Block, i: usize, b: &Block, j: usize, reference: f64) -> (ContactGeometry, f64) {
    let m = meet(&sphere(a, i), &sphere(b, j));
    let geometry = ContactGeometry {
        point: m.point.to_vec(),
        normal: m.normal.to_vec(),
        overlap: m.overlap - reference,
        radius: m.radius,
    };
    (geometry, m.overlap)
}

/// Forces, dissipation [J], failure.
pub struct PairForces {
    pub slot: BondSlot,
    pub dashpot: f64,
    pub friction: f64,
    pub failure: Option<Failure>,
}

pub fn contact(laws: &Laws, a: &Block, b: &Block, r: &mut DebondedPair, dt: f64) -> PairForces {
    let (i, j) = (r.i as usize, r.j as usize);
    let materials = [a.material(i), b.material(j)];
    let (p, q) = (sphere(a, i), sphere(b, j));
    let m = meet(&p, &q);
    if m.overlap - r.reference <= 0.0 {
        let friction = scalar::end(laws, materials, &mut r.history);
        return PairForces { slot: BondSlot::default(), dashpot: 0.0, friction, failure: None };
    }
    let mut memory = r.history.memory();
    let f = with_law!(laws, laws => {
        let law = laws.get(materials[0], materials[1]);
        of_one(law, (&p, &q), &m, r.reference, &mut memory, dt)
    });
    r.history = History::of(&memory);
    let bound = p.radius.min(q.radius);
    let failure = (m.overlap > bound).then(|| Failure::Overlap {
        body: a.bodies[i],
        partner: Partner::Body(b.bodies[j] as usize),
        overlap: m.overlap,
        bound,
    });
    let slot = BondSlot::new(f.force.to_vec(), f.torque_a.to_vec(), f.torque_b.to_vec());
    PairForces { slot, dashpot: f.dashpot, friction: f.friction, failure }
}

fn of_one<L: ContactLaw>(
    law: &L,
    spheres: (&Sphere<f64>, &Sphere<f64>),
    m: &DebondedContact<f64>,
    reference: f64,
    memory: &mut HistoryLanes<f64>,
    dt: f64,
) -> Forces<f64> {
    let lanes = law.splat::<f64>();
    if law.rolls() {
        forces::<L, f64, true>(&lanes, spheres, m, reference, memory, true, dt)
    } else {
        forces::<L, f64, false>(&lanes, spheres, m, reference, memory, true, dt)
    }
}
