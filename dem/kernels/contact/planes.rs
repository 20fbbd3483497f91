//! Contacts with planes: spheres in lanes, box corners individually.

use super::body_lanes::{BodyLanes, LocalBodies, within};
use super::group_history::{Dissipation, LawLanes, load_history, records, side_by_side, store_history};
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::BlockTotals;
use crate::lanes::vec4::Vec4;
use crate::lanes::{Kernel, Real, Simd4, SimdPack, V3};
use crate::law::{ContactLaw, HistoryLanes, LawInput, LawOutput, NO_CONTACT, PairTable};
use crate::pairs::groups::{Group, Groups};
use crate::shape::plane::{Plane, PlaneMotion};

/// Unit normal and level; velocity, material.
#[derive(Clone, Copy, Debug)]
pub struct PlanePose {
    pub face: Vec4,
    pub motion: Vec4,
}

pub fn update_poses(planes: &[Plane], motions: &[PlaneMotion], out: &mut Vec<PlanePose>) {
    out.clear();
    out.extend(planes.iter().zip(motions).map(|(p, m)| {
        let (n, v) = (&p.normal, &m.velocity);
        PlanePose {
            face: Vec4([n.x, n.y, n.z, (p.point + m.offset).dot(n)]),
            motion: Vec4([v.x, v.y, v.z, p.material as f64]),
        }
    }));
}

pub struct Planes<'a, L, const CLUMPS: bool, const ROLLING: bool> {
    pub laws: &'a PairTable<L>,
    pub planes: &'a [PlanePose],
    pub material: Option<u32>,
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub members: &'a BlockBodies,
    pub totals: &'a mut BlockTotals,
    pub dt: f64,
}

impl<L: ContactLaw, const CLUMPS: bool, const ROLLING: bool> Kernel for Planes<'_, L, CLUMPS, ROLLING> {
    type Output = ();

    #[inline(always)]
    fn run<R: SimdPack>(self) {
        let Planes { laws, planes, material, block, pairs, members, totals, dt } = self;
        assert!(CLUMPS || within(block, totals, pairs.most()[0]), "names of contacts are places of bodies");
        let mut sums = std::mem::take(&mut totals.sums);
        let mut failure = None;
        let mix = LawLanes::<L, R>::new(laws, members.material, material);
        let len = pairs.len();
        let mut dissipated = Dissipation::<R::Quad>::new();
        let mut done = Done::<R::Quad>::new();
        let (mut spare, mut spare_turn, mut no_turn) =
            (Group::EMPTY, [Vec4::default(); 4], [Vec4::default(); 4]);
        for g in (0..len.div_ceil(4)).step_by(R::GROUPS) {
            let (p, q) = side_by_side::<R, _>(&mut pairs.groups[g..], &mut spare);
            let mut turns = if ROLLING {
                side_by_side::<R, _>(&mut pairs.turns[g..], &mut spare_turn)
            } else {
                (&mut no_turn, &mut spare_turn)
            };
            let ((p, first), (q, second)) = (p.parts(), q.parts());
            let plane = |l: usize| if l < 4 { p[1][l] as usize } else { q[1][l - 4] as usize };
            // SAFETY: compared above.
            let body = unsafe { LocalBodies::<CLUMPS>::new::<R>(block, members, [&p[0], &q[0]]) };
            let (there, mut springs) = (R::below(len - 4 * g), (first, second));
            let [x, y, z, r] = R::columns(R::rows(|l| body.sphere(l)));
            let [nx, ny, nz, from] = R::columns(R::rows(|l| &planes[plane(l)].face));
            let (position, normal) = (V3::new(x, y, z), V3::new(nx, ny, nz));
            let height = position.dot(normal) - from;
            let on = height.lt(r) & there;
            let mut memory = load_history::<R, ROLLING>(&springs, &turns);
            let ended = !on & memory.rate.lt(R::splat(NO_CONTACT));
            let [vx, vy, vz, material] = R::columns(R::rows(|l| &planes[plane(l)].motion));
            let [wx, wy, wz, material_a] = R::columns(R::rows(|l| body.spin(l)));
            let law = mix.of(material_a, material);
            if R::any(ended) {
                let left = L::tangential_energy::<R, ROLLING>(&law, &memory).only(ended);
                dissipated.friction = left.add_to(dissipated.friction);
                store_history::<R, ROLLING>(&mut springs, &mut turns, &memory, on);
            }
            if !R::any(on) {
                continue;
            }
            let [ux, uy, uz, inverse_mass] = R::columns(R::rows(|l| body.velocity(l)));
            let (velocity, spin) = (V3::new(ux, uy, uz), V3::new(wx, wy, wz));
            let wall = V3::new(vx, vy, vz);
            let offset = offset::<R, CLUMPS>(&body, position);
            let touch = PlaneContact {
                position,
                offset,
                radius: r,
                normal,
                height,
                velocity,
                inverse_mass,
                spin,
                wall,
            };
            let f = forces::<L, R, CLUMPS, ROLLING>(&law, &touch, &mut memory, on, R::splat(dt));
            store_history::<R, ROLLING>(&mut springs, &mut turns, &memory, on);
            dissipated.dashpot = f.dashpot.add_to(dissipated.dashpot);
            dissipated.friction = f.friction.add_to(dissipated.friction);
            done.add(&f);
            let records = records::<R>(f.force, f.torque);
            for l in 0..R::LANES {
                R::add_record(records[l], &mut sums[body.body(l)].0);
            }
            let deep = R::mask_bits(f.deep);
            if deep != 0 && failure.is_none() {
                let l = deep.trailing_zeros() as usize;
                failure = Some((4 * g + l, f.overlap.numbers()[l], r.numbers()[l]));
            }
        }
        totals.sums = sums;
        if let (Some((k, overlap, bound)), None) = (failure, totals.failure) {
            totals.failure = Some(too_deep(block, members, pairs.name(k), overlap, bound));
        }
        totals.balance.dissipated_dashpot += dissipated.dashpot.sum();
        totals.balance.dissipated_friction += dissipated.friction.sum();
        done.add_to_balance(&mut totals.balance, dt);
    }
}

