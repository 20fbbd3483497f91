//! Leapfrog: velocity Verlet with velocities at half steps,
//!
//! v(n+½) = v(n−½) + dt F(n)/m,  x(n+1) = x(n) + dt v(n+½),
//!
//! Local damping (Cundall) scales each component of total force and torque by 1 − α if it drives the motion,
//! by 1 + α if it brakes.
//!
//! Theory manual: equation (3.1) of `docs/theory/motion.md`.

use super::kick::{Push, Single, kick_free, kick_single, resist, turn_of_sphere};
use super::rigid_rotation::{self, GroupRotation, Rigid};
use super::rotation;
use super::step_size::StepSize;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::failure::Failure;
use crate::bodies::block::{Block, Rotation, spin_of};
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::{BlockTotals, ForceTorque};
use crate::bodies::table::{Bodies, BodyKind};
use crate::lanes::quaternion::QuaternionLanes;
use crate::lanes::vec4::{set_xyz, xyz};
use crate::lanes::{self, Kernel, Real, Simd, Simd4, SimdPack, V3};
use nalgebra::UnitQuaternion;

#[derive(Clone, Copy, Debug)]
pub struct Applied {
    pub block: u32,
    pub place: u32,
    pub force: Vec3,
    pub torque: Vec3,
}

/// Loads common to all bodies.
#[derive(Clone, Copy)]
pub struct MotionInput<'a> {
    /// Acceleration [m/s²].
    pub gravity: Vec3,
    /// Local damping coefficient α [-].
    pub damping: f64,
    /// Speed limit [m/s].
    pub bound: f64,
    pub bodies: &'a Bodies,
    pub step_size: StepSize,
}

/// Moves a block; applied forces are sorted by body index in it.
pub fn advance(
    simd: Simd,
    drive: &MotionInput<'_>,
    block: &mut Block,
    members: &mut BlockBodies,
    totals: &mut BlockTotals,
    applied: &[Applied],
) {
    match (members.rigid, members.plain() && applied.is_empty()) {
        (false, false) => {
            lanes::run(simd, Advance::<false, false> { drive, block, members, totals, applied });
        }
        (false, true) => lanes::run(simd, Advance::<false, true> { drive, block, members, totals, applied }),
        (true, false) => lanes::run(simd, Advance::<true, false> { drive, block, members, totals, applied }),
        (true, true) => lanes::run(simd, Advance::<true, true> { drive, block, members, totals, applied }),
    }
}

/// Groups of four free bodies, others singly. `PLAIN`: all are free.
struct Advance<'a, const CLUMPS: bool, const PLAIN: bool> {
    drive: &'a MotionInput<'a>,
    block: &'a mut Block,
    members: &'a mut BlockBodies,
    totals: &'a mut BlockTotals,
    /// Sorted by body index.
    applied: &'a [Applied],
}

impl<const CLUMPS: bool, const PLAIN: bool> Kernel for Advance<'_, CLUMPS, PLAIN> {
    type Output = ();

    #[inline(always)]
    fn run<P: SimdPack>(self) {
        self.by_four::<P>();
    }
}

