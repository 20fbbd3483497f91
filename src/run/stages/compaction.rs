//! Compaction of a deposited bed.

use super::bedding::{self, Poured};
use super::pressing::Pressed;
use super::stage::{GrainTime, Packed, RunState, Settled, Stage};
use super::tines;
use crate::bed::{Bed, BedProgress, rms_speed, top_below};
use crate::context::Run;
use crate::packing::{BedStage, CompactionRecord};
use crate::summary::StageRecord;
use crate::system::GrainsView;
use crate::validity::{BedExtent, region_not_filled};
use std::f64::consts::TAU;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::measure::{BoxRegion, body_volume_in};
use trackbed_dem::{BodyInput, Vec3, WallInput};
use trackbed_input::model::Job;
use trackbed_input::model::grains::{CompactionPlan, GrainsPart, Press, refused};
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;

/// Shift of a stabilized sleeper that causes a warning [m].
const SHIFT: f64 = 1e-3;

/// Activity shown in progress and errors.
pub const COMPACTED: &str = "being compacted";

/// Returns the longest simulated time of a press with rests [s].
pub fn longest(plan: &CompactionPlan) -> f64 {
    let rest = plan.rest.max_time;
    match &plan.press {
        Press::Vibration { frequency, cycles, .. } => f64::from(*cycles) / frequency + rest,
        Press::Squeeze { velocity, max_travel, .. } => max_travel / velocity.norm() + rest,
        Press::Bedding { frequency, cycles, .. } => f64::from(*cycles) / frequency + rest,
        Press::Pouring { layers, .. } => f64::from(*layers) * rest,
        Press::Tamping { at, frequency, cycles, .. } => {
            at.len() as f64 * (f64::from(*cycles) / frequency + rest)
        }
        Press::Stabilizing { frequency, cycles, .. } => f64::from(*cycles) / frequency + rest,
        Press::Tines(tines) => tines.sleepers as f64 * (tines::longest(tines, 2.0 * tines.half[2]) + rest),
    }
}

/// Compaction stages.
pub struct Compaction;

impl Stage for Compaction {
    fn name(&self) -> Option<&'static str> {
        Some("compaction")
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.as_ref().is_some_and(|g| !g.packing.compaction.is_empty())
    }

    fn grain_time(&self, job: &Job) -> Option<GrainTime> {
        Some(GrainTime::AtMost(job.grains.as_ref()?.packing.compaction.iter().map(longest).sum()))
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some(grains) = state.grains.as_mut().filter(|g| g.done < Packed::Finished) else { return Ok(()) };
        for index in grains.bed.earlier + grains.bed.compaction.len()..grains.part.packing.compaction.len() {
            grains.keep(run, Packed::Settled)?;
            run.checkpoints.begin();
            compact(run, &mut grains.part, index, grains.ground.as_ref(), &mut grains.bed)?;
            run.checkpoints.end();
        }
        Ok(())
    }
}

fn warn_of_bed(settled: &mut Settled, done: &Pressed<'_>, (grains, index): (&GrainsPart, usize)) {
    let view = GrainsView { model: &done.bed.model, state: &done.bed.state };
    let (key, count) = (format!("compaction.{index}.region"), settled.bodies.len());
    settled.warnings.extend(region_not_filled(&key, view, &done.region, |b| b < count));
    let bed = BedExtent::of(view, grains, |b| b < count);
    settled.warnings.extend(bed.and_then(|bed| bed.warning(&key, &done.region)));
    if !done.rested {
        settled.warnings.push(format!(
            "grains not at rest: root mean square speed {:.1} mm/s after compaction {} ({})",
            1e3 * rms_speed(&done.bed.model, &done.bed.state),
            index + 1,
            grains.packing.compaction[index].press.name()
        ));
    }
}

