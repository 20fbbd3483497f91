//! Contacts with planes: spheres by lanes of four, corners of boxes one by one.

use super::groups::Groups;
use super::pass::{Mix, Taken, bodies, motion, present, recall, records, remember, rows, wide};
use super::{Answer, ContactGeometry, ContactLaw, FRESH, PairTable, Touch};
use crate::Vec3;
use crate::detect;
use crate::error::Partner;
use crate::lanes::{Four, Kernel, V3};
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
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub w: &'a mut BlockWork,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Planes<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Four>(self) {
        let Planes { laws, planes, block, pairs, w, dt } = self;
        let mix = Mix::new(laws);
        let len = pairs.len();
        let mut taken = Taken::<R>::new();
        let (mut work, mut linear, mut angular) = (R::zero(), V3::<R>::zero(), V3::<R>::zero());
        let mut no_turn = [Lanes::default(); 4];
        let spheres = if RIGID { &w.spheres[..] } else { &block.centre[..] };
        for (g, group) in pairs.groups.iter_mut().enumerate() {
            let turn = if ROLL { &mut pairs.turns[g] } else { &mut no_turn };
            let names = group.names;
            let [i, plane] = [wide(&names[0]), wide(&names[1])];
            let body = bodies::<RIGID>(&w.owner, &names[0]);
            let there = present::<R>(len - 4 * g);
            let [x, y, z, r] = R::transpose(rows(spheres, &i));
            let [p, q, s, t] = plane;
            let (p, q, s, t) = (&planes[p], &planes[q], &planes[s], &planes[t]);
            let [nx, ny, nz, from] =
                R::transpose([R::load(&p.face), R::load(&q.face), R::load(&s.face), R::load(&t.face)]);
            let (position, normal) = (V3::new(x, y, z), V3::new(nx, ny, nz));
            let height = position.dot(normal) - from;
            let on = height.lt(r) & there;
            let mut memory = recall::<R, 2, ROLL>(group, turn);
            let ended = !on & memory.rate.lt(R::splat(FRESH));
            let [vx, vy, vz, material] = R::transpose([
                R::load(&p.motion),
                R::load(&q.motion),
                R::load(&s.motion),
                R::load(&t.motion),
            ]);
            let [wx, wy, wz, own] = R::transpose(rows(&block.spin, &body));
            let law = mix.of(own, material);
            if R::any(ended) {
                taken.friction = taken.friction + L::left::<R, ROLL>(&law, &memory).only(ended);
                remember::<R, 2, ROLL>(group, turn, &memory, on);
            }
            if !R::any(on) {
                continue;
            }
            let [ux, uy, uz, softness] = R::transpose(rows(&block.velocity, &body));
            let spin = V3::new(wx, wy, wz);
            let to_point = -(normal * height);
            let arm = if RIGID {
                let [cx, cy, cz, _] = R::transpose(rows(&block.centre, &body));
                position - V3::new(cx, cy, cz) + to_point
            } else {
                to_point
            };
            let wall = V3::new(vx, vy, vz);
            let velocity = V3::new(ux, uy, uz) + spin.cross(arm) - wall;
            let mass = R::splat(1.0) / softness;
            let touch = Touch { mass, radius: r, overlap: r - height, normal, velocity, spin };
            let Answer { force, moment, dashpot, friction, .. } =
                L::answer::<R, ROLL>(&law, &touch, &mut memory, on, dt);
            remember::<R, 2, ROLL>(group, turn, &memory, on);
            taken.dashpot = taken.dashpot + dashpot.only(on);
            taken.friction = taken.friction + friction.only(on);
            let force = force.only(on);
            let mut torque = arm.cross(force);
            let mut about_origin = (position + to_point).cross(force);
            if ROLL {
                torque = torque + moment.only(on);
                about_origin = about_origin + moment.only(on);
            }
            work = work + force.dot(wall);
            linear = linear + force;
            angular = angular + about_origin;
            let (forces, torques) = (records(force), records(torque));
            for l in 0..4 {
                let (force, torque) = w.sums[body[l]].both();
                (R::load(force) + forces[l]).store(force);
                (R::load(torque) + torques[l]).store(torque);
            }
            let deep = R::bits((touch.overlap).gt(r) & on);
            if deep != 0 && w.failure.is_none() {
                let l = deep.trailing_zeros() as usize;
                w.failure = Some(Failure::Overlap {
                    body: block.bodies[body[l]],
                    partner: Partner::Plane(plane[l]),
                    overlap: touch.overlap.array()[l],
                    bound: r.array()[l],
                });
            }
        }
        let ledger = &mut w.ledger;
        ledger.dissipated_dashpot += taken.dashpot.sum();
        ledger.dissipated_friction += taken.friction.sum();
        ledger.work_walls += work.sum() * dt;
        ledger.walls.linear += Vec3::new(linear.x.sum(), linear.y.sum(), linear.z.sum()) * dt;
        ledger.walls.angular += Vec3::new(angular.x.sum(), angular.y.sum(), angular.z.sum()) * dt;
    }
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
        let f = law.respond(1.0 / ma.velocity[3], &g, &relative, &ma.spin(), &mut history, dt);
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
