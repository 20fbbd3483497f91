//! Deposition of grains under gravity, and levelling.

use super::layers::drop_layers;
use super::stage::{GrainTime, Packed, Packing, RunState, SETTLING, Settled, Stage, Steps};
use crate::bed;
use crate::checkpoint::{Loaded, Moment};
use crate::context::Run;
use crate::packing::{BedStage, StageEnergy};
use crate::summary::StageRecord;
use crate::system::GrainsView;
use std::borrow::Cow;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::{BackEnd, BodyInput};
use trackbed_input::model::Job;
use trackbed_input::model::grains::{DepositionPlan, GrainsPart, refused};
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;

const LOOK: f64 = 1e-3;

/// Acceleration time before low speed means rest [s].
const START_OF_SETTLING: f64 = 0.05;

/// Deposition, and removal above the level.
pub struct Settling;

impl Stage for Settling {
    fn name(&self) -> Option<&'static str> {
        Some(SETTLING)
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.as_ref().is_some_and(|g| g.packing.deposition.is_some())
    }

    fn report(&self, job: &Job, steps: Steps<'_>) -> Vec<String> {
        let plan = job.grains.as_ref().and_then(|g| g.packing.deposition.as_ref());
        let line = |d: &DepositionPlan| format!("settling: at most {} s, {}", d.max_time, steps(d.max_time));
        plan.map(line).into_iter().collect()
    }

    fn grain_time(&self, job: &Job) -> Option<GrainTime> {
        let plan = job.grains.as_ref()?.packing.deposition.as_ref()?;
        Some(GrainTime::AtMost(f64::from(plan.layers.max(1)) * plan.max_time))
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some(grains) = state.grains.as_mut().filter(|g| g.done < Packed::Settled) else { return Ok(()) };
        let Some(plan) = grains.part.packing.deposition.clone() else { return Ok(()) };
        if grains.done < Packed::Layered && plan.layers > 1 {
            grains.keep(run, Packed::Grown)?;
            run.checkpoints.begin();
            drop_layers(run, &mut grains.part, &plan, grains.ground.as_ref(), &mut grains.bed)?;
            run.checkpoints.end();
            grains.keep(run, Packed::Layered)?;
        }
        let resumed = state.loaded.take_if(|loaded| loaded.moment.stage == SETTLING);
        settle(run, &grains.part, &plan, grains.ground.as_ref(), &mut grains.bed, resumed)
    }
}

fn settle(
    run: &Run<'_>,
    grains: &GrainsPart,
    plan: &DepositionPlan,
    surface: Option<&SolidSurface>,
    bed: &mut Settled,
    resumed: Option<Loaded>,
) -> Result<(), Failure> {
    let input = grains.deposition_input(plan);
    let model = dem::Model::new(input).map_err(|e| refused(run.document, &e))?;
    let (mut state, seconds) = match resumed {
        Some(mut loaded) => loaded.take()?,
        None => (dem::State::new(&model), 0.0),
    };
    let mut work = dem::Work::new(&model, &state);
    let mut progress = Progress::start(SETTLING, plan.max_time, run.verbosity).resumed(state.time, seconds);
    let mut settled = false;
    let mut going = true;
    run.checkpoints.begin();
    while going {
        dem::stability::follow(&model, &mut state);
        match surface {
            Some(s) => work.step(&model, &mut state, s, &[]),
            None => work.step(&model, &mut state, &dem::surface::NoSurface, &[]),
        }
        .map_err(|e| Failure::Numerical(format!("settling: {}", model.name_objects(&e))))?;
        // Check the speed every millisecond.
        if bed::passed(&state, LOOK) {
            work.download(&model, &mut state)
                .map_err(|e| Failure::Numerical(format!("settling: {}", model.name_objects(&e))))?;
            let speed = bed::rms_speed(&model, &state);
            // Free fall must have started.
            settled = state.time > START_OF_SETTLING && plan.settled(speed, &model, &state);
            going = !settled && state.time < plan.max_time;
            progress.message(format!("root mean square speed {speed:.2e} m/s"));
            progress.at(state.time, || format!("t = {:.4} s", state.time));
        }
        if going {
            run.checkpoints.step(
                || Moment { stage: SETTLING.into(), step: state.steps, time: state.time },
                |body| {
                    let (bodies, bed) = (Cow::Borrowed(&grains.groups.bodies[..]), Cow::Borrowed(&*bed));
                    body.put(&Packing { done: Packed::Layered, bodies, bed })?;
                    body.put(&(&state, progress.seconds()))
                },
            )?;
        }
    }
    run.checkpoints.end();
    if !settled {
        let speed = bed::rms_speed(&model, &state);
        bed.warnings.push(format!(
            "grains not at rest: root mean square speed {speed:.2e} m/s after {} s of settling",
            plan.max_time
        ));
    }
    finish(run, (grains, plan), surface, bed, GrainsView { model: &model, state: &state }, progress)
}

/// Removes grains above the level, and records the bed.
fn finish(
    run: &Run<'_>,
    (grains, plan): (&GrainsPart, &DepositionPlan),
    surface: Option<&SolidSurface>,
    bed: &mut Settled,
    view: GrainsView<'_>,
    progress: Progress,
) -> Result<(), Failure> {
    let GrainsView { model, state } = view;
    let mut energy = StageEnergy::of(SETTLING, model, state, surface)?;
    let (bodies, removed) = at_rest(&grains.groups.bodies, model, state, plan);
    bed.warnings.extend(energy.remove(model, state, &grains.groups.bodies, &removed));
    bed.energy.push(energy);
    let stays = |b: usize| removed.binary_search(&b).is_err();
    let settled = BedStage::of(SETTLING, view, grains, surface, stays);
    bed.warnings.extend(settled.iter().flat_map(BedStage::warnings));
    bed.beds.extend(settled);
    let removed = removed.len();
    let seconds = progress.finish(&format!(
        "{} grains at rest after {:.2} s, {removed} above the level removed",
        bodies.iter().filter(|b| !b.absent).count(),
        state.time
    ));
    if bodies.is_empty() {
        return Err(run.document.error("deposition.level", "no grain below it", "at least one").into());
    }
    bed.stages.push(StageRecord {
        name: SETTLING.into(),
        seconds,
        grain_steps: state.steps,
        solid_steps: 0,
        windows: 0,
    });
    bed.bodies = bodies;
    bed.time = state.time;
    Ok(())
}

/// Without grains above the level, whose indices are returned.
fn at_rest(
    inputs: &[BodyInput],
    model: &dem::Model,
    state: &dem::State,
    plan: &DepositionPlan,
) -> (Vec<BodyInput>, Vec<usize>) {
    let (mut bodies, mut removed) = (Vec::with_capacity(inputs.len()), Vec::new());
    for (b, input) in inputs.iter().enumerate() {
        if input.absent {
            bodies.push(input.clone());
            continue;
        }
        let position = model.wrap(&state.position(b));
        if plan.level.is_some_and(|level| position.z > level) {
            removed.push(b);
            continue;
        }
        bodies.push(BodyInput {
            position,
            orientation: state.orientation(model, b),
            velocity: dem::Vec3::zeros(),
            spin: dem::Vec3::zeros(),
            ..input.clone()
        });
    }
    (bodies, removed)
}
