//! Leapfrog, the velocity Verlet scheme with velocities at half steps:
//!
//! v(n+½) = v(n−½) + dt F(n)/m,  x(n+1) = x(n) + dt v(n+½),
//!
//! and likewise for spin and momentum. One kick per step, so impulses are sums of F dt to rounding; momentum and
//! angular momentum (x(n+1), v(n+½)) balance to rounding too, and the change of kinetic energy in a step is
//! exactly dt F(n)·(v(n−½) + v(n+½))/2.
//!
//! Fixed motions keep their velocity: what holds them is booked as work and impulse of constraints.

use super::rotation;
use crate::Vec3;
use crate::ledger::Ledger;
use crate::model::{Kind, Model};
use crate::state::{Block, Rotation, set_xyz, spin_of, xyz};
use crate::work::{Applied, BlockWork, Failure};

/// Moves all bodies of a block by one step. `applied` holds the block's applied forces, by place.
pub(crate) fn advance<const RIGID: bool>(
    model: &Model,
    block: &mut Block,
    w: &mut BlockWork,
    mut applied: &[Applied],
    dt: f64,
) {
    let bound = 0.5 * model.radii.0 / dt;
    let plain = model.damping == 0.0;
    let (mut mass_sum, mut moment, mut fastest2) = (0.0, Vec3::zeros(), 0.0_f64);
    for k in 0..block.bodies.len() {
        let x = xyz(&block.centre[k]);
        let v = xyz(&block.velocity[k]);
        mass_sum += w.mass[k];
        moment += x * w.mass[k];

        let own = applied.iter().take_while(|a| a.place as usize == k).count();
        let free = plain && own == 0 && w.fixed[k] == 0;
        let speed2 = if free && (!RIGID || w.kind[k] == Kind::Sphere) {
            let inverse_mass = block.velocity[k][3];
            let v = v + (xyz(&w.sums[k].force) * inverse_mass + model.gravity) * dt;
            set_xyz(&mut block.velocity[k], &v);
            set_xyz(&mut block.centre[k], &(x + v * dt));
            let spin = xyz(&block.spin[k]) + xyz(&w.sums[k].torque) * (w.inverse_inertia[k] * dt);
            set_xyz(&mut block.spin[k], &spin);
            v.norm_squared()
        } else {
            let (loads, rest) = applied.split_at(own);
            applied = rest;
            general::<RIGID>(model, block, w, k, loads, dt)
        };
        if RIGID {
            let q = block.rotation[k].orientation;
            let centre = block.centre[k];
            w.place_spheres(k, &centre, &q);
        }
        // Also catches a velocity that is not a number, which no maximum would show.
        if (speed2.is_nan() || speed2 > bound * bound) && w.failure.is_none() {
            w.failure = Some(Failure::Speed { body: block.bodies[k], speed: speed2.sqrt(), bound });
        }
        fastest2 = fastest2.max(speed2);
    }
    w.fastest = fastest2.sqrt();
    let impulse = model.gravity * dt;
    w.ledger.gravity.linear += impulse * mass_sum;
    w.ledger.gravity.angular += moment.cross(&impulse);
}