fn compact(
    run: &Run<'_>,
    grains: &mut GrainsPart,
    index: usize,
    surface: Option<&SolidSurface>,
    settled: &mut Settled,
) -> Result<(), Failure> {
    let plan = grains.packing.compaction[index].clone();
    let progress = BedProgress::new(Progress::start("compacting", longest(&plan), run.verbosity));
    let with = |grains: &GrainsPart, bodies, blades| {
        new_bed(run, grains, (&plan, &progress), (bodies, blades), surface)
    };
    let new_bed = |grains: &GrainsPart, bodies| with(grains, bodies, Vec::new());
    let mut bed = new_bed(grains, settled.all())?;
    if plan.press.needs_sleepers() && settled.sleepers.is_empty() {
        settled.sleepers = bedding::set_down(&bed, grains, surface);
        bed = new_bed(grains, settled.all())?;
    }
    let before = porosity(&bed, settled.bodies.len(), &plan.region);
    let region = plan.region;
    let name = format!("compaction {}: {}", index + 1, plan.press.name());
    let mut poured_from = Vec::new();
    let done = match &plan.press {
        Press::Vibration { planes, amplitude, frequency, cycles } => {
            shake(&mut bed, planes, amplitude, *frequency, *cycles)?;
            let rested = bed.rest(&plan.rest)?;
            Pressed::new(bed, rested, region)
        }
        Press::Squeeze { plane, velocity, porosity: target, max_travel } => {
            let (region, reached) = squeeze(&mut bed, &plan.region, *plane, velocity, *target, *max_travel)?;
            let rested = bed.rest(&plan.rest)?;
            if !reached {
                settled.warnings.push(format!(
                    "squeeze stopped at `max_travel` = {max_travel} m: porosity {:.4}, above the target {target}",
                    porosity(&bed, settled.bodies.len(), &region)
                ));
            }
            grains.place_plane(*plane, bed.state.plane_point(&bed.model, *plane));
            let wall_force = Some(force_on(&bed, *plane));
            Pressed { wall_force, ..Pressed::new(bed, rested, region) }
        }
        Press::Bedding { force, frequency, cycles } => {
            bedding::press(&mut bed, settled.bodies.len(), *force, *frequency, *cycles)?;
            let rested = bed.rest(&plan.rest)?;
            Pressed::new(bed, rested, region)
        }
        Press::Stabilizing { force, sway, frequency, cycles } => {
            let across = 1 - grains.track.sleeper.as_ref().map_or(0, |s| s.row.axis);
            bed = new_bed(grains, freed(settled, across))?;
            let shaken = (*force, *sway, across);
            bedding::stabilize(&mut bed, settled.bodies.len(), shaken, *frequency, *cycles)?;
            let rested = bed.rest(&plan.rest)?;
            warn_of_shift(settled, &bed, across, &name);
            Pressed::new(bed, rested, region)
        }
        Press::Tines(tines) => {
            let start = Pressed::new(bed, true, region);
            let row = grains.track.sleeper.as_ref().expect("sleepers that are tamped").row.clone();
            let new = |bodies: Vec<BodyInput>, blades: Vec<WallInput>| with(grains, bodies, blades);
            tines::tamp(start, (tines, &plan.rest), &row, settled, (&name, surface), new)?
        }
        Press::Pouring { parts, layers, .. } => {
            let new = |now: &Settled| new_bed(grains, now.all());
            let poured = bedding::pour(grains, settled, (&name, parts, *layers), &plan.rest, new)?;
            let Poured { bed, before, steps, rested } = poured;
            poured_from = before;
            Pressed { steps, bed, rested, region, wall_force: None }
        }
        Press::Tamping { .. } => {
            let start = Pressed::new(bed, true, region);
            let new = |bodies: Vec<BodyInput>| new_bed(grains, bodies);
            tamp(start, &plan, settled, (&name, surface), new)?
        }
    };
    let message = finish(settled, &done, (&*grains, index, surface), (&name, before, &poured_from))?;
    let seconds = progress.finish(&message);
    settled.stages.push(StageRecord { name, seconds, grain_steps: done.steps, solid_steps: 0, windows: 0 });
    Ok(())
}

