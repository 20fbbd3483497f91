//! Sleepers that are bedded while the ballast is compacted, and grains that are poured around them.
//!
//! A sleeper put on a heap of stones rests on the few highest ones and sinks by a share of their size before it lies in its bed:
//! pressed there with the ground held rigid, it has done so when the run proper begins.

use super::stage::Settled;
use crate::failure::Failure;
use crate::model::grains::{DepositionPlan, GrainsPart};
use crate::run::bed::{Bed, top_below};
use std::f64::consts::PI;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::{AppliedForce, BodyInput, Vec3};

/// Gap between what is dropped and what it falls on, as a share of the largest grain's radius.
const GAP: f64 = 1e-3;

/// The sleepers just above the highest grains below them.
pub fn set_down(bed: &Bed<'_>, grains: &GrainsPart, surface: Option<&SolidSurface>) -> Vec<BodyInput> {
    let Some(plan) = &grains.track.sleeper else { return Vec::new() };
    let place = |&centre: &[f64; 2]| {
        let base = top_below(&bed.model, &bed.state, centre, &plan.row.half, surface);
        grains.sleeper_body(plan, centre, base + plan.row.half[2])
    };
    plan.row.centres.iter().map(place).collect()
}

/// All bodies from number `first` on are pressed down with F sin²(πft) each.
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
    let (begun, end) = (bed.state.time, f64::from(cycles) / frequency);
    let mut applied = Vec::new();
    while bed.state.time - begun < end {
        let share = libm::sin(PI * frequency * (bed.state.time - begun)).powi(2);
        let force = Vec3::new(0.0, 0.0, -force * share);
        applied.clear();
        let on = |body| AppliedForce { body, force, point: bed.state.position(body) };
        applied.extend((first..bed.model.body_count()).map(on));
        bed.step(&applied)?;
    }
    Ok(())
}

/// The waiting grains of the groups `parts` in so many layers of equal number, the lowest first.
pub fn layers(bodies: &[BodyInput], parts: &[u32], count: u32) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> =
        (0..bodies.len()).filter(|&b| bodies[b].absent && parts.contains(&bodies[b].part)).collect();
    order.sort_by(|&a, &b| bodies[a].position.z.total_cmp(&bodies[b].position.z));
    if order.is_empty() {
        return Vec::new();
    }
    order.chunks(order.len().div_ceil(count as usize)).map(<[usize]>::to_vec).collect()
}

/// Lets a layer of waiting grains in, just above all that lies there.
pub fn let_in(grains: &GrainsPart, settled: &mut Settled, layer: &[usize]) {
    let reach = |b: &BodyInput| grains.groups.reach(b);
    let there = settled.bodies.iter().filter(|b| !b.absent).map(|b| b.position.z + reach(b));
    let half = grains.track.sleeper.as_ref().map_or(0.0, |s| s.row.half[2]);
    let top = there.chain(settled.sleepers.iter().map(|s| s.position.z + half));
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

/// Takes poured grains away that lie above the level; how many.
pub fn cut(settled: &mut Settled, parts: &[u32], level: Option<f64>) -> usize {
    let before = settled.bodies.len();
    let above = |b: &BodyInput| level.is_some_and(|level| b.position.z > level);
    settled.bodies.retain(|b| b.absent || !parts.contains(&b.part) || !above(b));
    before - settled.bodies.len()
}

/// Grains come to rest layer by layer, in models that `new` makes: the last of them, the steps, and whether all came to rest.
///
/// # Errors
/// As [`Bed::step`].
pub fn pour<'b>(
    grains: &GrainsPart,
    settled: &mut Settled,
    (parts, count): (&[u32], u32),
    plan: &DepositionPlan,
    new: impl Fn(&Settled) -> Result<Bed<'b>, Failure>,
) -> Result<(Bed<'b>, u64, bool), Failure> {
    let (mut steps, mut rested) = (0, true);
    let mut bed = new(settled)?;
    for layer in layers(&settled.bodies, parts, count) {
        let_in(grains, settled, &layer);
        bed = new(settled)?;
        rested &= bed.rest(plan)?;
        steps += bed.state.steps;
        settled.take(&bed);
    }
    Ok((bed, steps, rested))
}
