//! Before the run proper: filled grains settle, the bed is levelled, the sleeper is set down.

use super::Stage;
use super::summary::{StageRecord, Summary};
use crate::failure::Failure;
use crate::model::grains::{DepositionPlan, GrainsPart, refused};
use crate::progress::Progress;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;

/// Time that bodies need to get going before slowness counts as rest [s].
const START_OF_SETTLING: f64 = 0.05;

impl Stage<'_> {
    /// Lets filled grains settle and levels the bed; the bodies come back at rest where they lie.
    pub(super) fn deposit(
        &self,
        grains: &GrainsPart,
        surface: Option<&SolidSurface>,
        summary: &mut Summary,
    ) -> Result<Vec<BodyInput>, Failure> {
        let Some(plan) = &grains.deposition else { return Ok(grains.bodies.clone()) };
        let input = grains.deposition_input(plan);
        let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        let progress = Progress::start("settling", plan.max_time, self.quiet);
        // Look at the speed about every millisecond.
        let stride = ((1e-3 / model.dt()) as u64).max(1);
        let mut settled = false;
        while state.time < plan.max_time && !settled {
            for _ in 0..stride {
                match surface {
                    Some(s) => dem::step(&model, &mut state, &mut work, s, &[]),
                    None => dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[]),
                }
                .map_err(|e| Failure::Numerical(format!("grains while settling: {e}")))?;
            }
            let speed = rms_speed(&model, &state);
            // Everything starts at rest: free fall has to be under way before slowness means anything.
            settled = state.time > START_OF_SETTLING && speed < plan.settled_speed;
            progress.at(state.time);
            progress.message(format!("rms speed {speed:.2e} m/s"));
        }
        if !settled {
            let speed = rms_speed(&model, &state);
            summary.warnings.push(format!(
                "the grains were still moving at {speed:.2e} m/s (root mean square) after {} s of settling",
                plan.max_time
            ));
        }
        let steps = state.steps;
        let (bodies, removed) = at_rest(&grains.bodies, &model, &state, plan);
        let seconds = progress.finish(&format!(
            "{} grains at rest after {:.2} s, {removed} above the level taken away",
            bodies.len(),
            state.time
        ));
        summary.stages.push(StageRecord {
            name: "settling".into(),
            seconds,
            grain_steps: steps,
            solid_steps: 0,
        });
        if bodies.is_empty() {
            return Err(self.document.error("deposition.level", "no grain below it", "at least one").into());
        }
        Ok(bodies)
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