/// Records a stage and takes its bed; returns a message.
fn finish(
    settled: &mut Settled,
    done: &Pressed<'_>,
    (grains, index, surface): (&GrainsPart, usize, Option<&SolidSurface>),
    (name, before, poured_from): (&str, f64, &[BodyInput]),
) -> Result<String, Failure> {
    let press = &grains.packing.compaction[index].press;
    let after = porosity(&done.bed, settled.bodies.len(), &done.region);
    warn_of_bed(settled, done, (grains, index));
    settled.beds.extend(bed_after((name, press), &done.bed, grains, surface, settled.bodies.len()));
    if let Press::Pouring { parts, level, .. } = press {
        settled.take(&done.bed);
        bedding::cut(settled, &done.bed, poured_from, parts, *level);
    } else {
        settled.energy.push(done.bed.energy(name)?);
        settled.take(&done.bed);
    }
    let kind = press.name();
    settled.compaction.push(CompactionRecord {
        kind: kind.into(),
        porosity_before: before,
        porosity_after: after,
        wall_force: done.wall_force,
    });
    Ok(format!("{kind}: porosity {before:.4} to {after:.4}"))
}

fn warn_of_shift(settled: &mut Settled, bed: &Bed<'_>, axis: usize, name: &str) {
    let first = settled.bodies.len();
    for (k, sleeper) in settled.sleepers.iter().enumerate() {
        let shift = bed.state.position(first + k)[axis] - sleeper.position[axis];
        if shift.abs() > SHIFT {
            let text = format!("sleeper {} moved by {:.1} mm across the track in {name}", k + 1, 1e3 * shift);
            settled.warnings.push(text);
        }
    }
}

/// Normal force on a plane [N].
fn force_on(bed: &Bed<'_>, plane: usize) -> f64 {
    let contacts = dem::measure::contacts(&bed.model, &bed.state);
    contacts.iter().filter(|c| c.b == dem::Partner::Plane(plane)).map(|c| c.normal_force).sum()
}

/// Bodies with sleepers that may move along an axis, held or not.
fn freed(settled: &Settled, axis: usize) -> Vec<BodyInput> {
    let mut bodies = settled.all();
    bodies[settled.bodies.len()..].iter_mut().for_each(|sleeper| sleeper.fixed[axis] = false);
    bodies
}

fn new_bed<'b>(
    run: &'b Run<'_>,
    grains: &GrainsPart,
    (plan, progress): (&CompactionPlan, &BedProgress),
    (bodies, blades): (Vec<BodyInput>, Vec<WallInput>),
    surface: Option<&'b SolidSurface>,
) -> Result<Bed<'b>, Failure> {
    let mut input = dem::ModelInput { bodies, ..grains.deposition_input(&plan.rest) };
    let grips = |part: u32| grains.groups.moving.iter().any(|m| m.part == part);
    for body in input.bodies.iter_mut().filter(|b| grips(b.part)) {
        (body.velocity, body.fixed) = (Vec3::zeros(), [true; 6]);
    }
    input.names.walls.truncate(input.walls.len());
    input.names.walls.extend((1..=blades.len()).map(|k| format!("tine {k}")));
    input.walls.extend(blades);
    let model = dem::Model::new(input).map_err(|e| refused(run.document, &e))?;
    Ok(Bed::new(model, surface, &run.checkpoints, COMPACTED).shown(progress))
}

/// Without sleepers, and grains that are removed above a level.
fn bed_after(
    (name, press): (&str, &Press),
    bed: &Bed<'_>,
    grains: &GrainsPart,
    surface: Option<&SolidSurface>,
    count: usize,
) -> Option<BedStage> {
    let Bed { model, state, .. } = bed;
    let removed = |b: usize| match press {
        Press::Pouring { parts, level: Some(level), .. } => {
            parts.contains(&model.part(b)) && state.position(b).z > *level
        }
        _ => false,
    };
    BedStage::of(name, GrainsView { model, state }, grains, surface, |b| b < count && !removed(b))
}

