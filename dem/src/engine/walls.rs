//! Wall motion at the end of a step.
//!
//! A prescribed wall does work F·v̄ + M·ω̄, with mean velocities before and after the step. Prescribed
//! oscillations set the displacement, so they do not drift.

use super::model::Model;
use super::state::State;
use super::work::Work;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::failure::Failure;
use crate::bodies::sums::WallSum;
use crate::integrate::rotation;
use crate::integrate::step_size::StepSize;
use crate::shape::plane::PlaneMotion;
use crate::wall::body::{self, Body, Ground};
use crate::wall::servo::Servo;
use crate::wall::state::WallState;
use nalgebra::UnitQuaternion;

fn booked(work: &Work, wall: usize) -> WallSum {
    let within = work.blocks.iter().map(|w| &w.patches.wall_sums);
    let across = work.cross.iter().map(|w| &w.wall_sums);
    let mut sum = WallSum::default();
    for part in within.chain(across).chain([&work.wall_contacts.sums]).filter_map(|sums| sums.get(wall)) {
        sum += part;
    }
    sum
}

/// Returns the largest point speed and the first failure.
pub(crate) fn advance(
    model: &Model,
    state: &mut State,
    work: &Work,
    balance: &mut BalanceTerms,
) -> (f64, Option<Failure>) {
    let (kick, dt) = (state.step_size.kick(), state.step_size.dt);
    let bound = 0.5 * model.radii.0 / dt;
    let mut fastest = 0.0_f64;
    let mut failure = None;
    for (k, wall) in model.walls.walls.iter().enumerate() {
        let sum = booked(work, k);
        let own = &mut state.walls[k];
        own.force = -sum.force;
        own.moment = -sum.moment;
        let speed = match &wall.body {
            Some(b) => {
                let ground = ground(model, &state.planes, kick);
                let (force, torque) = body::ground_reaction(&ground, b, wall.material, own, balance);
                let (force, torque) = (force + own.force, torque + own.moment);
                float(b, own, (force, torque), &model.gravity, (state.time, &state.step_size), balance);
                b.speed(own)
            }
            None => {
                let centre = wall.centre + own.offset;
                let mut speed = own.drive;
                if let Some(servo) = wall.servo.as_ref().filter(|_| !own.open) {
                    let impedance = sum.stiffness * kick + 2.0 * wall.damping * 2.0 * sum.damping;
                    speed = servo_velocity(servo, own, state.time, kick, sum.force, impedance);
                }
                let before = own.velocity;
                own.steady += speed * dt;
                let next = match &wall.motion.oscillation {
                    Some(o) => {
                        let next = own.steady + o.at(state.time + dt);
                        own.velocity = (next - own.offset) / dt;
                        next
                    }
                    None => {
                        own.velocity = speed;
                        own.steady
                    }
                };
                own.offset = next;
                let spin = wall.motion.angular_velocity;
                if spin != Vec3::zeros() {
                    own.orientation = rotation::by(&(spin * (state.time + dt)));
                    own.turned = true;
                }
                let mean = (before + own.velocity) * 0.5;
                let done = (sum.force.dot(&mean) + sum.moment.dot(&spin)) * kick;
                if wall.servo.is_some() {
                    balance.work_servo += done;
                    // A massless servo may jump within a step, which the dashpots miss.
                    balance.dissipated_dashpot +=
                        sum.dashpots.lag(&before, &own.change, &own.velocity) * kick;
                    own.change = own.velocity - before;
                } else {
                    balance.work_walls += done;
                }
                balance.walls.add(&centre, &(sum.force * kick));
                balance.walls.angular += sum.moment * kick;
                let speed = own.velocity.norm() + spin.norm() * wall.reach;
                state.driven_speed = state.driven_speed.max(speed);
                speed
            }
        };
        if (speed.is_nan() || speed > bound) && failure.is_none() {
            failure = Some(Failure::Wall { wall: k as u32, speed, bound });
        }
        fastest = fastest.max(speed);
    }
    (fastest, failure.or_else(|| meeting(model, state)))
}

