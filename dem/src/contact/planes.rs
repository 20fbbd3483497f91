//! Contacts with planes: spheres by lanes of four, corners of boxes one by one.

use super::groups::{Group, Groups};
use super::pass::{End, Mix, Own, Taken, motion, recall, records, remember, side_by_side, within};
use crate::Vec3;
use crate::detect;
use crate::error::Partner;
use crate::lanes::{Four, Kernel, Pack, Real, V3};
use crate::law::{ContactGeometry, ContactLaw, FRESH, LawInput, LawOutput, PairTable};
use crate::model::Model;
use crate::shape::cuboid;
use crate::state::{Block, Lanes, xyz};
use crate::wall::state::WallMotion;
use crate::work::{BlockWork, Failure};

/// A plane where it is now: unit normal and its product with a point; velocity and material.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneNow {
    face: Lanes,
    motion: Lanes,
}

/// The planes as they are at this time.
pub(crate) fn now(model: &Model, motions: &[WallMotion], out: &mut Vec<PlaneNow>) {
    out.clear();
    out.extend(model.planes.iter().zip(motions).map(|(p, m)| {
        let (n, v) = (&p.normal, &m.velocity);
        PlaneNow {
            face: Lanes([n.x, n.y, n.z, (p.point + m.offset).dot(n)]),
            motion: Lanes([v.x, v.y, v.z, p.material as f64]),
        }
    }));
}

/// Spheres of a block against planes.
pub(crate) struct Planes<'a, L, const RIGID: bool, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub planes: &'a [PlaneNow],
    /// The material of all planes, where there is only one.
    pub material: Option<u32>,
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub w: &'a mut BlockWork,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Planes<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let Planes { laws, planes, material, block, pairs, w, dt } = self;
        assert!(RIGID || within(block, w, pairs.most()[0]), "names of contacts are places of bodies");
        let mut sums = std::mem::take(&mut w.sums);
        let own = &*w;
        let mut failure = None;
        let mix = Mix::<L, R>::new(laws, own.material, material);
        let len = pairs.len();
        let mut taken = Taken::<R::Quad>::new();
        let zero = R::Quad::zero();
        let (mut work, mut linear, mut angular) = (zero, V3::<R::Quad>::zero(), V3::<R::Quad>::zero());
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Lanes::default(); 4], [Lanes::default(); 4]);
        for g in (0..len.div_ceil(4)).step_by(R::GROUPS) {
            let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
            let mut turns = if ROLL {
                side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
            } else {
                (&mut no_turn, &mut spare_turn)
            };
            let ((p, first), (q, second)) = (p.parts(), q.parts());
            let plane = |l: usize| if l < 4 { p[1][l] as usize } else { q[1][l - 4] as usize };
            // SAFETY: compared above.
            let body = unsafe { Own::<RIGID>::new::<R>(block, own, [&p[0], &q[0]]) };
            let (there, mut springs) = (R::below(len - 4 * g), (first, second));
            let [x, y, z, r] = R::columns(R::rows(|l| body.sphere(l)));
            let [nx, ny, nz, from] = R::columns(R::rows(|l| &planes[plane(l)].face));
            let (position, normal) = (V3::new(x, y, z), V3::new(nx, ny, nz));
            let height = position.dot(normal) - from;
            let on = height.lt(r) & there;
            let mut memory = recall::<R, ROLL>(&springs, &turns);
            let ended = !on & memory.rate.lt(R::splat(FRESH));
            let [vx, vy, vz, material] = R::columns(R::rows(|l| &planes[plane(l)].motion));
            let [wx, wy, wz, material_a] = R::columns(R::rows(|l| body.spin(l)));
            let law = mix.of(material_a, material);
            if R::any(ended) {
                let left = L::stored_in_springs::<R, ROLL>(&law, &memory).only(ended);
                taken.friction = left.add_to(taken.friction);
                remember::<R, ROLL>(&mut springs, &mut turns, &memory, on);
            }
            if !R::any(on) {
                continue;
            }
            let [ux, uy, uz, softness] = R::columns(R::rows(|l| body.velocity(l)));
            let spin = V3::new(wx, wy, wz);
            let to_point = -(normal * height);
            let arm = if RIGID {
                let [cx, cy, cz, _] = R::columns(R::rows(|l| body.centre(l)));
                position - V3::new(cx, cy, cz) + to_point
            } else {
                to_point
            };
            let wall = V3::new(vx, vy, vz);
            let velocity = V3::new(ux, uy, uz) + spin.cross(arm) - wall;
            let mass = R::splat(1.0) / softness;
            let touch = LawInput { mass, radius: r, overlap: r - height, normal, velocity, spin };
            let LawOutput { force, moment, dashpot, friction, .. } =
                L::evaluate::<R, ROLL>(&law, &touch, &mut memory, on, dt);
            remember::<R, ROLL>(&mut springs, &mut turns, &memory, on);
            taken.dashpot = dashpot.only(on).add_to(taken.dashpot);
            taken.friction = friction.only(on).add_to(taken.friction);
            let force = force.only(on);
            let mut torque = arm.cross(force);
            let mut about_origin = (position + to_point).cross(force);
            if ROLL {
                torque = torque + moment.only(on);
                about_origin = about_origin + moment.only(on);
            }
            work = force.dot(wall).add_to(work);
            linear = add(force, linear);
            angular = add(about_origin, angular);
            let records = records::<R>(force, torque);
            for l in 0..R::LANES {
                R::give(records[l], &mut sums[body.body(l)].0);
            }
            let deep = R::mask_bits((touch.overlap).gt(r) & on);
            if deep != 0 && failure.is_none() {
                let l = deep.trailing_zeros() as usize;
                failure = Some((4 * g + l, touch.overlap.numbers()[l], r.numbers()[l]));
            }
        }
        w.sums = sums;
        if let (Some((k, overlap, bound)), None) = (failure, w.failure) {
            let [sphere, plane] = pairs.name(k);
            let (body, partner) = (block.bodies[w.body(sphere) as usize], Partner::Plane(plane as usize));
            w.failure = Some(Failure::Overlap { body, partner, overlap, bound });
        }
        let ledger = &mut w.ledger;
        ledger.dissipated_dashpot += taken.dashpot.sum();
        ledger.dissipated_friction += taken.friction.sum();
        ledger.work_walls += work.sum() * dt;
        ledger.walls.linear += Vec3::new(linear.x.sum(), linear.y.sum(), linear.z.sum()) * dt;
        ledger.walls.angular += Vec3::new(angular.x.sum(), angular.y.sum(), angular.z.sum()) * dt;
    }
}

