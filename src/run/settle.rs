//! Before the run proper: filled grains settle, the bed is levelled, the sleeper is set down.

use super::Stage;
use super::checkpoint::{Loaded, Moment};
use super::summary::{StageRecord, Summary};
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
const SETTLING: &str = "settling";
/// Stage of the checkpoint between settling and run proper.
const SETTLED: &str = "settled";

/// A bed that has settled.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Settled {
    /// The grains at rest.
    bodies: Vec<BodyInput>,
    /// Time that it took [s].
    time: f64,
    stage: StageRecord,
    warnings: Vec<String>,
}

impl Stage<'_> {
    /// Lets filled grains settle and levels the bed; the bodies come back at rest where they lie. `resumed` is the checkpoint
    /// of a run proper, which has them already.
    pub(super) fn deposit(
        &self,
        grains: &GrainsPart,
        surface: Option<&SolidSurface>,
        resumed: Option<&mut Loaded>,
        summary: &mut Summary,
    ) -> Result<Vec<BodyInput>, Failure> {
        let Some(plan) = &grains.deposition else { return Ok(grains.bodies.clone()) };
        let settled = match (resumed, self.resumed(SETTLED)) {
            (Some(loaded), _) => loaded.take()?,
            (None, Some(mut loaded)) => loaded.take()?,
            (None, None) => {
                let settled = self.settle(grains, plan, surface)?;
                let moment =
                    Moment { stage: SETTLED.into(), step: settled.stage.grain_steps, time: settled.time };
                self.keeper.save(moment, |body| body.put(&settled))?;
                settled
            }
        };
        summary.warnings.extend(settled.warnings.iter().cloned());
        summary.stages.push(settled.stage.clone());
        let bodies = settled.bodies.clone();
        self.settled.replace(Some(settled));
        Ok(bodies)
    }

    /// The settling itself.
    fn settle(
        &self,
        grains: &GrainsPart,
        plan: &DepositionPlan,
        surface: Option<&SolidSurface>,
    ) -> Result<Settled, Failure> {
        let input = grains.deposition_input(plan);
        let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
        let (mut state, seconds) = match self.resumed(SETTLING) {
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
                let speed = rms_speed(&model, &state);
                // Everything starts at rest: free fall has to be under way before slowness means anything.
                settled = state.time > START_OF_SETTLING && speed < plan.settled_speed;
                going = !settled && state.time < plan.max_time;
                progress.at(state.time);
                progress.message(format!("rms speed {speed:.2e} m/s"));
            }
            if going {
                self.keeper.step(
                    || Moment { stage: SETTLING.into(), step: state.steps, time: state.time },
                    |body| body.put(&(&state, progress.seconds())),
                )?;
            }
        }
        self.keeper.end();
        let mut warnings = Vec::new();
        if !settled {
            let speed = rms_speed(&model, &state);
            warnings.push(format!(
                "the grains were still moving at {speed:.2e} m/s (root mean square) after {} s of settling",
                plan.max_time
            ));
        }
        let (bodies, removed) = at_rest(&grains.bodies, &model, &state, plan);
        let seconds = progress.finish(&format!(
            "{} grains at rest after {:.2} s, {removed} above the level taken away",
            bodies.len(),
            state.time
        ));
        if bodies.is_empty() {
            return Err(self.document.error("deposition.level", "no grain below it", "at least one").into());
        }
        let stage = StageRecord { name: SETTLING.into(), seconds, grain_steps: state.steps, solid_steps: 0 };
        Ok(Settled { bodies, time: state.time, stage, warnings })
    }

    /// Adds the sleeper, just above the highest grain below it.
    pub(super) fn with_sleeper(
        &self,
        grains: &GrainsPart,
        mut bodies: Vec<BodyInput>,
        surface: Option<&SolidSurface>,
    ) -> Result<Vec<BodyInput>, Failure> {
        let Some(plan) = &grains.sleeper else { return Ok(bodies) };
        let model = dem::Model::new(grains.input(bodies.clone())).map_err(|e| refused(self.document, &e))?;
        let state = dem::State::new(&model);
        let mut top = f64::NEG_INFINITY;
        for body in 0..model.body_count() {
            for (x, r) in state.spheres(&model, body) {
                let over = [0, 1].map(|d| ((x[d] - plan.centre[d]).abs() - plan.half[d]).max(0.0));
                let reach = r * r - over[0] * over[0] - over[1] * over[1];
                if reach > 0.0 {
                    top = top.max(x.z + reach.sqrt());
                }
            }
        }
        if !top.is_finite() {
            // No grain below: on the solid, or on the plane z = 0.
            top = surface.map_or(0.0, |s| s.highest());
        }
        bodies.push(grains.sleeper_body(plan, top + plan.half[2]));
        Ok(bodies)
    }
}

/// Root-mean-square speed of all bodies [m/s].
fn rms_speed(model: &dem::Model, state: &dem::State) -> f64 {
    let n = model.body_count();
    let sum: f64 = (0..n).map(|b| state.velocity(b).norm_squared()).sum();
    (sum / n.max(1) as f64).sqrt()
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
        let position = state.position(b);
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
