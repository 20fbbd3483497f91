//! Stage interface, and state passed between stages.

use super::carried::Carried;
use super::reworked;
use crate::bed::Bed;
use crate::checkpoint::{self, Loaded, Moment};
use crate::context::Run;
use crate::from::{END, Previous};
use crate::packing::{BedStage, CompactionRecord, GrownOverlap, GrowthRecord, StageEnergy, TampingRecord};
use crate::sources;
use crate::summary::{StageRecord, Summary};
use crate::system::CoupledSystem;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::Path;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_fem as fem;
use trackbed_input::model::Job;
use trackbed_input::model::grains::{
    GrainsPart, check_gaps, check_joined, check_overlaps, check_steps, refused,
};
use trackbed_io::failure::Failure;

/// Checkpoint stage: within the main loop.
pub const RUN: &str = "run";
/// Checkpoint stage: within settling.
pub const SETTLING: &str = "settling";
/// Checkpoint stage: between packing stages.
pub const PACKING: &str = "packing";
/// Checkpoint stage: after packing.
pub const SETTLED: &str = "settled";

/// Simulated DEM time of a stage [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrainTime {
    /// Known.
    Exactly(f64),
    /// Until rest, at most this.
    AtMost(f64),
}

/// Formats the DEM steps in a time [s].
pub type Steps<'a> = &'a dyn Fn(f64) -> String;

/// Stage, also reported by `check` and `explain`.
pub trait Stage: Sync {
    /// User-visible name; none for the end of the previous stage.
    fn name(&self) -> Option<&'static str>;

    /// Whether the scene has this stage.
    fn applies(&self, job: &Job) -> bool;

    /// Lines for `check`.
    fn report(&self, _job: &Job, _steps: Steps<'_>) -> Vec<String> {
        Vec::new()
    }

    /// DEM time of the stage, if any.
    fn grain_time(&self, _job: &Job) -> Option<GrainTime> {
        None
    }

    /// Runs the stage, or the remainder after a checkpoint.
    ///
    /// # Errors
    /// Input errors, numerical failures, interrupts, I/O errors.
    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure>;
}

/// Packing progress; compaction stages are counted separately.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
pub enum Packed {
    /// Nothing done.
    Nothing,
    /// Grown.
    Grown,
    /// All layers but the last deposited.
    Layered,
    /// Deposited.
    Settled,
    /// Finished.
    Finished,
}

/// Bed during or after deposition.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Settled {
    /// Grains.
    pub bodies: Vec<BodyInput>,
    /// Sleepers, once placed.
    pub sleepers: Vec<BodyInput>,
    /// Plane positions, moved by compaction [m].
    pub planes: Vec<dem::Vec3>,
    /// Settling time [s].
    pub time: f64,
    /// Stage records.
    pub stages: Vec<StageRecord>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Results of growth.
    pub growth: Vec<GrowthRecord>,
    /// Deepest contact after growth.
    pub grown: Option<GrownOverlap>,
    /// Results of compaction.
    pub compaction: Vec<CompactionRecord>,
    /// Energy balances of the stages.
    pub energy: Vec<StageEnergy>,
    /// Bed after the stages.
    pub beds: Vec<BedStage>,
    /// Compaction stages of an earlier run, not in the records.
    pub earlier: usize,
    /// Tamped sleepers.
    pub tamping: Vec<TampingRecord>,
}

impl Settled {
    /// Returns grains and sleepers as bodies of one model.
    pub fn all(&self) -> Vec<BodyInput> {
        self.bodies.iter().chain(&self.sleepers).cloned().collect()
    }

    /// Returns the bed without its records.
    pub fn places(&self) -> Settled {
        let Settled { bodies, sleepers, planes, time, .. } = self.clone();
        Settled { bodies, sleepers, planes, time, ..Settled::default() }
    }

    /// Updates from a model of [`Settled::all`], at rest.
    pub fn take(&mut self, bed: &Bed<'_>) {
        let mut all = bed.at_rest(&self.all());
        self.sleepers = all.split_off(self.bodies.len());
        self.bodies = all;
    }
}

/// Checkpoint between packing stages, and before the state of settling.
#[derive(Serialize, Deserialize)]
pub struct Packing<'a> {
    /// Stages done.
    pub done: Packed,
    /// Grains of the next stage.
    pub bodies: Cow<'a, [BodyInput]>,
    /// The bed so far.
    pub bed: Cow<'a, Settled>,
}