impl<const CLUMPS: bool, const PLAIN: bool> Advance<'_, CLUMPS, PLAIN> {
    #[inline(always)]
    fn by_four<P: SimdPack>(self) {
        let Advance { drive, block, members, totals, mut applied } = self;
        let (kick, bound) = (drive.step_size.kick(), drive.bound);
        let forces = std::mem::take(&mut totals.sums);
        let n = block.bodies.len();
        let mut sums = Sums::<P::Quad>::new();
        let (mut moment, mut fastest2) = (Vec3::zeros(), 0.0_f64);
        let wild = |v2: f64| v2.is_nan() || v2 > bound * bound;
        let mut too_fast = false;
        let quick = if PLAIN { n - n % 4 } else { 0 };
        if drive.damping == 0.0 {
            for k in (0..quick).step_by(4) {
                four::<P::Quad, CLUMPS, false>(drive, block, members, &forces, k, &mut sums);
            }
        } else {
            for k in (0..quick).step_by(4) {
                four::<P::Quad, CLUMPS, true>(drive, block, members, &forces, k, &mut sums);
            }
        }
        if CLUMPS {
            for k in (0..quick).step_by(4) {
                place_four::<P>(block, members, k);
            }
        }
        for k in (quick..n).step_by(4) {
            if !PLAIN
                && k + 4 <= n
                && members.all_free(k)
                && applied.first().is_none_or(|a| a.place as usize >= k + 4)
            {
                if drive.damping == 0.0 {
                    four::<P::Quad, CLUMPS, false>(drive, block, members, &forces, k, &mut sums);
                } else {
                    four::<P::Quad, CLUMPS, true>(drive, block, members, &forces, k, &mut sums);
                }
                if CLUMPS {
                    place_four::<P>(block, members, k);
                }
                continue;
            }
            for k in k..n.min(k + 4) {
                moment += xyz(&block.centre[k]) * drive.bodies.get(block.bodies[k] as usize).mass;
                let own = applied.iter().take_while(|a| a.place as usize == k).count();
                let (loads, rest) = applied.split_at(own);
                applied = rest;
                let v2 = general::<CLUMPS>(drive, block, members, &forces[k], totals, k, loads);
                if CLUMPS {
                    let q = block.rotation[k].orientation;
                    let centre = block.centre[k];
                    members.place_spheres(k, &centre, &q);
                }
                too_fast |= wild(v2);
                fastest2 = fastest2.max(v2);
            }
        }
        if drive.damping != 0.0 {
            sums.book_damping(&mut totals.balance, kick);
        }
        moment += Vec3::new(sums.moment.x.sum(), sums.moment.y.sum(), sums.moment.z.sum());
        fastest2 = fastest2.max(sums.fastest2.largest());
        if (too_fast || !sums.sound || wild(fastest2)) && totals.failure.is_none() {
            let mut speeds = (0..n).map(|k| (k, speed2::<CLUMPS>(block, members, k)));
            if let Some((k, v2)) = speeds.find(|(_, v2)| wild(*v2)) {
                totals.failure = Some(Failure::Speed { body: block.bodies[k], speed: v2.sqrt(), bound });
            }
        }
        totals.fastest = fastest2.sqrt();
        let impulse = drive.gravity * kick;
        totals.balance.gravity.linear += impulse * members.mass_sum;
        totals.balance.gravity.angular += moment.cross(&impulse);
        totals.sums = forces;
    }
}

/// Sums over groups of four.
struct Sums<R> {
    moment: V3<R>,
    fastest2: R,
    /// No NaN.
    sound: bool,
    // Local damping: power, forces, torques, moments of forces.
    power: R,
    force: R,
    torque: R,
    angular: V3<R>,
}

impl<R: Simd4> Sums<R> {
    #[inline(always)]
    fn new() -> Sums<R> {
        let (zero, none) = (R::zero(), V3::zero());
        Sums {
            moment: none,
            fastest2: zero,
            sound: true,
            power: zero,
            force: zero,
            torque: zero,
            angular: none,
        }
    }

    #[inline(always)]
    fn book_damping(&self, balance: &mut BalanceTerms, kick: f64) {
        balance.dissipated_local_damping -= self.power.sum() * kick;
        let ([fx, fy, fz, _], [tx, ty, tz, _]) = (self.force.array(), self.torque.array());
        let about = &self.angular;
        let about = Vec3::new(about.x.sum() + tx, about.y.sum() + ty, about.z.sum() + tz);
        balance.local_damping.linear += Vec3::new(fx, fy, fz) * kick;
        balance.local_damping.angular += about * kick;
    }
}

fn speed2<const CLUMPS: bool>(block: &Block, members: &BlockBodies, k: usize) -> f64 {
    let v = xyz(&block.velocity[k]).norm();
    let turn = if CLUMPS { xyz(&block.spin[k]).norm() * members.reach[k] } else { 0.0 };
    (v + turn) * (v + turn)
}

