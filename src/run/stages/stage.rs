//! What a stage is, and what stages hand on to each other.

use super::carried::Carried;
use crate::failure::Failure;
use crate::model::Job;
use crate::model::grains::{GrainsPart, check_gaps, check_joined, check_overlaps, check_steps, refused};
use crate::run::bed::Bed;
use crate::run::checkpoint::{self, Loaded, Moment};
use crate::run::context::Run;
use crate::run::from::END;
use crate::run::packing::{CompactionRecord, GrowthRecord, StageEnergy};
use crate::run::sources;
use crate::run::summary::{StageRecord, Summary};
use crate::run::system::CoupledSystem;
use serde::{Deserialize, Serialize};
use std::path::Path;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_fem as fem;

/// Stage of a checkpoint from within the main loop.
pub const RUN: &str = "run";
/// Stage of a checkpoint from within the settling.
pub const SETTLING: &str = "settling";
/// Stage of a checkpoint between two stages of packing.
pub const PACKING: &str = "packing";
/// Stage of the checkpoint between the finished bed and the main loop.
pub const SETTLED: &str = "settled";

/// Simulated time of the grains in a stage [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrainTime {
    /// Known beforehand.
    Exactly(f64),
    /// Until the grains are at rest, or at most this.
    AtMost(f64),
}

/// Steps of the grains in a time [s], in words.
pub type Steps<'a> = &'a dyn Fn(f64) -> String;

/// One stage of a run. What a run carries out is what `check` and `explain` report of it.
pub trait Stage: Sync {
    /// Name for users; none where the stage is the end of the one before.
    fn name(&self) -> Option<&'static str>;

    /// Whether a run of the scene has it.
    fn applies(&self, job: &Job) -> bool;

    /// What `check` reports of it, line by line.
    fn report(&self, _job: &Job, _steps: Steps<'_>) -> Vec<String> {
        Vec::new()
    }

    /// What determines the time that it takes, where grains move.
    fn grain_time(&self, _job: &Job) -> Option<GrainTime> {
        None
    }

    /// Carries it out, or what a checkpoint has left of it.
    ///
    /// # Errors
    /// Bad input, a numerical failure, an interrupt, what the disk refuses.
    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure>;
}

/// How far the packing has come; compaction counts its own stages.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
pub enum Packed {
    /// No stage is over.
    Nothing,
    /// Grains have grown.
    Grown,
    /// All layers but the last lie.
    Layered,
    /// The bed has settled.
    Settled,
    /// The bed is finished.
    Finished,
}

/// A bed that has settled, or is about to.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Settled {
    /// The grains at rest.
    pub bodies: Vec<BodyInput>,
    /// The sleepers, once they are set down.
    pub sleepers: Vec<BodyInput>,
    /// Points of the planes, which compaction may have moved [m].
    pub planes: Vec<dem::Vec3>,
    /// Time that the settling took [s].
    pub time: f64,
    /// The stages so far.
    pub stages: Vec<StageRecord>,
    /// What was remarkable about them.
    pub warnings: Vec<String>,
    /// Results of growth.
    pub growth: Vec<GrowthRecord>,
    /// Results of compaction.
    pub compaction: Vec<CompactionRecord>,
    /// Energy balances of the stages.
    pub energy: Vec<StageEnergy>,
}

impl Settled {
    /// Grains and sleepers as bodies of one model.
    pub fn all(&self) -> Vec<BodyInput> {
        self.bodies.iter().chain(&self.sleepers).cloned().collect()
    }

    /// The bed without the record of its making, which belongs to the run that made it.
    pub fn places(&self) -> Settled {
        let Settled { bodies, sleepers, planes, time, .. } = self.clone();
        Settled { bodies, sleepers, planes, time, ..Settled::default() }
    }

    /// Takes over where a model of [`Settled::all`] has brought them, at rest.
    pub fn take(&mut self, bed: &Bed<'_>) {
        let mut all = bed.at_rest(&self.all());
        self.sleepers = all.split_off(self.bodies.len());
        self.bodies = all;
    }
}

/// The head of a checkpoint from within the packing.
#[derive(Deserialize)]
struct Packing {
    done: Packed,
    /// The grains that are to settle.
    bodies: Vec<BodyInput>,
    bed: Settled,
}

/// How far the run came whose checkpoint is in the folder `dir`: the stages of packing that it finished, and the time that the
/// main loop had reached [s], if that had begun.
pub fn reached(dir: &Path, job: &Job) -> (Vec<StageRecord>, Option<f64>) {
    let Some(mut loaded) = checkpoint::latest(dir) else { return Default::default() };
    let time = loaded.moment.time;
    match loaded.moment.stage.as_str() {
        RUN if !is_packed(job) => (Vec::new(), Some(time)),
        RUN => (loaded.take().map_or_else(|_| Vec::new(), |bed: Settled| bed.stages), Some(time)),
        SETTLED => (loaded.take().map_or_else(|_| Vec::new(), |bed: Settled| bed.stages), None),
        _ => (loaded.take().map_or_else(|_| Vec::new(), |packing: Packing| packing.bed.stages), None),
    }
}

