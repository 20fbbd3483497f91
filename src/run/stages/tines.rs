//! Tamping by a machine: each sleeper is lifted, vibrating tines enter beside it, close below it, and leave.
//!
//! Blades are walls, the lifted sleeper a body in prescribed motion; the ground is rigid.

use super::pressing::Pressed;
use super::stage::Settled;
use crate::bed::{Bed, top_below};
use crate::packing::TampingRecord;
use std::f64::consts::TAU;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::{BodyInput, State, Vec3, WallInput, WallShape};
use trackbed_input::model::grains::{DepositionPlan, TinesPlan};
use trackbed_io::failure::Failure;
use trackbed_track::SleeperRow;

/// Distance of the tips from the highest grain before insertion [m].
const CLEARANCE: f64 = 1e-3;

/// Blade as a wall.
struct Blade {
    wall: usize,
    /// Direction along the track towards the sleeper: ±1.
    inwards: f64,
    /// Way towards the sleeper, without vibration [m].
    way: f64,
    /// Mean force against closing and against insertion [N].
    mean: [f64; 2],
    /// Last force against closing [N].
    last: f64,
}

/// Phases with their ends [s].
struct Program {
    lift: f64,
    inserted: f64,
    held: f64,
    end: f64,
}

impl Program {
    fn of(plan: &TinesPlan, down: f64) -> Program {
        let lift = plan.lift / plan.squeeze;
        let inserted = lift + down / plan.insertion;
        let held = inserted + plan.travel / plan.squeeze + plan.hold;
        Program { lift, inserted, held, end: held + down / plan.insertion }
    }
}

/// Returns the longest time per sleeper, without rest [s]; `reach`: way down of the blades [m].
pub fn longest(plan: &TinesPlan, reach: f64) -> f64 {
    Program::of(plan, reach).end
}

/// Tamps all sleepers, one after the other; `new` makes a bed of bodies with blades.
///
/// # Errors
/// As [`Bed::step`].
pub fn tamp<'b>(
    mut done: Pressed<'b>,
    (plan, rest): (&TinesPlan, &DepositionPlan),
    row: &SleeperRow,
    settled: &mut Settled,
    (name, surface): (&str, Option<&SolidSurface>),
    new: impl Fn(Vec<BodyInput>, Vec<WallInput>) -> Result<Bed<'b>, Failure>,
) -> Result<Pressed<'b>, Failure> {
    for k in 0..settled.sleepers.len() {
        let bodies = settled.all();
        let sleeper = settled.bodies.len() + k;
        let mut held = bodies.clone();
        held[sleeper].fixed = [true; 6];
        let base = held[sleeper].position.z - row.half[2];
        let places = blades_at(plan, row, &held[sleeper].position);
        let reach = plan.reach();
        let top = |at: [f64; 2]| top_below(&done.bed.model, &done.bed.state, at, &reach, surface);
        let top = places.iter().map(|p| top(p.0)).fold(base, f64::max) + CLEARANCE;
        let walls = places.iter().map(|(at, _)| blade(plan, *at, top)).collect();
        let mut bed = new(held, walls)?;
        let first = bed.model.wall_count() - places.len();
        let blade = |(i, place): (usize, &([f64; 2], f64))| Blade {
            wall: first + i,
            inwards: place.1,
            way: 0.0,
            mean: [0.0; 2],
            last: 0.0,
        };
        let mut blades: Vec<Blade> = places.iter().enumerate().map(blade).collect();
        let down = top - (base + plan.lift - plan.depth);
        let record = work(&mut bed, plan, (sleeper, down.max(0.0)), &mut blades)?;
        settled.energy.push(bed.energy(name)?);
        let released = new(bed.at_rest(&bodies), Vec::new())?;
        done.steps += bed.state.steps;
        done.bed = released;
        let rested = done.bed.rest(rest)?;
        done.rested &= rested;
        done.steps += done.bed.state.steps;
        if k + 1 < settled.sleepers.len() {
            settled.energy.push(done.bed.energy(name)?);
        }
        settled.take(&done.bed);
        let raised = settled.sleepers[k].position.z - bodies[sleeper].position.z;
        settled.tamping.push(TampingRecord { sleeper: k + 1, raised, ..record });
    }
    Ok(done)
}