/// Moves free bodies k to k + 3, without member spheres.
#[inline(always)]
fn four<R: Simd4, const CLUMPS: bool, const DAMPED: bool>(
    drive: &MotionInput<'_>,
    block: &mut Block,
    members: &BlockBodies,
    forces: &[ForceTorque],
    k: usize,
    sums: &mut Sums<R>,
) {
    let (kick, dt) = (drive.step_size.kick(), drive.step_size.dt);
    let step = R::load(&[kick, kick, kick, 0.0]);
    let way = R::load(&[dt, dt, dt, 0.0]);
    let damping = R::splat(drive.damping);
    let gravity = R::load(&[drive.gravity.x, drive.gravity.y, drive.gravity.z, 0.0]);
    let (mut before, mut after) = ([R::zero(); 4], [R::zero(); 4]);
    let (mut torque, mut held, mut stop) = ([R::zero(); 4], [R::zero(); 4], [R::zero(); 4]);
    let (centre, velocity) = (&mut block.centre[k..k + 4], &mut block.velocity[k..k + 4]);
    let (spin, force) = (&mut block.spin[k..k + 4], &forces[k..k + 4]);
    for l in 0..4 {
        let (x, v) = (R::load(&centre[l]), R::load(&velocity[l]));
        let inverse_mass = R::splat(velocity[l][3]);
        let push = Push { force: R::load(force[l].force()), gravity, inverse_mass, step, damping };
        let (kicked, hold) = kick_free::<R, DAMPED>(v, &push);
        torque[l] = R::load(force[l].torque());
        if DAMPED {
            held[l] = hold;
            sums.force = sums.force + hold;
            let mean = (v + kicked) * R::splat(0.5);
            stop[l] = resist(torque[l], R::load(&spin[l]), damping);
            sums.power = sums.power + held[l] * mean;
            sums.torque = sums.torque + stop[l];
            torque[l] = torque[l] + stop[l];
        }
        kicked.store(&mut velocity[l]);
        (x + kicked * way).store(&mut centre[l]);
        (before[l], after[l]) = (x, kicked);
    }
    let [x, y, z, r] = R::transpose(before);
    let [vx, vy, vz, inverse_mass] = R::transpose(after);
    let position = V3::new(x, y, z);
    sums.moment = sums.moment + position * (R::splat(1.0) / inverse_mass);
    if DAMPED {
        let [hx, hy, hz, _] = R::transpose(held);
        sums.angular = sums.angular + position.cross(V3::new(hx, hy, hz));
    }
    let mut speed2 = V3::new(vx, vy, vz).norm2();

    let clumps = if CLUMPS { members.reach[k..k + 4].iter().any(|&reach| reach > 0.0) } else { false };
    if clumps {
        speed2 = turn_four::<R, DAMPED>(block, members, k, (torque, stop), &drive.step_size, speed2, sums);
    } else {
        let kick = turn_of_sphere(R::splat(kick), inverse_mass, r).array();
        for l in 0..4 {
            let old = R::load(&spin[l]);
            let new = old + torque[l] * R::splat(kick[l]);
            if DAMPED {
                sums.power = sums.power + stop[l] * ((old + new) * R::splat(0.5));
            }
            new.store(&mut spin[l]);
        }
    }
    sums.sound &= R::all(speed2.le(R::splat(f64::MAX)));
    sums.fastest2 = sums.fastest2.max(speed2);
}

#[inline(always)]
fn turn_four<R: Simd4, const DAMPED: bool>(
    block: &mut Block,
    members: &BlockBodies,
    k: usize,
    (torque, stop): ([R; 4], [R; 4]),
    step_size: &StepSize,
    speed2: R,
    sums: &mut Sums<R>,
) -> R {
    let rotation = &mut block.rotation[k..k + 4];
    let spin = &mut block.spin[k..k + 4];
    let inertia = &members.inertia[k..k + 4];
    let lane = |p: &Vec3, q: &Vec3, s: &Vec3, t: &Vec3| {
        ([p.x, q.x, s.x, t.x], [p.y, q.y, s.y, t.y], [p.z, q.z, s.z, t.z])
    };
    let [a, b, c, d] = [0, 1, 2, 3].map(|l| &rotation[l].momentum);
    let (mx, my, mz) = lane(a, b, c, d);
    let (mx, my, mz) = (R::load(&mx), R::load(&my), R::load(&mz));
    let (ix, iy, iz) = lane(&inertia[0], &inertia[1], &inertia[2], &inertia[3]);
    let inertia = V3::new(R::load(&ix), R::load(&iy), R::load(&iz));
    let reach =
        R::load(&[members.reach[k], members.reach[k + 1], members.reach[k + 2], members.reach[k + 3]]);
    let [tx, ty, tz, _] = R::transpose(torque);
    let [wx, wy, wz, material] =
        R::transpose([R::load(&spin[0]), R::load(&spin[1]), R::load(&spin[2]), R::load(&spin[3])]);
    let kick = R::splat(step_size.kick());
    let torque = V3::new(tx, ty, tz);
    let sphere = !R::zero().lt(reach);
    let [qi, qj, qk, qw] = R::transpose([
        R::load(&rotation[0].orientation.coords.data.0[0]),
        R::load(&rotation[1].orientation.coords.data.0[0]),
        R::load(&rotation[2].orientation.coords.data.0[0]),
        R::load(&rotation[3].orientation.coords.data.0[0]),
    ]);
    let orientation = QuaternionLanes { v: V3::new(qi, qj, qk), s: qw };
    let (momentum, before) = (V3::new(mx, my, mz), V3::new(wx, wy, wz));
    let body = Rigid { orientation, momentum, spin: before, inertia };
    // Single spheres keep their orientation.
    let momentum = rigid_rotation::kicked(&body, torque, kick);
    let new = rotation::free(orientation, momentum, inertia, R::splat(step_size.dt));
    let mut held = V3::zero();
    if DAMPED {
        let [sx, sy, sz, _] = R::transpose(stop);
        held = V3::new(sx, sy, sz);
    }
    let GroupRotation { orientation: turn, spin: rate, power } =
        rigid_rotation::rotate_in_group::<R, DAMPED>(&body, sphere, (torque * kick, held), momentum, new);
    if DAMPED {
        sums.power = sums.power + power;
    }
    let spins = R::transpose([rate.x, rate.y, rate.z, material]);
    let turns = R::transpose([turn.v.x, turn.v.y, turn.v.z, turn.s]);
    let (mx, my, mz) = (momentum.x.array(), momentum.y.array(), momentum.z.array());
    for l in 0..4 {
        spins[l].store(&mut spin[l]);
        let r = &mut rotation[l];
        r.momentum = Vec3::new(mx[l], my[l], mz[l]);
        r.orientation = UnitQuaternion::new_unchecked(turns[l].array().into());
    }
    rigid_rotation::fastest2(speed2, rate, reach)
}