/// Returns completed packing stages and main-loop time [s] of the run in `dir`.
pub fn reached(dir: &Path, job: &Job) -> (Vec<StageRecord>, Option<f64>) {
    let Some(mut loaded) = checkpoint::latest(dir) else { return Default::default() };
    let time = loaded.moment.time;
    match loaded.moment.stage.as_str() {
        RUN if !is_packed(job) => (Vec::new(), Some(time)),
        RUN => (loaded.take().map_or_else(|_| Vec::new(), |bed: Settled| bed.stages), Some(time)),
        SETTLED => (loaded.take().map_or_else(|_| Vec::new(), |bed: Settled| bed.stages), None),
        _ => (
            loaded.take().map_or_else(|_| Vec::new(), |packing: Packing<'_>| packing.bed.into_owned().stages),
            None,
        ),
    }
}

/// Grains before the main loop.
pub struct GrainsState {
    /// Grains with current wall positions.
    pub part: GrainsPart,
    /// Completed packing stages.
    pub done: Packed,
    /// The bed.
    pub bed: Settled,
    /// Fixed surface of the solid below.
    pub ground: Option<SolidSurface>,
    /// Main-loop bodies.
    pub bodies: Vec<BodyInput>,
    /// Sleeper base heights at placement [m].
    pub bases: Vec<f64>,
    /// Imported bed.
    pub carried: Option<Carried>,
}

impl GrainsState {
    /// Returns the initial state of a model.
    ///
    /// # Errors
    /// Imported bed of other grains.
    pub fn start(&self, model: &dem::Model) -> Result<dem::State, Failure> {
        let mut state = dem::State::new(model);
        if let Some(carried) = &self.carried {
            carried.put(model, &mut state)?;
        }
        Ok(state)
    }

    /// Sleepers of an earlier run with the fixed motions of this scene.
    fn hold_sleepers(&mut self) {
        if let Some(plan) = self.part.track.rigid_sleeper() {
            self.bed.sleepers.iter_mut().for_each(|sleeper| sleeper.fixed = plan.row.held);
        }
    }

    /// Saves a checkpoint between packing stages.
    ///
    /// # Errors
    /// I/O errors.
    pub fn keep(&mut self, run: &Run<'_>, done: Packed) -> Result<(), Failure> {
        self.bed.planes = planes(&self.part);
        let step = self.bed.stages.iter().map(|s| s.grain_steps).sum();
        let moment = Moment { stage: PACKING.into(), step, time: self.bed.time };
        let (bodies, bed) = (Cow::Borrowed(&self.part.groups.bodies[..]), Cow::Borrowed(&self.bed));
        run.checkpoints.save(moment, |body| body.put(&Packing { done, bodies, bed }))
    }
}

/// Coupled model before the main loop.
pub struct CoupledRun<'a> {
    /// Coupled system.
    pub system: CoupledSystem<'a>,
    /// Solid with sleepers set down.
    pub solid: &'a fem::Model,
    /// Lowest surface point of the solid [m].
    pub lowest: f64,
}

/// State passed between stages.
pub struct RunState<'a> {
    /// Unread checkpoint.
    pub loaded: Option<Loaded>,
    /// Imported bed, until used.
    pub carried: Option<Carried>,
    /// Earlier run whose bed further compaction reworks, until used.
    pub reworked: Option<Previous>,
    /// Grains, if any.
    pub grains: Option<GrainsState>,
    /// Coupled model, once built.
    pub coupled: Option<CoupledRun<'a>>,
    /// Results so far.
    pub summary: Summary,
}

/// Whether grains are packed before the main loop.
pub fn is_packed(job: &Job) -> bool {
    job.grains.as_ref().is_some_and(GrainsPart::is_packed)
}

/// Returns plane positions [m].
pub fn planes(grains: &GrainsPart) -> Vec<dem::Vec3> {
    grains.walls.planes.iter().map(|p| p.point).collect()
}