/// Any body, with applied forces, local damping and fixed motions. Returns the square of the largest speed of its points.
fn general<const RIGID: bool>(
    model: &Model,
    block: &mut Block,
    w: &mut BlockWork,
    k: usize,
    loads: &[Applied],
    dt: f64,
) -> f64 {
    let (x, v0, w0) = (xyz(&block.centre[k]), xyz(&block.velocity[k]), xyz(&block.spin[k]));
    let (mass, fixed) = (w.mass[k], w.fixed[k]);
    let load = loads.iter().fold(Vec3::zeros(), |sum, a| sum + a.force);
    let load_torque = loads.iter().fold(Vec3::zeros(), |sum, a| sum + a.torque);
    let mut force = xyz(&w.sums[k].force) + load + model.gravity * mass;
    let mut torque = xyz(&w.sums[k].torque) + load_torque;
    let held = |v: &Vec3| Vec3::from_fn(|d, _| -model.damping * v[d].abs());
    let damping = held(&force).component_mul(&v0.map(sign));
    let damping_torque = held(&torque).component_mul(&w0.map(sign));
    force += damping;
    torque += damping_torque;

    // Translation.
    let mut v1 = v0 + force * (dt / mass);
    for d in 0..3 {
        if fixed >> d & 1 == 1 {
            v1[d] = v0[d];
        }
    }
    let mean = (v0 + v1) * 0.5;
    let ledger = &mut w.ledger;
    if fixed & 7 != 0 {
        let hold = (v1 - v0) * mass - force * dt;
        ledger.constraints.add(&x, &hold);
        ledger.work_constraints += hold.dot(&mean);
    }
    set_xyz(&mut block.velocity[k], &v1);
    set_xyz(&mut block.centre[k], &(x + v1 * dt));

    // Rotation.
    let (mean_spin, reach) = if RIGID && w.kind[k] != Kind::Sphere {
        let spin = rotate(model, block, k, &w.inertia[k], &torque, fixed >> 3, dt, ledger);
        (spin, w.reach[k])
    } else {
        let mut w1 = w0 + torque * (w.inverse_inertia[k] * dt);
        for d in 0..3 {
            if fixed >> (d + 3) & 1 == 1 {
                w1[d] = w0[d];
            }
        }
        let mean = (w0 + w1) * 0.5;
        if fixed >> 3 != 0 {
            let hold = (w1 - w0) / w.inverse_inertia[k] - torque * dt;
            ledger.constraints.angular += hold;
            ledger.work_constraints += hold.dot(&mean);
        }
        set_xyz(&mut block.spin[k], &w1);
        (mean, 0.0)
    };

    if !loads.is_empty() {
        ledger.work_applied += (load.dot(&mean) + load_torque.dot(&mean_spin)) * dt;
        ledger.applied.add(&x, &(load * dt));
        ledger.applied.angular += load_torque * dt;
    }
    if model.damping > 0.0 {
        ledger.dissipated_local_damping -= (damping.dot(&mean) + damping_torque.dot(&mean_spin)) * dt;
        ledger.local_damping.add(&x, &(damping * dt));
        ledger.local_damping.angular += damping_torque * dt;
    }
    let speed = v1.norm() + xyz(&block.spin[k]).norm() * reach;
    speed * speed
}

/// Sign with sign(0) = 0: a body at rest is not damped.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { 1.0_f64.copysign(x) }
}

/// Kicks and turns a clump or a box; returns the mean spin of the kick.
#[inline]
fn rotate(
    model: &Model,
    block: &mut Block,
    k: usize,
    inertia: &Vec3,
    torque: &Vec3,
    fixed: u8,
    dt: f64,
    ledger: &mut Ledger,
) -> Vec3 {
    let w0 = xyz(&block.spin[k]);
    let r = &mut block.rotation[k];
    let before = *r;
    r.momentum += torque * dt;
    let kicked = spin_of(r, inertia);
    if fixed == 0 {
        r.orientation = rotation::free(&r.orientation, &r.momentum, inertia, dt);
        let spin = spin_of(r, inertia);
        set_xyz(&mut block.spin[k], &spin);
        return (w0 + kicked) * 0.5;
    }
    let kicked = hold(r, inertia, &kicked, &model.bodies[block.bodies[k] as usize].spin, fixed);
    r.orientation = rotation::steady(&r.orientation, &kicked, dt);
    let local = r.orientation.inverse_transform_vector(&kicked);
    r.momentum = r.orientation * local.component_mul(inertia);
    let mean = (w0 + kicked) * 0.5;
    ledger.constraints.angular += r.momentum - before.momentum - torque * dt;
    ledger.work_constraints +=
        0.5 * (r.momentum.dot(&kicked) - before.momentum.dot(&w0)) - torque.dot(&mean) * dt;
    set_xyz(&mut block.spin[k], &kicked);
    mean
}

/// Spin after the impulse about the fixed axes that gives it the components `target` there.
fn hold(r: &Rotation, inertia: &Vec3, spin: &Vec3, target: &Vec3, fixed: u8) -> Vec3 {
    if fixed == 7 {
        return *target;
    }
    // World inverse inertia, its rows of free axes replaced by those of the identity: solving gives the impulse.
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
    // The principal minors of a positive definite matrix are positive, so a solution always exists.
    let impulse = system.lu().solve(&rhs).unwrap_or_else(Vec3::zeros);
    spin + inverse * impulse
}