/// Centres in plan, direction along the track towards the sleeper.
fn blades_at(plan: &TinesPlan, row: &SleeperRow, sleeper: &Vec3) -> Vec<([f64; 2], f64)> {
    let axis = plan.axis;
    let place = |across: f64, inwards: f64| {
        let mut at = [sleeper.x, sleeper.y];
        at[1 - axis] += across;
        at[axis] -= inwards * plan.distance(row.half[axis]);
        (at, inwards)
    };
    plan.at.iter().flat_map(|&across| [place(across, 1.0), place(across, -1.0)]).collect()
}

/// Box of triangles with its tip at height `z`.
fn blade(plan: &TinesPlan, at: [f64; 2], z: f64) -> WallInput {
    let half = plan.half_in_plan();
    let corner = |k: u32| {
        let side = |bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let up = f64::from(k >> 2 & 1) * 2.0 * plan.half[2];
        Vec3::new(at[0] + side(0) * half[0], at[1] + side(1) * half[1], z + up)
    };
    let quads: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    WallInput::fixed(
        WallShape::Triangles { vertices: (0..8).map(corner).collect(), triangles },
        plan.material,
    )
}

/// Lift, insertion, squeeze, hold, withdrawal.
fn work(
    bed: &mut Bed<'_>,
    plan: &TinesPlan,
    (sleeper, down): (usize, f64),
    blades: &mut [Blade],
) -> Result<TampingRecord, Failure> {
    let program = Program::of(plan, down);
    let begun = bed.state.time;
    let height = |t: f64| {
        let way = (t - program.lift).clamp(0.0, down / plan.insertion);
        let back = (t - program.held).clamp(0.0, down / plan.insertion);
        -plan.insertion * (way - back)
    };
    let lifted = |t: f64| (plan.squeeze * t).min(plan.lift);
    let swing = |t: f64| {
        let since = (t - program.lift).clamp(0.0, program.held - program.lift);
        plan.amplitude * libm::sin(TAU * plan.frequency * since)
    };
    let mut record = TampingRecord::default();
    let mut lifting = true;
    while bed.state.time - begun < program.end {
        let (t, dt) = (bed.state.time - begun, bed.dt());
        let rise = (lifted(t + dt) - lifted(t)) / dt;
        if lifting {
            bed.state.set_velocity(&bed.model, sleeper, Vec3::new(0.0, 0.0, rise), Vec3::zeros());
            lifting = rise > 0.0;
        }
        let sink = (height(t + dt) - height(t)) / dt;
        let shake = (swing(t + dt) - swing(t)) / dt;
        let closing = t >= program.inserted && t < program.held;
        for blade in blades.iter_mut() {
            let stopped = blade.mean[0].max(blade.last) >= plan.force || blade.way >= plan.travel;
            let closes = closing && !stopped;
            let step = if closes { (plan.squeeze * dt).min(plan.travel - blade.way) } else { 0.0 };
            blade.way += step;
            let mut velocity = Vec3::new(0.0, 0.0, sink);
            velocity[plan.axis] = blade.inwards * (step / dt + shake);
            bed.state.set_wall_velocity(blade.wall, velocity);
        }
        bed.step(&[])?;
        let phase = [t < program.inserted, t >= program.inserted && t < program.held];
        measure(&bed.state, plan, (dt, phase), blades, &mut record);
    }
    bed.state.set_velocity(&bed.model, sleeper, Vec3::zeros(), Vec3::zeros());
    blades.iter().for_each(|b| bed.state.set_wall_velocity(b.wall, Vec3::zeros()));
    record.travel = blades.iter().map(|b| b.way).sum::<f64>() / blades.len() as f64;
    Ok(record)
}

/// Means over a period of vibration; `phase`: insertion, squeeze and hold.
fn measure(
    state: &State,
    plan: &TinesPlan,
    (dt, [enters, closes]): (f64, [bool; 2]),
    blades: &mut [Blade],
    record: &mut TampingRecord,
) {
    for blade in blades {
        let force = state.wall_force(blade.wall).0;
        // Without vibration the force itself.
        let share = if plan.amplitude > 0.0 { (dt * plan.frequency).min(1.0) } else { 1.0 };
        let now = [-blade.inwards * force[plan.axis], force.z];
        blade.last = now[0];
        for (mean, now) in blade.mean.iter_mut().zip(now) {
            *mean += share * (now - *mean);
        }
        if enters {
            record.insertion_force = record.insertion_force.max(blade.mean[1]);
        }
        if closes {
            record.squeeze_force = record.squeeze_force.max(blade.mean[0]);
        }
        record.work -= force.dot(&state.wall_velocity(blade.wall).0) * dt;
    }
}
