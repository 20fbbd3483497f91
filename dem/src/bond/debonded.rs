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

use super::slot::BondSlot;
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::contact::single;
use crate::lanes::record::xyz;
use crate::law::{ContactGeometry, History, Laws};
use serde::{Deserialize, Serialize};

/// Steps between two looks at which pairs have separated.
pub(crate) const EVERY: u64 = 100;

/// A pair that was bonded.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct DebondedPair {
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

/// The contact of a debonded pair: its forces, what it dissipated [J], and its failure.
pub(crate) struct PairForces {
    pub slot: BondSlot,
    pub dashpot: f64,
    pub friction: f64,
    pub failure: Option<Failure>,
}

/// The contact of one pair; `a` and `b` are the blocks of its bodies.
pub(crate) fn contact(laws: &Laws, a: &Block, b: &Block, r: &mut DebondedPair, dt: f64) -> PairForces {
    let (i, j) = (r.i as usize, r.j as usize);
    let materials = [a.material(i), b.material(j)];
    let (g, overlap) = geometry(a, i, b, j, r.reference);
    if g.overlap <= 0.0 {
        let friction = single::end(laws, materials, &mut r.history);
        return PairForces { slot: BondSlot::default(), dashpot: 0.0, friction, failure: None };
    }
    let (ma, mb) = (a.motion(i, &g.point), b.motion(j, &g.point));
    // In this order: the last bits of broken stones hang on it.
    let relative = ma.at_point() - xyz(&mb.velocity) - mb.spin().cross(&mb.arm);
    let inverse_mass = ma.inverse_mass() + mb.inverse_mass();
    let spin = ma.spin() - mb.spin();
    let f = single::evaluate(laws, materials, inverse_mass, &g, &relative, &spin, &mut r.history, dt);
    let bound = a.centre[i][3].min(b.centre[j][3]);
    let failure = (overlap > bound).then(|| Failure::Overlap {
        body: a.bodies[i],
        partner: Partner::Body(b.bodies[j] as usize),
        overlap,
        bound,
    });
    let slot = BondSlot::new(f.force, ma.arm.cross(&f.force) + f.moment, -mb.arm.cross(&f.force) - f.moment);
    PairForces { slot, dashpot: f.dashpot, friction: f.friction, failure }
}