/// Body centre to sphere centre; zero for single spheres.
#[inline(always)]
fn offset<R: SimdPack, const CLUMPS: bool>(body: &LocalBodies<'_, CLUMPS>, position: V3<R>) -> V3<R> {
    if CLUMPS {
        let [cx, cy, cz, _] = R::columns(R::rows(|l| body.centre(l)));
        position - V3::new(cx, cy, cz)
    } else {
        V3::zero()
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PlaneContact<R> {
    /// Sphere centre; relative to its body, unless a single sphere.
    pub position: V3<R>,
    pub offset: V3<R>,
    pub radius: R,
    /// Plane normal, height of the sphere centre.
    pub normal: V3<R>,
    pub height: R,
    /// Body velocity.
    pub velocity: V3<R>,
    pub inverse_mass: R,
    pub spin: V3<R>,
    /// Plane velocity.
    pub wall: V3<R>,
}

pub struct Forces<R: Real> {
    pub force: V3<R>,
    pub torque: V3<R>,
    pub dashpot: R,
    pub friction: R,
    pub power: R,
    pub about_origin: V3<R>,
    pub deep: R::Mask,
    pub overlap: R,
}

/// Forces in lanes `on` over a step [s]; advances history.
#[inline(always)]
pub fn forces<L: ContactLaw, R: Real, const CLUMPS: bool, const ROLLING: bool>(
    law: &L::Lanes<R>,
    t: &PlaneContact<R>,
    memory: &mut HistoryLanes<R>,
    on: R::Mask,
    step: R,
) -> Forces<R> {
    let to_point = -(t.normal * t.height);
    let arm = if CLUMPS { t.offset + to_point } else { to_point };
    let overlap = t.radius - t.height;
    let input = LawInput {
        inverse_mass: t.inverse_mass,
        radius: t.radius,
        overlap,
        normal: t.normal,
        velocity: t.velocity + t.spin.cross(arm) - t.wall,
        spin: t.spin,
    };
    let LawOutput { force, moment, dashpot, friction, .. } =
        L::acting::<R, ROLLING>(law, &input, memory, on, step);
    let force = force.only(on);
    let mut torque = arm.cross(force);
    let mut about_origin = (t.position + to_point).cross(force);
    if ROLLING {
        let moment = moment.only(on);
        torque = torque + moment;
        about_origin = about_origin + moment;
    }
    Forces {
        force,
        torque,
        dashpot: dashpot.only(on),
        friction: friction.only(on),
        power: force.dot(t.wall),
        about_origin,
        deep: overlap.gt(t.radius) & on,
        overlap,
    }
}

/// Overlap above the radius.
#[cold]
fn too_deep(block: &Block, members: &BlockBodies, name: [u32; 2], overlap: f64, bound: f64) -> Failure {
    let [sphere, plane] = name;
    let body = block.bodies[members.body(sphere) as usize];
    Failure::Overlap { body, partner: Partner::Plane(plane as usize), overlap, bound }
}

/// Power, force and moment of planes about the origin.
struct Done<Q> {
    work: Q,
    linear: V3<Q>,
    angular: V3<Q>,
}

impl<Q: Simd4> Done<Q> {
    #[inline(always)]
    fn new() -> Done<Q> {
        Done { work: Q::zero(), linear: V3::zero(), angular: V3::zero() }
    }

    #[inline(always)]
    fn add<R: SimdPack<Quad = Q>>(&mut self, f: &Forces<R>) {
        self.work = f.power.add_to(self.work);
        self.linear = add(f.force, self.linear);
        self.angular = add(f.about_origin, self.angular);
    }

    #[inline(always)]
    fn add_to_balance(&self, balance: &mut BalanceTerms, dt: f64) {
        let (linear, angular) = (&self.linear, &self.angular);
        balance.work_walls += self.work.sum() * dt;
        balance.walls.linear += Vec3::new(linear.x.sum(), linear.y.sum(), linear.z.sum()) * dt;
        balance.walls.angular += Vec3::new(angular.x.sum(), angular.y.sum(), angular.z.sum()) * dt;
    }
}

#[inline(always)]
fn add<R: SimdPack>(v: V3<R>, sum: V3<R::Quad>) -> V3<R::Quad> {
    V3::new(v.x.add_to(sum.x), v.y.add_to(sum.y), v.z.add_to(sum.z))
}