#[inline(always)]
fn place_four<P: SimdPack>(block: &Block, members: &mut BlockBodies, body: usize) {
    let (centre, rotation) = (&block.centre[body..body + 4], &block.rotation[body..body + 4]);
    let quaternion = |l: usize| &rotation[l].orientation.coords.data.0[0];
    let [i, j, k, s] = P::Quad::transpose([
        P::Quad::load(quaternion(0)),
        P::Quad::load(quaternion(1)),
        P::Quad::load(quaternion(2)),
        P::Quad::load(quaternion(3)),
    ]);
    let zero = P::Quad::zero();
    let [x, y, z] = QuaternionLanes { v: V3::new(i, j, k), s }.columns();
    let x = P::Quad::transpose([x.x, x.y, x.z, zero]);
    let y = P::Quad::transpose([y.x, y.y, y.z, zero]);
    let z = P::Quad::transpose([z.x, z.y, z.z, zero]);
    let radius = P::zero().lt(P::record(&[0.0, 0.0, 0.0, 1.0]));
    for l in 0..4 {
        let (x, y, z) = (P::twice(x[l]), P::twice(y[l]), P::twice(z[l]));
        let centre = P::record(&centre[l]);
        let (from, to) = (members.first[body + l] as usize, members.first[body + l + 1] as usize);
        let (local, spheres) = members.local_and_world();
        let (local, spheres) = (&local[from..to], &mut spheres[from..to]);
        for at in (0..local.len()).step_by(P::GROUPS) {
            let next = (at + P::GROUPS - 1).min(local.len() - 1);
            let p = P::join(&local[at], &local[next]);
            let turned = (x * p.spread::<0>() + y * p.spread::<1>()) + z * p.spread::<2>();
            let placed = turned + P::select(radius, p, centre);
            let [first, second] = placed.quads();
            second.store(&mut spheres[next]);
            first.store(&mut spheres[at]);
        }
    }
}