/// Advances a rigid body under contacts, and under water if it floats, whose work and impulse are recorded.
fn float(
    body: &Body,
    own: &mut WallState,
    (force, torque): (Vec3, Vec3),
    gravity: &Vec3,
    (time, step_size): (f64, &StepSize),
    balance: &mut BalanceTerms,
) {
    let kick = step_size.kick();
    let Some((push, twist)) = body.action(own, (&force, &torque), gravity, (time, 0.5 * kick)) else {
        body.advance(own, &force, &torque, gravity, step_size, balance);
        return;
    };
    let (velocity, spin) = (own.velocity, own.spin);
    balance.body_forces.add(&(body.centre + own.offset), &(push * kick));
    balance.body_forces.angular += twist * kick;
    body.advance(own, &(force + push), &(torque + twist), gravity, step_size, balance);
    let mean = [(velocity + own.velocity) * 0.5, (spin + own.spin) * 0.5];
    balance.work_body_forces += (push.dot(&mean[0]) + twist.dot(&mean[1])) * kick;
}

/// Velocity of a servo-controlled wall [m/s]; follows its force [N] against the target.
fn servo_velocity(
    servo: &Servo,
    own: &mut WallState,
    time: f64,
    kick: f64,
    force: Vec3,
    impedance: f64,
) -> Vec3 {
    let d = servo.direction;
    let (target, force) = (servo.target(time), force.dot(&d));
    d * match servo.driven_speed(time) {
        Some(driven) => driven,
        None => {
            own.tracking.add(kick, target, force);
            servo.speed(target - force, impedance, own.velocity.dot(&d), &mut own.integral)
        }
    }
}

/// Finds two non-interacting bodies with overlapping bounds.
fn meeting(model: &Model, state: &State) -> Option<Failure> {
    let round = |k: usize| model.walls.walls[k].body.as_ref().is_some_and(|b| !b.rests_on_ground());
    let bodies = || model.walls.walls.iter().zip(&state.walls).enumerate().filter(|(k, _)| round(*k));
    for (i, (a, sa)) in bodies() {
        for (j, (b, sb)) in bodies().skip_while(|(j, _)| *j <= i) {
            let (Some(p), Some(q)) = (&a.body, &b.body) else { continue };
            let between = p.centre + sa.offset - q.centre - sb.offset;
            if between.norm() > p.reach + q.reach {
                continue;
            }
            let bounds =
                |vertices: &[Vec3], f: &dyn Fn(&Vec3) -> Vec3| {
                    vertices.iter().map(f).fold(
                        (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)),
                        |(lo, hi), v| (lo.inf(&v), hi.sup(&v)),
                    )
                };
            let apart = |first: &body::Body, sf: &WallState, second: &body::Body, ss: &WallState| {
                let own = bounds(&first.vertices, &|v| *v);
                let other = bounds(&second.vertices, &|v| {
                    sf.to_local(&first.centre, &ss.to_world(&second.centre, v))
                });
                (0..3).any(|d| own.0[d] > other.1[d] || own.1[d] < other.0[d])
            };
            if !apart(p, sa, q, sb) && !apart(q, sb, p, sa) {
                return Some(Failure::Meeting { walls: [i as u32, j as u32] });
            }
        }
    }
    None
}

/// Bound on the displacement of wall points since `before` [m].
pub(crate) fn max_displacement(model: &Model, state: &State, before: &[(Vec3, UnitQuaternion<f64>)]) -> f64 {
    model
        .walls
        .walls
        .iter()
        .zip(&state.walls)
        .zip(before)
        .map(|((wall, now), (offset, orientation))| {
            let angle =
                if wall.reach > 0.0 && now.turned { now.orientation.angle_to(orientation) } else { 0.0 };
            (now.offset - offset).norm() + angle * wall.reach
        })
        .fold(0.0, f64::max)
}

pub(crate) fn ground<'a>(model: &'a Model, motions: &'a [PlaneMotion], dt: f64) -> Ground<'a> {
    Ground { laws: &model.laws, planes: &model.planes, motions, tip_radius: model.radii.0, dt }
}
