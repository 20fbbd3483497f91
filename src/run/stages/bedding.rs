//! Seating of sleepers, and pouring of grains around them.
//!
//! On loose grains a sleeper settles by a fraction of their size. Pressing it with rigid ground before the
//! main stage avoids this.

use super::stage::Settled;
use crate::bed::{Bed, top_below};
use std::f64::consts::PI;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::{AppliedForce, BodyInput, Vec3};
use trackbed_input::model::grains::{DepositionPlan, GrainsPart};
use trackbed_io::failure::Failure;

/// Drop gap over the largest grain radius.
const GAP: f64 = 1e-3;

/// Returns sleepers just above the highest grains.
pub fn set_down(bed: &Bed<'_>, grains: &GrainsPart, surface: Option<&SolidSurface>) -> Vec<BodyInput> {
    let Some(plan) = &grains.track.sleeper else { return Vec::new() };
    let place = |&centre: &[f64; 2]| {
        let base = top_below(&bed.model, &bed.state, centre, &plan.row.half, surface);
        grains.sleeper_body(plan, centre, base + plan.row.half[2])
    };
    plan.row.centres.iter().map(place).collect()
}

/// Presses bodies from `first` on with F sin²(πft).
///
/// # Errors
/// As [`Bed::step`].
pub fn press(
    bed: &mut Bed<'_>,
    first: usize,
    force: f64,
    frequency: f64,
    cycles: u32,
) -> Result<(), Failure> {
    let share = |t: f64| libm::sin(PI * frequency * t).powi(2);
    load(bed, first, f64::from(cycles) / frequency, |t| Vec3::new(0.0, 0.0, -force * share(t)))
}

/// Loads the centres of bodies from `first` on for `end` seconds.
fn load(bed: &mut Bed<'_>, first: usize, end: f64, force: impl Fn(f64) -> Vec3) -> Result<(), Failure> {
    let begun = bed.state.time;
    let mut applied = Vec::new();
    while bed.state.time - begun < end {
        let force = force(bed.state.time - begun);
        applied.clear();
        let on = |body| AppliedForce { body, force, point: bed.state.position(body) };
        applied.extend((first..bed.model.body_count()).map(on));
        bed.step(&applied)?;
    }
    Ok(())
}

/// Loads bodies from `first` on with a constant force while F sin(2πft) shakes them along an axis: vertical
/// force [N], amplitude [N], axis. Both rise in the first and fall in the last quarter of the cycles, so that a
/// free body returns.
///
/// # Errors
/// As [`Bed::step`].
pub fn stabilize(
    bed: &mut Bed<'_>,
    first: usize,
    (force, sway, across): (f64, f64, usize),
    frequency: f64,
    cycles: u32,
) -> Result<(), Failure> {
    load(bed, first, f64::from(cycles) / frequency, |t| {
        let turns = frequency * t;
        let edge = (4.0 * turns.min(f64::from(cycles) - turns) / f64::from(cycles)).clamp(0.0, 1.0);
        let share = libm::sin(0.5 * PI * edge).powi(2);
        let mut now = Vec3::new(0.0, 0.0, -force * share);
        now[across] = sway * share * libm::sin(2.0 * PI * turns);
        now
    })
}

/// Returns queued grains in `count` equal layers, lowest first.
pub fn layers(bodies: &[BodyInput], parts: &[u32], count: u32) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> =
        (0..bodies.len()).filter(|&b| bodies[b].absent && parts.contains(&bodies[b].part)).collect();
    order.sort_by(|&a, &b| bodies[a].position.z.total_cmp(&bodies[b].position.z));
    if order.is_empty() {
        return Vec::new();
    }
    order.chunks(order.len().div_ceil(count as usize)).map(<[usize]>::to_vec).collect()
}

