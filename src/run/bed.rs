//! Grain bed during packing: deposition, vibration, compaction.

use super::checkpoint_store::CheckpointStore;
use super::packing::StageEnergy;
use std::cell::RefCell;
use std::rc::Rc;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::{BackEnd, BodyInput};
use trackbed_input::model::grains::DepositionPlan;
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;

/// Acceleration time before low speed means rest [s].
const START: f64 = 0.02;

/// Progress over the beds of a stage, in time [s].
#[derive(Clone)]
pub struct BedProgress(Rc<RefCell<(Progress, f64)>>);

impl BedProgress {
    /// From time 0.
    pub fn new(progress: Progress) -> BedProgress {
        BedProgress(Rc::new(RefCell::new((progress, 0.0))))
    }

    fn advance(&self, state: &dem::State) {
        let (progress, done) = &mut *self.0.borrow_mut();
        *done += state.last_dt();
        if passed(state, 1e-3) {
            progress.at(*done, || format!("t = {:.4} s", state.time));
        }
    }

    /// Ends the stage with a message; returns its time [s].
    pub fn finish(&self, message: &str) -> f64 {
        self.0.borrow_mut().0.finish(message)
    }
}

/// Grains with surrounding walls and rigid solid.
pub struct Bed<'a> {
    /// Model.
    pub model: dem::Model,
    /// State.
    pub state: dem::State,
    work: dem::Work,
    surface: Option<&'a SolidSurface>,
    checkpoints: &'a CheckpointStore,
    doing: &'static str,
    progress: Option<BedProgress>,
}

impl<'a> Bed<'a> {
    /// Creates a bed; `doing` names its stage in errors.
    pub fn new(
        model: dem::Model,
        surface: Option<&'a SolidSurface>,
        checkpoints: &'a CheckpointStore,
        doing: &'static str,
    ) -> Bed<'a> {
        let state = dem::State::new(&model);
        let work = dem::Work::new(&model, &state);
        Bed { model, state, work, surface, checkpoints, doing, progress: None }
    }

    /// Shows the progress of steps.
    #[must_use]
    pub fn shown(self, progress: &BedProgress) -> Bed<'a> {
        Bed { progress: Some(progress.clone()), ..self }
    }

    /// Advances one step under forces.
    ///
    /// # Errors
    /// Numerical failures; interrupts.
    pub fn step(&mut self, applied: &[dem::AppliedForce]) -> Result<(), Failure> {
        dem::stability::follow(&self.model, &mut self.state);
        let Bed { model, state, work, .. } = self;
        match self.surface {
            Some(s) => work.step(model, state, s, applied),
            None => work.step(model, state, &dem::surface::NoSurface, applied),
        }
        // Every step of a bed is observed.
        .and_then(|()| work.download(model, state))
        .map_err(|e| Failure::Numerical(format!("{}: {}", self.doing, model.name_objects(&e))))?;
        self.progress.iter().for_each(|p| p.advance(&self.state));
        self.checkpoints.check(self.doing, self.state.time)
    }

    /// Returns the next step length [s].
    pub fn dt(&mut self) -> f64 {
        dem::stability::follow(&self.model, &mut self.state);
        self.state.dt()
    }

    /// Advances a millisecond, the check interval.
    ///
    /// # Errors
    /// As [`Bed::step`].
    pub fn until_look(&mut self) -> Result<(), Failure> {
        self.step(&[])?;
        while !passed(&self.state, 1e-3) {
            self.step(&[])?;
        }
        Ok(())
    }

    /// Lets the bed settle; returns whether in time.
    ///
    /// # Errors
    /// As [`Bed::step`].
    pub fn rest(&mut self, plan: &DepositionPlan) -> Result<bool, Failure> {
        let begun = self.state.time;
        while self.state.time - begun < plan.max_time {
            self.until_look()?;
            let moving = self.state.time - begun < START;
            if !moving && plan.settled(rms_speed(&self.model, &self.state), &self.model, &self.state) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the energy balance of the stage.
    ///
    /// # Errors
    /// Failed initial contact detection.
    pub fn energy(&self, stage: &str) -> Result<StageEnergy, Failure> {
        StageEnergy::of(stage, &self.model, &self.state, self.surface)
    }

    /// Returns the first bodies at rest in place, other data from `inputs`.
    pub fn at_rest(&self, inputs: &[BodyInput]) -> Vec<BodyInput> {
        let place = |(b, input): (usize, &BodyInput)| match input.absent {
            true => input.clone(),
            false => self.placed(b, input),
        };
        inputs.iter().enumerate().map(place).collect()
    }

    fn placed(&self, b: usize, input: &BodyInput) -> BodyInput {
        BodyInput {
            position: self.state.position(b),
            orientation: self.state.orientation(&self.model, b),
            velocity: dem::Vec3::zeros(),
            spin: dem::Vec3::zeros(),
            ..input.clone()
        }
    }
}

/// Whether the last step passed a multiple of `interval` [s].
pub fn passed(state: &dem::State, interval: f64) -> bool {
    (state.time / interval).floor() > ((state.time - state.last_dt()) / interval).floor()
}

/// Returns the RMS speed of all bodies [m/s].
pub fn rms_speed(model: &dem::Model, state: &dem::State) -> f64 {
    let present = (0..model.body_count()).filter(|&b| state.present(b));
    let sum: f64 = present.map(|b| state.velocity(b).norm_squared()).sum();
    (sum / state.present_count().max(1) as f64).sqrt()
}

/// Returns the contact height [m] of a box lowered at `centre` in plan; without a sphere below, the top of
/// the solid, or 0.
pub fn top_below(
    model: &dem::Model,
    state: &dem::State,
    centre: [f64; 2],
    half: &[f64; 3],
    surface: Option<&SolidSurface>,
) -> f64 {
    let mut top = f64::NEG_INFINITY;
    for body in (0..model.body_count()).filter(|&b| state.present(b)) {
        if let Some(z) = dem::measure::highest_over(model, state, body, centre, [half[0], half[1]]) {
            top = top.max(z);
        }
        for (x, r) in state.spheres(model, body) {
            let over = [0, 1].map(|d| ((x[d] - centre[d]).abs() - half[d]).max(0.0));
            let reach = r * r - over[0] * over[0] - over[1] * over[1];
            if reach > 0.0 {
                top = top.max(x.z + reach.sqrt());
            }
        }
    }
    if top.is_finite() { top } else { surface.map_or(0.0, |s| s.highest()) }
}
