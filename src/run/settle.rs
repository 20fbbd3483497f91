//! Before the run proper: filled grains settle, the bed is levelled, the sleepers are set down.

use super::checkpoint::{Loaded, Moment};
use super::packed::Packed;
use super::packing::{CompactionRecord, GrowthRecord};
use super::summary::{StageRecord, Summary};
use super::{Stage, bed};
use crate::failure::Failure;
use crate::model::grains::{DepositionPlan, GrainsPart, refused};
use crate::progress::Progress;
use serde::{Deserialize, Serialize};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;

/// Time that bodies need to get going before slowness counts as rest [s].
const START_OF_SETTLING: f64 = 0.05;

/// Stage of a checkpoint from within the settling.
pub(super) const SETTLING: &str = "settling";
/// Stage of the checkpoint between settling and run proper.
const SETTLED: &str = "settled";

/// A bed that has settled.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Settled {
    /// The grains at rest.
    pub bodies: Vec<BodyInput>,
    /// Points of the planes, which compaction may have moved [m].
    pub planes: Vec<dem::Vec3>,
    /// Time that the settling took [s].
    pub time: f64,
    pub stages: Vec<StageRecord>,
    pub warnings: Vec<String>,
    pub growth: Vec<GrowthRecord>,
    pub compaction: Vec<CompactionRecord>,
}

impl Stage<'_> {
    /// Makes the bed that the run proper starts with: grains grow, settle, and are compacted. They come back at rest where they
    /// lie, with the walls where compaction has left them. `resumed` is the checkpoint of a run proper, which has them already.
    pub(super) fn deposit(
        &self,
        grains: &GrainsPart,
        surface: Option<&SolidSurface>,
        resumed: Option<&mut Loaded>,
        summary: &mut Summary,
    ) -> Result<(GrainsPart, Vec<BodyInput>), Failure> {
        let mut grains = grains.clone();
        if grains.deposition.is_none() && grains.growths.is_empty() && grains.compaction.is_empty() {
            let bodies = grains.bodies.clone();
            return Ok((grains, bodies));
        }
        let settled = match (resumed, self.resumed(SETTLED)) {
            (Some(loaded), _) => loaded.take()?,
            (None, Some(mut loaded)) => loaded.take()?,
            (None, None) => {
                let settled = self.packed(grains.clone(), surface)?;
                let step = settled.stages.iter().map(|s| s.grain_steps).sum();
                let moment = Moment { stage: SETTLED.into(), step, time: settled.time };
                self.keeper.save(moment, |body| body.put(&settled))?;
                settled
            }
        };
        summary.warnings.extend(settled.warnings.iter().cloned());
        summary.stages.extend(settled.stages.iter().cloned());
        summary.growth.clone_from(&settled.growth);
        summary.compaction.clone_from(&settled.compaction);
        let bodies = settled.bodies.clone();
        settled.planes.iter().enumerate().for_each(|(k, point)| grains.place_plane(k, *point));
        self.settled.replace(Some(settled));
        Ok((grains, bodies))
    }

    /// The settling itself, from the start or from within a checkpoint; adds to what was done before.
    pub(super) fn settle(
        &self,
        grains: &GrainsPart,
        plan: &DepositionPlan,
        surface: Option<&SolidSurface>,
        bed: &mut Settled,
        resumed: Option<Loaded>,
    ) -> Result<(), Failure> {
        let input = grains.deposition_input(plan);
        let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
        let (mut state, seconds) = match resumed {
            Some(mut loaded) => loaded.take()?,
            None => (dem::State::new(&model), 0.0),
        };
        let mut work = dem::Work::new(&model, &state);
        let progress = Progress::start(SETTLING, plan.max_time, self.quiet).resumed(state.time, seconds);
        // Look at the speed about every millisecond.
        let stride = ((1e-3 / model.dt()) as u64).max(1);
        let mut settled = false;
        let mut going = true;
        self.keeper.begin();
        while going {
            match surface {
                Some(s) => dem::step(&model, &mut state, &mut work, s, &[]),
                None => dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[]),
            }
            .map_err(|e| Failure::Numerical(format!("grains while settling: {e}")))?;
            if state.steps.is_multiple_of(stride) {
                let speed = bed::rms_speed(&model, &state);
                // Everything starts at rest: free fall has to be under way before slowness means anything.
                settled = state.time > START_OF_SETTLING && plan.settled(speed, &model, &state);
                going = !settled && state.time < plan.max_time;
                progress.at(state.time);
                progress.message(format!("rms speed {speed:.2e} m/s"));
            }
            if going {
                self.keeper.step(
                    || Moment { stage: SETTLING.into(), step: state.steps, time: state.time },
                    |body| {
                        body.put(&(Packed::Layered, &grains.bodies, &*bed))?;
                        body.put(&(&state, progress.seconds()))
                    },
                )?;
            }
        }
        self.keeper.end();
        if !settled {
            let speed = bed::rms_speed(&model, &state);
            bed.warnings.push(format!(
                "the grains were still moving at {speed:.2e} m/s (root mean square) after {} s of settling",
                plan.max_time
            ));
        }
        let (bodies, removed) = at_rest(&grains.bodies, &model, &state, plan);
        let seconds = progress.finish(&format!(
            "{} grains at rest after {:.2} s, {removed} above the level taken away",
            bodies.iter().filter(|b| !b.absent).count(),
            state.time
        ));
        if bodies.is_empty() {
            return Err(self.document.error("deposition.level", "no grain below it", "at least one").into());
        }
        bed.stages.push(StageRecord {
            name: SETTLING.into(),
            seconds,
            grain_steps: state.steps,
            solid_steps: 0,
        });
        bed.bodies = bodies;
        bed.time = state.time;
        Ok(())
    }

    /// Adds the sleepers, each just above the highest grain below it. Comes back with the heights of their bases [m];
    /// meshed ones are no bodies.
    pub(super) fn with_sleeper(
        &self,
        grains: &GrainsPart,
        mut bodies: Vec<BodyInput>,
        surface: Option<&SolidSurface>,
    ) -> Result<(Vec<BodyInput>, Vec<f64>), Failure> {
        let Some(plan) = &grains.sleeper else { return Ok((bodies, Vec::new())) };
        let model = dem::Model::new(grains.input(bodies.clone())).map_err(|e| refused(self.document, &e))?;
        let state = dem::State::new(&model);
        let base = |&centre: &[f64; 2]| bed::top_below(&model, &state, centre, &plan.row.half, surface);
        let bases: Vec<f64> = plan.row.centres.iter().map(base).collect();
        if !plan.row.meshed {
            for (&centre, base) in plan.row.centres.iter().zip(&bases) {
                bodies.push(grains.sleeper_body(plan, centre, base + plan.row.half[2]));
            }
        }
        Ok((bodies, bases))
    }
}

/// Bodies where they have come to lie, at rest, without those above the level.
fn at_rest(
    inputs: &[BodyInput],
    model: &dem::Model,
    state: &dem::State,
    plan: &DepositionPlan,
) -> (Vec<BodyInput>, usize) {
    let mut bodies = Vec::with_capacity(inputs.len());
    for (b, input) in inputs.iter().enumerate() {
        if input.absent {
            bodies.push(input.clone());
            continue;
        }
        let position = model.wrap(&state.position(b));
        if plan.level.is_some_and(|level| position.z > level) {
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
    let removed = inputs.len() - bodies.len();
    (bodies, removed)
}