/// Inserts a layer just above all bodies.
pub fn let_in(grains: &GrainsPart, settled: &mut Settled, layer: &[usize]) {
    let reach = |b: &BodyInput| grains.groups.reach(b);
    let there = settled.bodies.iter().filter(|b| !b.absent).map(|b| b.position.z + reach(b));
    // Seated sleepers are tilted.
    let half = grains.track.sleeper.as_ref().map_or([0.0; 3], |s| s.row.half);
    let top = there.chain(settled.sleepers.iter().map(|s| highest_corner(s, half)));
    let top = top.fold(f64::NEG_INFINITY, f64::max);
    let own = || layer.iter().map(|&b| &settled.bodies[b]);
    let largest = own().map(reach).fold(0.0, f64::max);
    let bottom = own().map(|b| b.position.z - reach(b)).fold(f64::INFINITY, f64::min);
    let shift = if top.is_finite() { top + GAP * largest - bottom } else { 0.0 };
    for &b in layer {
        settled.bodies[b].absent = false;
        settled.bodies[b].position.z += shift;
    }
}

fn highest_corner(block: &BodyInput, half: [f64; 3]) -> f64 {
    let up = block.orientation.inverse() * Vec3::z();
    block.position.z + up.abs().dot(&Vec3::from(half))
}

/// Removes grains above the level; `bed`: final model from `before`.
pub fn cut(settled: &mut Settled, bed: &Bed<'_>, before: &[BodyInput], parts: &[u32], level: Option<f64>) {
    let above = |b: &BodyInput| level.is_some_and(|level| b.position.z > level);
    let goes = |b: &BodyInput| !b.absent && parts.contains(&b.part) && above(b);
    let removed: Vec<usize> = (0..settled.bodies.len()).filter(|&b| goes(&settled.bodies[b])).collect();
    if let Some(energy) = settled.energy.last_mut() {
        settled.warnings.extend(energy.remove(&bed.model, &bed.state, before, &removed));
    }
    settled.bodies.retain(|b| !goes(b));
}

/// Result of pouring.
pub struct Poured<'b> {
    /// Last model.
    pub bed: Bed<'b>,
    /// Its initial grains.
    pub before: Vec<BodyInput>,
    /// Total steps.
    pub steps: u64,
    /// Whether all layers came to rest.
    pub rested: bool,
}

/// Pours layer by layer, in models from `new`.
///
/// # Errors
/// As [`Bed::step`].
pub fn pour<'b>(
    grains: &GrainsPart,
    settled: &mut Settled,
    (stage, parts, count): (&str, &[u32], u32),
    plan: &DepositionPlan,
    new: impl Fn(&Settled) -> Result<Bed<'b>, Failure>,
) -> Result<Poured<'b>, Failure> {
    let (mut steps, mut rested) = (0, true);
    let (mut bed, mut before) = (new(settled)?, settled.bodies.clone());
    for layer in layers(&settled.bodies, parts, count) {
        let_in(grains, settled, &layer);
        before.clone_from(&settled.bodies);
        bed = new(settled)?;
        rested &= bed.rest(plan)?;
        steps += bed.state.steps;
        settled.energy.push(bed.energy(stage)?);
        settled.take(&bed);
    }
    Ok(Poured { bed, before, steps, rested })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use std::f64::consts::FRAC_PI_6;

    #[test]
    fn tilted_block_reaches_its_corner() {
        let half = [1.3, 0.14, 0.1];
        let turned = |axis, angle| BodyInput {
            position: Vec3::new(0.0, 0.0, 2.0),
            orientation: UnitQuaternion::from_axis_angle(&axis, angle),
            ..BodyInput::default()
        };
        let (sin, cos) = (0.5, FRAC_PI_6.cos());
        let cases = [
            (turned(Vec3::y_axis(), 0.0), 2.1),
            (turned(Vec3::y_axis(), FRAC_PI_6), 2.0 + 1.3 * sin + 0.1 * cos),
            (turned(Vec3::y_axis(), -FRAC_PI_6), 2.0 + 1.3 * sin + 0.1 * cos),
            (turned(Vec3::x_axis(), FRAC_PI_6), 2.0 + 0.14 * sin + 0.1 * cos),
            (turned(Vec3::z_axis(), FRAC_PI_6), 2.1),
        ];
        for (block, top) in cases {
            assert!((highest_corner(&block, half) - top).abs() < 1e-12, "{block:?} {top}");
        }
    }
}