/// The grains on their way to the main loop.
pub struct GrainsState {
    /// The grains, with walls where compaction has left them.
    pub part: GrainsPart,
    /// Which stages of packing are over.
    pub done: Packed,
    /// The bed.
    pub bed: Settled,
    /// The surface of the solid below, which does not move before the main loop.
    pub ground: Option<SolidSurface>,
    /// The bodies of the main loop.
    pub bodies: Vec<BodyInput>,
    /// Heights of the bases of the sleepers when they were set down [m].
    pub bases: Vec<f64>,
    /// The bed of another scene that these grains are.
    pub carried: Option<Carried>,
}

impl GrainsState {
    /// The state that a model of these grains, and of bodies after them, begins with.
    ///
    /// # Errors
    /// Bad input: the bed of another scene is of other grains.
    pub fn start(&self, model: &dem::Model) -> Result<dem::State, Failure> {
        let mut state = dem::State::new(model);
        if let Some(carried) = &self.carried {
            carried.put(model, &mut state)?;
        }
        Ok(state)
    }

    /// Writes the checkpoint between two stages of packing.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn keep(&mut self, run: &Run<'_>, done: Packed) -> Result<(), Failure> {
        self.bed.planes = planes(&self.part);
        let step = self.bed.stages.iter().map(|s| s.grain_steps).sum();
        let moment = Moment { stage: PACKING.into(), step, time: self.bed.time };
        run.checkpoints.save(moment, |body| body.put(&(done, &self.part.groups.bodies, &self.bed)))
    }
}

/// Grains and solid joined, ready for the main loop.
pub struct CoupledRun<'a> {
    /// Both.
    pub system: CoupledSystem<'a>,
    /// The solid, with meshed sleepers where they are set down.
    pub solid: &'a fem::Model,
    /// Height of the lowest point of the solid's surface [m].
    pub lowest: f64,
}

/// What stages hand on to each other.
pub struct RunState<'a> {
    /// The checkpoint that the run is continued from, until its stage has read it.
    pub loaded: Option<Loaded>,
    /// The bed of another scene, until the grains have it.
    pub carried: Option<Carried>,
    /// The grains, if there are any.
    pub grains: Option<GrainsState>,
    /// Grains and solid, once they are joined.
    pub coupled: Option<CoupledRun<'a>>,
    /// Results so far.
    pub summary: Summary,
}

/// Whether grains are packed before the main loop.
pub fn is_packed(job: &Job) -> bool {
    job.grains.as_ref().is_some_and(GrainsPart::is_packed)
}

/// Points of the planes [m].
pub fn planes(grains: &GrainsPart) -> Vec<dem::Vec3> {
    grains.walls.planes.iter().map(|p| p.point).collect()
}

impl RunState<'_> {
    /// Nothing done yet.
    pub fn new<'a>(loaded: Option<Loaded>, summary: Summary) -> RunState<'a> {
        RunState { loaded, carried: None, grains: None, coupled: None, summary }
    }

    /// Takes up the grains of the scene, or what a checkpoint has of them.
    ///
    /// # Errors
    /// A checkpoint of something else.
    pub fn begin(&mut self, job: &Job) -> Result<(), Failure> {
        let Some(part) = job.grains.clone() else { return Ok(()) };
        let ground = job.ground();
        let (bed, bodies, bases) = (Settled::default(), Vec::new(), Vec::new());
        let mut grains =
            GrainsState { part, done: Packed::Nothing, bed, ground, bodies, bases, carried: None };
        if let Some(mut carried) = self.carried.take().filter(|_| self.loaded.is_none()) {
            // The bodies are as the bed before began with them: bonds refer to these places. Where they are now follows with their state.
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
        } else if let Some(loaded) = self.loaded.as_mut().filter(|l| l.moment.stage == END) {
            // The bed is the one that the run before began with; where it is now follows with its state.
            match loaded.take::<Option<Settled>>()? {
                Some(bed) => (grains.bed, grains.done) = (bed, Packed::Finished),
                None => grains.bodies.clone_from(&grains.part.groups.bodies),
            }
        } else if !is_packed(job) {
            grains.bodies.clone_from(&grains.part.groups.bodies);
        } else if let Some(loaded) = &mut self.loaded {
            match loaded.moment.stage.as_str() {
                RUN | SETTLED => (grains.bed, grains.done) = (loaded.take()?, Packed::Finished),
                _ => {
                    let Packing { done, bodies, bed } = loaded.take()?;
                    grains.part.groups.bodies = bodies;
                    bed.planes.iter().enumerate().for_each(|(k, x)| grains.part.place_plane(k, *x));
                    (grains.bed, grains.done) = (bed, done);
                }
            }
            self.loaded.take_if(|l| ![RUN, SETTLING].contains(&l.moment.stage.as_str()));
        } else if grains.part.packing.deposition.is_none() {
            grains.bed.bodies.clone_from(&grains.part.groups.bodies);
        }
        self.grains = Some(grains);
        Ok(())
    }

    /// The model of the grains in the main loop; the summary gets its figures.
    ///
    /// # Errors
    /// Bad input.
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
        if !part.is_packed() {
            check_overlaps(run.document, part, &model, grains.ground.as_ref())?;
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
        summary.model.grain_step_set_by = Some(model.dt_limit().to_string());
        Ok(model)
    }
}