/// Any body. Returns the largest squared speed of its points.
fn general<const CLUMPS: bool>(
    drive: &MotionInput<'_>,
    block: &mut Block,
    members: &BlockBodies,
    sums: &ForceTorque,
    totals: &mut BlockTotals,
    k: usize,
    loads: &[Applied],
) -> f64 {
    let (kick, dt) = (drive.step_size.kick(), drive.step_size.dt);
    let (x, v0, w0) = (xyz(&block.centre[k]), xyz(&block.velocity[k]), xyz(&block.spin[k]));
    let body = drive.bodies.get(block.bodies[k] as usize);
    let (mass, fixed) = (body.mass, body.fixed);
    let load = loads.iter().fold(Vec3::zeros(), |sum, a| sum + a.force);
    let load_torque = loads.iter().fold(Vec3::zeros(), |sum, a| sum + a.torque);
    let bit = |d: usize| fixed >> d & 1 == 1;
    let single = Single {
        velocity: V3::from_vec(&v0),
        spin: V3::from_vec(&w0),
        force: (V3::from_vec(&xyz(sums.force())), V3::from_vec(&load)),
        torque: (V3::from_vec(&xyz(sums.torque())), V3::from_vec(&load_torque)),
        gravity: V3::from_vec(&drive.gravity),
        mass,
        inertia: body.inertia.x,
        fixed: [[bit(0), bit(1), bit(2)], [bit(3), bit(4), bit(5)]],
        damping: drive.damping,
    };
    let kicked = kick_single(&single, kick);
    let (v1, force, torque) = (kicked.velocity.to_vec(), kicked.force.to_vec(), kicked.torque.to_vec());
    let (damping, damping_torque) = (kicked.damping.to_vec(), kicked.damping_torque.to_vec());

    let mean = (v0 + v1) * 0.5;
    let balance = &mut totals.balance;
    if fixed & 7 != 0 {
        let hold = (v1 - v0) * mass - force * kick;
        balance.constraints.add(&x, &hold);
        balance.work_constraints += hold.dot(&mean);
    }
    set_xyz(&mut block.velocity[k], &v1);
    set_xyz(&mut block.centre[k], &(x + v1 * dt));

    let (mean_spin, reach) = if CLUMPS && members.kind[k] != BodyKind::Sphere {
        let spin = rotate(drive, block, k, &members.inertia[k], &torque, fixed >> 3, balance);
        (spin, members.reach[k])
    } else {
        let w1 = kicked.spin.to_vec();
        let mean = (w0 + w1) * 0.5;
        if fixed >> 3 != 0 {
            let hold = (w1 - w0) * body.inertia.x - torque * kick;
            balance.constraints.angular += hold;
            balance.work_constraints += hold.dot(&mean);
        }
        set_xyz(&mut block.spin[k], &w1);
        (mean, 0.0)
    };

    if !loads.is_empty() {
        balance.work_applied += (load.dot(&mean) + load_torque.dot(&mean_spin)) * kick;
        balance.applied.add(&x, &(load * kick));
        balance.applied.angular += load_torque * kick;
    }
    if drive.damping > 0.0 {
        balance.dissipated_local_damping -= (damping.dot(&mean) + damping_torque.dot(&mean_spin)) * kick;
        balance.local_damping.add(&x, &(damping * kick));
        balance.local_damping.angular += damping_torque * kick;
    }
    rigid_rotation::fastest2(V3::from_vec(&v1).norm2(), V3::from_vec(&xyz(&block.spin[k])), reach)
}

/// Kicks and rotates a clump or box; returns the mean angular velocity.
#[inline]
fn rotate(
    drive: &MotionInput<'_>,
    block: &mut Block,
    k: usize,
    inertia: &Vec3,
    torque: &Vec3,
    fixed: u8,
    balance: &mut BalanceTerms,
) -> Vec3 {
    let (kick, dt) = (drive.step_size.kick(), drive.step_size.dt);
    let w0 = xyz(&block.spin[k]);
    let r = &mut block.rotation[k];
    let of = V3::from_vec;
    let body = Rigid {
        orientation: QuaternionLanes::of(&r.orientation),
        momentum: of(&r.momentum),
        spin: of(&w0),
        inertia: of(inertia),
    };
    let momentum = rigid_rotation::kicked(&body, of(torque), kick);
    let turned = if fixed == 0 {
        let new = rotation::free(body.orientation, momentum, body.inertia, dt);
        rigid_rotation::rotate_single(&body, momentum, new)
    } else {
        let pushed = Rotation { orientation: r.orientation, momentum: momentum.to_vec() };
        let kicked = spin_of(&pushed, inertia);
        let target = drive.bodies.spin(block.bodies[k] as usize);
        let kicked = hold(&pushed, inertia, &kicked, &target, fixed);
        let (turned, impulse, work) =
            rigid_rotation::rotate_prescribed(&body, of(torque), of(&kicked), kick, dt);
        balance.constraints.angular += impulse.to_vec();
        balance.work_constraints += work;
        turned
    };
    *r = Rotation { orientation: turned.orientation.quaternion(), momentum: turned.momentum.to_vec() };
    set_xyz(&mut block.spin[k], &turned.spin.to_vec());
    turned.mean.to_vec()
}

/// Angular velocity with the components `target` about fixed axes.
pub fn hold(r: &Rotation, inertia: &Vec3, spin: &Vec3, target: &Vec3, fixed: u8) -> Vec3 {
    if fixed == 7 {
        return *target;
    }
    // Identity rows for free axes: the solution is the impulse.
    let turn = r.orientation.to_rotation_matrix();
    let inverse = turn.matrix()
        * nalgebra::Matrix3::from_diagonal(&inertia.map(|i| 1.0 / i))
        * turn.matrix().transpose();
    let mut system = inverse;
    let mut rhs = target - spin;
    for d in 0..3 {
        if fixed >> d & 1 == 0 {
            rhs[d] = 0.0;
            for c in 0..3 {
                system[(d, c)] = if c == d { 1.0 } else { 0.0 };
            }
        }
    }
    let impulse = system.lu().solve(&rhs).unwrap_or_else(Vec3::zeros);
    spin + inverse * impulse
}
