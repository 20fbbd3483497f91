//! Sphere–sphere contacts in lanes. Separated pairs add zeros, which leave sums bitwise unchanged.
//!
//! Theory manual: eq. (1.1), `docs/theory/contacts.md`.

use super::body_lanes::BodyLanes;
use super::group_history::{Dissipation, LawLanes, load_history, store_history};
use crate::lanes::vec4::Vec4;
use crate::lanes::{Real, SimdPack, V3};
use crate::law::{ContactLaw, HistoryLanes, LawInput, LawOutput, NO_CONTACT};
use crate::pairs::groups::Springs;

/// `last` (1, 0 or −1) scales the fourth number.
#[inline(always)]
fn difference<R: SimdPack>(p: [R; 4], q: [R; 4], last: f64) -> [R; 4] {
    let sign = R::record(&[1.0, 1.0, 1.0, last]);
    R::columns([p[0].less(q[0], sign), p[1].less(q[1], sign), p[2].less(q[2], sign), p[3].less(q[3], sign)])
}

/// Sphere pair in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Pair<R> {
    /// Vector from b to a, and its squared length.
    pub between: V3<R>,
    pub distance2: R,
    /// Sum of radii, and radius of a.
    pub reach: R,
    pub radius: R,
    /// Relative velocity, a minus b; sum of inverse masses.
    pub velocity: V3<R>,
    pub inverse_mass: R,
    pub spins: (V3<R>, V3<R>),
    /// Body to sphere centres, unless single spheres.
    pub offsets: (V3<R>, V3<R>),
}

/// Force on a, torques, dissipation, excessive overlaps.
pub struct Forces<R: Real> {
    pub force: V3<R>,
    pub torque_a: V3<R>,
    pub torque_b: V3<R>,
    /// Single spheres: force × normal, lever arms.
    pub moment: V3<R>,
    pub levers: (R, R),
    pub dashpot: R,
    pub friction: R,
    /// Overlap above the smaller radius; both values.
    pub deep: R::Mask,
    pub overlap: R,
    pub bound: R,
}

struct Approach<R: Real> {
    input: LawInput<R>,
    radii: (R, R),
    /// Sphere centres to contact point.
    levers: (R, R),
    /// Body centres to contact point; zero for single spheres.
    arms: (V3<R>, V3<R>),
}

impl<R: Real> Approach<R> {
    #[inline(always)]
    fn new<const CLUMPS: bool>(pair: &Pair<R>) -> Approach<R> {
        let &Pair { between, distance2, reach, velocity: translation, inverse_mass, spins: (wa, wb), .. } =
            pair;
        let distance = distance2.sqrt();
        // distance/distance²: the division need not wait for the root.
        let mut normal = between * (distance * (R::splat(1.0) / distance2));
        let apart = R::zero().lt(distance);
        if !R::all(apart) {
            normal = V3::select(apart, normal, V3::new(R::zero(), R::zero(), R::splat(1.0)));
        }
        let overlap = reach - distance;
        let ra = pair.radius;
        let rb = reach - ra;
        // The contact point halves the overlap.
        let la = ra - R::splat(0.5) * overlap;
        let lb = distance - la;
        let (mut arm_a, mut arm_b) = (V3::zero(), V3::zero());
        let velocity = if CLUMPS {
            arm_a = pair.offsets.0 - normal * la;
            arm_b = pair.offsets.1 + normal * lb;
            translation + wa.cross(arm_a) - wb.cross(arm_b)
        } else {
            translation + normal.cross(wa * la + wb * lb)
        };
        let input =
            LawInput { inverse_mass, radius: ra * rb / reach, overlap, normal, velocity, spin: wa - wb };
        Approach { input, radii: (ra, rb), levers: (la, lb), arms: (arm_a, arm_b) }
    }
}

/// Forces in lanes `on` over a step [s]; advances history.
#[inline(always)]
pub fn forces<L: ContactLaw, R: Real, const CLUMPS: bool, const ROLLING: bool>(
    law: &L::Lanes<R>,
    pair: &Pair<R>,
    memory: &mut HistoryLanes<R>,
    on: R::Mask,
    step: R,
) -> Forces<R> {
    let m = Approach::<R>::new::<CLUMPS>(pair);
    let overlap = m.input.overlap;
    let LawOutput { force, moment, dashpot, friction, .. } =
        L::acting::<R, ROLLING>(law, &m.input, memory, on, step);
    let force = force.only(on);
    let lever = force.cross(m.input.normal).only(on);
    let (la, lb) = m.levers;
    let (mut torque_a, mut torque_b) =
        if CLUMPS { (m.arms.0.cross(force), -m.arms.1.cross(force)) } else { (lever * la, lever * lb) };
    if CLUMPS || ROLLING {
        let moment = moment.only(on);
        torque_a = (torque_a + moment).only(on);
        torque_b = (torque_b - moment).only(on);
    }
    let bound = m.radii.0.min(m.radii.1);
    Forces {
        force,
        torque_a,
        torque_b,
        moment: lever,
        levers: (la, lb),
        dashpot: dashpot.only(on),
        friction: friction.only(on),
        deep: overlap.gt(bound) & on,
        overlap,
        bound,
    }
}

