//! Pairs whose bond has broken, until they separate.
//!
//! Bonded spheres may overlap, or may be pressed together by the bond alone. Their contact acts on the overlap beyond a
//! reference d₀, which is chosen in the moment of the break: the contact takes over the pressure that the bond carried,
//! but never more than lets it store the energy that the bond had stored in that pressure. So the pressure goes on
//! without a jump where the contact is at least as stiff as the bond, and the break creates no energy in any case.
//! A bond broken in tension leaves d₀ = the overlap, or 0 for spheres apart.
//!
//! Once the contact has ended and the spheres have no overlap, the pair goes to the ordinary contacts; this is looked
//! at after fixed numbers of steps, so that it depends neither on the search nor on a restart.

use super::pass::BondSlot;
use crate::Vec3;
use crate::error::Partner;
use crate::law::{ContactGeometry, ContactLaw, History, with_law};
use crate::model::Model;
use crate::state::{Block, State, xyz};
use crate::work::Failure;
use serde::{Deserialize, Serialize};

/// Steps between two looks at which pairs have separated.
const EVERY: u64 = 100;

/// A pair that was bonded.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Remnant {
    /// Number of the bond in the model.
    pub number: u32,
    /// Place of the first body in its block; block and place of the second.
    pub i: u32,
    pub block: u32,
    pub j: u32,
    /// Overlap that does not count, d₀ [m].
    pub reference: f64,
    pub history: History,
}

/// The largest overlap at which a contact presses no harder than `pressure` [N] and stores no more than `energy` [J].
/// `stored` is the energy of the contact at an overlap.
pub(crate) fn overlap_for(stored: impl Fn(f64) -> f64, radius: f64, pressure: f64, energy: f64) -> f64 {
    let fits = |d: f64| {
        let step = 1e-4 * d;
        stored(d) <= energy && stored(d + step) - stored(d - step) <= 2.0 * step * pressure
    };
    let (mut low, mut high) = (0.0, 2.0 * radius);
    if pressure <= 0.0 || !stored(high).is_finite() {
        return 0.0;
    }
    // Down to the scale of the answer, then by halves.
    while high > 1e-12 * radius && !fits(0.5 * high) {
        high *= 0.5;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

/// Geometry of a pair now: that of its contact, overlap beyond the reference; and the whole overlap [m].
pub(crate) fn geometry(a: &Block, i: usize, b: &Block, j: usize, reference: f64) -> (ContactGeometry, f64) {
    let (p, q) = (&a.centre[i], &b.centre[j]);
    let between = xyz(p) - xyz(q);
    let distance = between.norm();
    let normal = if distance > 0.0 { between / distance } else { Vec3::z() };
    let overlap = p[3] + q[3] - distance;
    let point = xyz(p) - normal * (p[3] - 0.5 * overlap);
    let radius = p[3] * q[3] / (p[3] + q[3]);
    (ContactGeometry { point, normal, overlap: overlap - reference, radius }, overlap)
}

/// What a contact dissipated in dashpot and friction [J], and its failure.
pub(crate) type Spent = (f64, f64, Option<Failure>);

/// The contact of one pair; `a` and `b` are the blocks of its bodies.
pub(crate) fn contact(model: &Model, a: &Block, b: &Block, r: &mut Remnant, dt: f64) -> (BondSlot, Spent) {
    let (i, j) = (r.i as usize, r.j as usize);
    let materials = [a.spin[i][3] as u32, b.spin[j][3] as u32];
    let (g, overlap) = geometry(a, i, b, j, r.reference);
    if g.overlap <= 0.0 {
        let friction = if r.history.is_fresh() {
            0.0
        } else {
            with_law!(&model.laws, laws => laws.get(materials[0], materials[1]).release(&mut r.history))
        };
        return (BondSlot::default(), (0.0, friction, None));
    }
    let (arm_a, arm_b) = (g.point - xyz(&a.centre[i]), g.point - xyz(&b.centre[j]));
    let relative = xyz(&a.velocity[i]) + xyz(&a.spin[i]).cross(&arm_a)
        - xyz(&b.velocity[j])
        - xyz(&b.spin[j]).cross(&arm_b);
    let mass = 1.0 / (a.velocity[i][3] + b.velocity[j][3]);
    let spin = xyz(&a.spin[i]) - xyz(&b.spin[j]);
    let f = with_law!(&model.laws, laws => {
        laws.get(materials[0], materials[1]).evaluate_one(mass, &g, &relative, &spin, &mut r.history, dt)
    });
    let bound = a.centre[i][3].min(b.centre[j][3]);
    let failure = (overlap > bound).then(|| Failure::Overlap {
        body: a.bodies[i],
        partner: Partner::Body(b.bodies[j] as usize),
        overlap,
        bound,
    });
    let slot = BondSlot::new(f.force, arm_a.cross(&f.force) + f.moment, -arm_b.cross(&f.force) - f.moment);
    (slot, (f.dashpot, f.friction, failure))
}

/// Hands pairs that have separated over to the ordinary contacts, at its time.
pub(crate) fn hand_over(state: &mut State) -> bool {
    if !state.steps.is_multiple_of(EVERY) {
        return false;
    }
    let State { blocks, bonds, .. } = &mut *state;
    let mut lists: Vec<_> = blocks.iter_mut().map(|b| std::mem::take(&mut b.bonds.remnants)).collect();
    let mut cross: Vec<_> = bonds.cross.iter_mut().map(|l| std::mem::take(&mut l.remnants)).collect();
    let before: usize = lists.iter().chain(&cross).map(Vec::len).sum();
    for (b, list) in lists.iter_mut().enumerate() {
        let keep = |r: &Remnant, other: usize| {
            let (_, overlap) = geometry(&blocks[b], r.i as usize, &blocks[other], r.j as usize, 0.0);
            !r.history.is_fresh() || overlap > 0.0
        };
        list.retain(|r| keep(r, b));
        if let Some(cross) = cross.get_mut(b) {
            cross.retain(|r| keep(r, r.block as usize));
        }
    }
    let after: usize = lists.iter().chain(&cross).map(Vec::len).sum();
    blocks.iter_mut().zip(lists).for_each(|(b, list)| b.bonds.remnants = list);
    bonds.cross.iter_mut().zip(cross).for_each(|(b, list)| b.remnants = list);
    // The pairs are to be found as neighbours from now on.
    state.stale |= after < before;
    after < before
}