impl RunState<'_> {
    /// Creates an empty state.
    pub fn new<'a>(loaded: Option<Loaded>, summary: Summary) -> RunState<'a> {
        RunState { loaded, carried: None, reworked: None, grains: None, coupled: None, summary }
    }

    /// Loads the grains.
    ///
    /// # Errors
    /// Checkpoint with other content.
    pub fn begin(&mut self, job: &Job) -> Result<(), Failure> {
        let Some(part) = job.grains.clone() else { return Ok(()) };
        let ground = job.ground();
        let (bed, bodies, bases) = (Settled::default(), Vec::new(), Vec::new());
        let mut grains =
            GrainsState { part, done: Packed::Nothing, bed, ground, bodies, bases, carried: None };
        if let Some(mut carried) = self.carried.take().filter(|_| self.loaded.is_none()) {
            // Bonds refer to initial positions; current ones follow with the state.
            let bodies = carried.bodies(&grains.part);
            match is_packed(job) {
                true => {
                    let planes = planes(&grains.part);
                    grains.bed = Settled { bodies, planes, ..Settled::default() };
                    grains.done = Packed::Finished;
                }
                false => grains.bodies = bodies,
            }
            grains.carried = Some(carried);
        } else if let Some(before) = self.reworked.take().filter(|_| self.loaded.is_none()) {
            grains.bed = reworked::bed(before, &grains.part)?;
            grains.done = Packed::Settled;
            grains.hold_sleepers();
            let GrainsState { part, bed, .. } = &mut grains;
            bed.planes.iter().enumerate().for_each(|(k, x)| part.place_plane(k, *x));
        } else if let Some(loaded) = self.loaded.as_mut().filter(|l| l.moment.stage == END) {
            // Initial bed; its state follows.
            match loaded.take::<Option<Settled>>()? {
                Some(bed) => {
                    (grains.bed, grains.done) = (bed, Packed::Finished);
                    grains.hold_sleepers();
                }
                None => grains.bodies.clone_from(&grains.part.groups.bodies),
            }
        } else if !is_packed(job) {
            grains.bodies.clone_from(&grains.part.groups.bodies);
        } else if let Some(loaded) = &mut self.loaded {
            match loaded.moment.stage.as_str() {
                RUN | SETTLED => (grains.bed, grains.done) = (loaded.take()?, Packed::Finished),
                _ => {
                    let Packing { done, bodies, bed } = loaded.take()?;
                    (grains.part.groups.bodies, grains.bed, grains.done) =
                        (bodies.into_owned(), bed.into_owned(), done);
                    let GrainsState { part, bed, .. } = &mut grains;
                    bed.planes.iter().enumerate().for_each(|(k, x)| part.place_plane(k, *x));
                }
            }
            self.loaded.take_if(|l| ![RUN, SETTLING].contains(&l.moment.stage.as_str()));
        } else if grains.part.packing.deposition.is_none() {
            grains.bed.bodies.clone_from(&grains.part.groups.bodies);
        }
        self.grains = Some(grains);
        Ok(())
    }

    /// Builds the main-loop grain model.
    ///
    /// # Errors
    /// Input errors.
    pub fn grain_model(&mut self, run: &Run<'_>) -> Result<dem::Model, Failure> {
        let grains = self.grains.as_mut().expect("a run with grains");
        let (part, summary) = (&grains.part, &mut self.summary);
        check_gaps(run.document, &part.bonds, &grains.bodies, &part.groups.shapes)?;
        let input = part.input(std::mem::take(&mut grains.bodies));
        check_joined(run.document, &part.bonds, &input.bonds)?;
        if !part.bonds.is_empty() {
            summary.sources.extend(sources::BONDS);
        }
        let model = dem::Model::new(input).map_err(|e| refused(run.document, &e))?;
        // Checked before packing; an imported bed meets other walls.
        if self.loaded.is_none() && (!part.is_packed() || grains.carried.is_some()) {
            let (start, ground) = (grains.start(&model)?, grains.ground.as_ref());
            let imported = grains.carried.as_ref().map_or(0, Carried::count);
            check_overlaps(run.document, part, (&model, start), ground, imported)?;
        }
        check_steps(run.document, "time.end", run.job.end, model.dt())?;
        part.track.check_ram(run.document, model.dt())?;
        part.track.check_pads(run.document, model.dt())?;
        if part.track.rail.is_some() {
            summary.sources.extend(sources::RAIL);
        }
        summary.model.bodies = model.body_count();
        summary.model.spheres = model.sphere_count();
        summary.model.grain_step = Some(model.dt());
        summary.model.grain_step_limit = Some(model.dt_limit().dt);
        summary.model.grain_step_set_by = Some(model.describe_limit());
        Ok(model)
    }
}