pub struct Outcome<R: Real> {
    pub forces: Forces<R>,
    pub on: R::Mask,
    /// Lanes with overlap above the smaller radius.
    pub deep: u32,
}

impl<R: SimdPack> Outcome<R> {
    /// First excessive overlap: list index (lanes start at group `g`), overlap, limit.
    #[cold]
    pub fn too_deep(&self, g: usize) -> (usize, f64, f64) {
        let l = self.deep.trailing_zeros() as usize;
        (4 * g + l, self.forces.overlap.numbers()[l], self.forces.bound.numbers()[l])
    }
}

/// `between` from b to a, `distance2` its square, `reach` the sum of radii.
#[inline(always)]
fn pair<R: SimdPack, const CLUMPS: bool>(
    a: &impl BodyLanes,
    b: &impl BodyLanes,
    (xa, xb): ([R; 4], [R; 4]),
    (between, distance2, reach): (V3<R>, R, R),
) -> (Pair<R>, (R, R)) {
    let (va, wa) = R::two_rows(|l| (a.velocity(l), a.spin(l)));
    let (vb, wb) = R::two_rows(|l| (b.velocity(l), b.spin(l)));
    let radius = R::columns(xa)[3];
    let [ux, uy, uz, inverse_mass] = difference(va, vb, -1.0);
    let [wax, way, waz, ma] = R::columns(wa);
    let [wbx, wby, wbz, mb] = R::columns(wb);
    let spins = (V3::new(wax, way, waz), V3::new(wbx, wby, wbz));
    let mut offsets = (V3::zero(), V3::zero());
    if CLUMPS {
        let [ax, ay, az, _] = difference(xa, R::rows(|l| a.centre(l)), 0.0);
        let [bx, by, bz, _] = difference(xb, R::rows(|l| b.centre(l)), 0.0);
        offsets = (V3::new(ax, ay, az), V3::new(bx, by, bz));
    }
    let velocity = V3::new(ux, uy, uz);
    (Pair { between, distance2, reach, radius, velocity, inverse_mass, spins, offsets }, (ma, mb))
}

/// `None` without contact. `law` mixes constants in lanes.
#[inline(always)]
pub fn contacts<L: ContactLaw, R: SimdPack, const CLUMPS: bool, const ROLLING: bool>(
    law: &LawLanes<'_, L, R>,
    a: &impl BodyLanes,
    b: &impl BodyLanes,
    mut springs: (&mut Springs, &mut Springs),
    mut turns: (&mut [Vec4; 4], &mut [Vec4; 4]),
    present: R::Mask,
    dissipated: &mut Dissipation<R::Quad>,
    dt: f64,
) -> Option<Outcome<R>> {
    // One transposition serves both partners.
    let (xa, xb) = (R::rows(|l| a.sphere(l)), R::rows(|l| b.sphere(l)));
    let [dx, dy, dz, reach] = difference(xa, xb, -1.0);
    let between = V3::new(dx, dy, dz);
    let distance2 = between.norm2();
    let on = distance2.lt(reach * reach) & present;
    let mut memory = load_history::<R, ROLLING>(&springs, &turns);
    let ended = !on & memory.rate.lt(R::splat(NO_CONTACT));
    if R::any(ended) {
        let (ma, mb) = (R::columns(R::rows(|l| a.spin(l)))[3], R::columns(R::rows(|l| b.spin(l)))[3]);
        let left = L::tangential_energy::<R, ROLLING>(&law.of(ma, mb), &memory).only(ended);
        dissipated.friction = left.add_to(dissipated.friction);
        store_history::<R, ROLLING>(&mut springs, &mut turns, &memory, on);
    }
    if !R::any(on) {
        return None;
    }
    let (m, materials) = pair::<R, CLUMPS>(a, b, (xa, xb), (between, distance2, reach));
    let law = law.of(materials.0, materials.1);
    let forces = forces::<L, R, CLUMPS, ROLLING>(&law, &m, &mut memory, on, R::splat(dt));
    store_history::<R, ROLLING>(&mut springs, &mut turns, &memory, on);
    dissipated.dashpot = forces.dashpot.add_to(dissipated.dashpot);
    dissipated.friction = forces.friction.add_to(dissipated.friction);
    let deep = R::mask_bits(forces.deep);
    Some(Outcome { forces, on, deep })
}