/// A sum of vectors and the vectors of each group.
#[inline(always)]
fn add<R: Pack>(v: V3<R>, sum: V3<R::Quad>) -> V3<R::Quad> {
    V3::new(v.x.add_to(sum.x), v.y.add_to(sum.y), v.z.add_to(sum.z))
}

/// Corners of the boxes of a block against planes.
pub(crate) fn corners<L: ContactLaw>(
    model: &Model,
    laws: &PairTable<L>,
    motions: &[WallMotion],
    block: &Block,
    pairs: &mut Groups<2>,
    w: &mut BlockWork,
    dt: f64,
) {
    for k in 0..pairs.len() {
        let [corner, index] = pairs.name(k).map(|n| n as usize);
        let (plane, wall) = (&model.planes[index], &motions[index]);
        let a = corner / 8;
        let half = w.half[a];
        let x = xyz(&block.centre[a]) + block.rotation[a].orientation * cuboid::corner(&half, corner % 8);
        let law = laws.get(block.spin[a][3] as u32, plane.material as u32);
        let mut history = pairs.history(k);
        let touch = detect::sphere_plane(&x, 0.0, &(plane.point + wall.offset), &plane.normal);
        // A corner has no radius of its own: laws that need one take the shortest half side.
        let Some(g) = touch.map(|g| ContactGeometry { radius: half.min(), ..g }) else {
            if !history.is_fresh() {
                w.ledger.dissipated_friction += law.release(&mut history);
                pairs.set_history(k, &history);
            }
            continue;
        };
        let ma = motion(block, a, &g.point);
        let relative = ma.at_point() - wall.velocity;
        let f = law.evaluate_one(1.0 / ma.velocity[3], &g, &relative, &ma.spin(), &mut history, dt);
        pairs.set_history(k, &history);
        w.ledger.dissipated_dashpot += f.dashpot;
        w.ledger.dissipated_friction += f.friction;
        w.ledger.work_walls += f.force.dot(&wall.velocity) * dt;
        w.ledger.walls.add(&g.point, &(f.force * dt));
        w.ledger.walls.angular += f.moment * dt;
        w.push(a, &f.force, &(ma.arm.cross(&f.force) + f.moment));
        let bound = half.min();
        if g.overlap > bound && w.failure.is_none() {
            let partner = Partner::Plane(index);
            w.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}