/// Of the first `grains` bodies: a platen is no grain.
fn porosity(bed: &Bed<'_>, grains: usize, region: &BoxRegion) -> f64 {
    let solid: f64 = (0..grains).map(|b| body_volume_in(&bed.model, &bed.state, b, region)).sum();
    1.0 - solid / region.volume()
}

/// Adds balances of presses and rests, except the last rest.
fn tamp<'b>(
    mut done: Pressed<'b>,
    plan: &CompactionPlan,
    settled: &mut Settled,
    (name, surface): (&str, Option<&SolidSurface>),
    new: impl Fn(Vec<BodyInput>) -> Result<Bed<'b>, Failure>,
) -> Result<Pressed<'b>, Failure> {
    let Press::Tamping { plate, half, at, force, frequency, cycles } = &plan.press else { return Ok(done) };
    let bodies = &settled.all();
    for (k, place) in at.iter().enumerate() {
        if k > 0 {
            settled.energy.push(done.bed.energy(name)?);
        }
        // Separate models with and without platen.
        let mut all = done.bed.at_rest(bodies);
        let z = top_below(&done.bed.model, &done.bed.state, *place, half, surface) + half[2];
        all.push(BodyInput { position: Vec3::new(place[0], place[1], z), ..plate.clone() });
        let mut pressed = new(all)?;
        bedding::press(&mut pressed, bodies.len(), *force, *frequency, *cycles)?;
        settled.energy.push(pressed.energy(name)?);
        done.bed = new(pressed.at_rest(bodies))?;
        done.rested &= done.bed.rest(&plan.rest)?;
        done.steps += pressed.state.steps + done.bed.state.steps;
    }
    Ok(done)
}

/// A sin(2πft) for whole cycles, back to the start.
fn shake(
    bed: &mut Bed<'_>,
    planes: &[usize],
    amplitude: &Vec3,
    frequency: f64,
    cycles: u32,
) -> Result<(), Failure> {
    let (begun, end) = (bed.state.time, f64::from(cycles) / frequency);
    let at = |t: f64| if t < end { libm::sin(TAU * frequency * t) } else { 0.0 };
    while bed.state.time - begun < end {
        let (t, dt) = (bed.state.time - begun, bed.dt());
        // Moves the plane exactly.
        let velocity = amplitude * ((at(t + dt) - at(t)) / dt);
        planes.iter().for_each(|&p| bed.state.set_plane_velocity(p, velocity));
        bed.step(&[])?;
    }
    planes.iter().for_each(|&p| bed.state.set_plane_velocity(p, Vec3::zeros()));
    Ok(())
}

/// Stops at the porosity of the cut region, or the longest travel.
fn squeeze(
    bed: &mut Bed<'_>,
    whole: &BoxRegion,
    plane: usize,
    velocity: &Vec3,
    target: f64,
    max_travel: f64,
) -> Result<(BoxRegion, bool), Failure> {
    let start = bed.state.plane_point(&bed.model, plane);
    let (axis, rising) = (velocity.iamax(), velocity.sum() > 0.0);
    bed.state.set_plane_velocity(plane, *velocity);
    let outcome = loop {
        let now = bed.state.plane_point(&bed.model, plane);
        let mut region = *whole;
        if rising {
            region.low[axis] = region.low[axis].max(now[axis]);
        } else {
            region.high[axis] = region.high[axis].min(now[axis]);
        }
        if porosity(bed, bed.model.body_count(), &region) <= target {
            break (region, true);
        }
        if (now - start).norm() >= max_travel {
            break (region, false);
        }
        bed.until_look()?;
    };
    bed.state.set_plane_velocity(plane, Vec3::zeros());
    Ok(outcome)
}
