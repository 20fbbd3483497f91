//! The run: fill, settle, place the sleeper, load, write.

mod bed;
mod bond_output;
mod checkpoint;
mod compact;
mod failure_factor;
mod flow;
mod folder;
mod frames;
mod initial;
mod keeper;
mod main_stage;
mod memory;
mod packed;
mod packing;
mod plastic;
mod record;
mod recorder;
mod settle;
mod solid_alone;
mod statics;
mod summary;
mod system;
mod track_output;
mod wall_output;

pub use keeper::Interrupt;
pub use memory::{Prediction, parse_size, size};
pub use summary::{Summary, peak_memory};

use crate::failure::Failure;
use crate::model::Job;
use crate::model::exchange::{self, CouplingPart};
use crate::model::grains::{GrainsPart, check_joined, refused};
use crate::model::solid::{Analysis, SolidPart, TimeMethod};
use crate::progress::Progress;
use crate::scene::{Document, Scene};
use checkpoint::{Loaded, Origin, Slots};
use keeper::Keeper;
use main_stage::RUN;
use settle::Settled;
use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use summary::{CouplingRecord, Hash, NewtonRecord};
use system::{CoupledSystem, GrainsSystem, Meshed, System};
use trackbed_coupling as coupling;
use trackbed_coupling::ledger::Spent;
use trackbed_coupling::scheme::{Passes, Scheme};
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::track::CyclicLoad;
use trackbed_dem as dem;
use trackbed_fem as fem;

/// How to run a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Folder of the results; default `results/<name>`.
    pub out: Option<PathBuf>,
    /// Threads; default all cores.
    pub threads: Option<usize>,
    /// Overrides `key.path=value`.
    pub set: Vec<String>,
    /// Most memory that a solid may need [bytes]; default what the machine has free.
    pub memory: Option<u64>,
    /// Go on from the last checkpoint in the folder of the results.
    pub resume: bool,
    /// Request to stop with a checkpoint.
    pub interrupt: Interrupt,
    /// Print nothing.
    pub quiet: bool,
}

/// What became of a run.
#[derive(Debug)]
pub enum Outcome {
    /// It is done.
    Done(Box<Summary>),
    /// It was to be resumed, but was done already; the folder of its results.
    WasDone(PathBuf),
}

/// Runs a scene and writes its results.
///
/// # Errors
/// Bad input, before anything is written; a numerical failure or an interrupt, with what was written until then left in
/// place.
pub fn run(scene: &Path, options: &Options) -> Result<Outcome, Failure> {
    let mut document = Document::open(scene)?;
    for assignment in &options.set {
        document.set(assignment)?;
    }
    let parsed: Scene = document.read()?;
    let pool = thread_pool(options.threads)?;
    let dir = options.out.clone().unwrap_or_else(|| default_folder(scene));
    let origin = origin(&document, &parsed);
    let (scene_hash, overrides) = (origin.scene_hash.clone(), origin.overrides.clone());
    let mut slots = Slots::new(&dir, origin);
    let mut loaded = None;
    if options.resume {
        if was_done(&dir, &scene_hash)? {
            return Ok(Outcome::WasDone(dir));
        }
        let (checkpoint, remark) = slots.load(&document)?;
        if let Some(remark) = remark {
            eprintln!("note: {remark}");
        }
        loaded = Some(checkpoint);
    }
    pool.install(|| {
        let job = Job::new(&document, &parsed)?;
        let mut summary = Summary {
            status: "running".into(),
            title: job.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene_hash,
            overrides,
            threads: rayon::current_num_threads(),
            ..Summary::default()
        };
        let command = resume_command(scene, &dir, &options.set);
        let stage = Stage {
            document: &document,
            job: &job,
            dir: &dir,
            quiet: options.quiet,
            memory: options.memory,
            prepared: Cell::new(false),
            keeper: Keeper::new(slots, options.interrupt.clone(), job.output.checkpoint, command),
            goes_on: loaded.as_ref().is_some_and(|l| l.moment.stage == RUN),
            loaded: RefCell::new(loaded),
            settled: RefCell::new(None),
        };
        let result = stage.run(&mut summary);
        summary.peak_memory = peak_memory();
        match &result {
            Ok(()) => summary.status = "done".into(),
            // Bad input leaves nothing behind, not even a summary.
            Err(Failure::Input(_)) => {}
            Err(Failure::Interrupted(_)) => summary.status = "interrupted".into(),
            Err(failure) => summary.status = format!("failed: {failure}"),
        }
        if matches!(result, Err(Failure::Input(_))) {
            return result.map(|()| Outcome::Done(Box::new(summary)));
        }
        // A failure before the first file, such as one while settling, has no folder yet, or one with the results of
        // an earlier run. What stopped the run comes before what stopped its summary.
        let cleared = if stage.prepared.get() { Ok(()) } else { stage.prepare() };
        let written = cleared.and_then(|()| summary.write(&dir)).and_then(|()| summary.write_log(&dir));
        let result = match (result, stage.keeper.kept()) {
            (Err(Failure::Numerical(text)), Some(kept)) => {
                Err(Failure::Numerical(format!("{text}; the last checkpoint is kept in {kept}")))
            }
            (result, _) => result,
        };
        result.and(written)?;
        // A run that is done has nothing to go on from; until here the last checkpoint stands.
        stage.keeper.clear()?;
        Ok(Outcome::Done(Box::new(summary)))
    })
}

/// Whether the results in `dir` are those of a finished run of the same scene, without any checkpoint of a later one.
///
/// # Errors
/// Bad input: they are of another scene.
fn was_done(dir: &Path, scene_hash: &str) -> Result<bool, Failure> {
    let text = std::fs::read_to_string(dir.join("summary.json")).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    if summary["status"] != "done" || dir.join(checkpoint::FOLDER).exists() {
        return Ok(false);
    }
    if summary["scene_hash"] != scene_hash {
        let dir = dir.display();
        return Err(Failure::Input(format!("--resume: {dir} holds the finished run of another scene")));
    }
    Ok(true)
}

/// The command that continues a run.
fn resume_command(scene: &Path, dir: &Path, set: &[String]) -> String {
    let quoted = |text: String| match text.chars().all(|c| c.is_alphanumeric() || "/._-=+".contains(c)) {
        true => text,
        false => format!("'{}'", text.replace('\'', "'\\''")),
    };
    let mut command = format!(
        "trackbed run {} --resume --out {}",
        quoted(scene.display().to_string()),
        quoted(dir.display().to_string())
    );
    set.iter().for_each(|s| command += &format!(" --set {}", quoted(s.clone())));
    command
}

/// The pool that a run works in: as many threads as asked for, with stacks deep enough for recursive elimination.
pub(crate) fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    if threads == Some(0) {
        return Err(Failure::Input("--threads: found 0, expected 1 or more".into()));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .stack_size(16 << 20)
        .build()
        .map_err(|e| Failure::Other(e.to_string()))
}

/// `results/` and the name of the scene file, or of its folder when the file is just called `scene.toml`.
pub(crate) fn default_folder(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = scene.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    let name = match (stem.as_str(), folder) {
        ("scene", Some(folder)) => folder,
        _ => stem,
    };
    Path::new("results").join(name)
}

/// What the results of a run depend on: scene, overrides, and the files that the scene names.
fn origin(document: &Document, scene: &Scene) -> Origin {
    let mut hash = Hash::default();
    hash.add(document.text().as_bytes());
    for (key, value) in document.overrides() {
        hash.add(key.as_bytes());
        hash.add(value.as_bytes());
    }
    let mut files = Vec::new();
    for file in files_of(scene) {
        // One that is missing or has gone changes the hash, which is what it is for.
        let content = std::fs::read(document.resolve(file)).unwrap_or_default();
        hash.add(&content);
        let mut own = Hash::default();
        own.add(&content);
        files.push((file.to_path_buf(), own.hex()));
    }
    Origin {
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: hash.hex(),
        scene: document.text().into(),
        overrides: document.overrides().iter().map(|(k, v)| format!("{k}={v}")).collect(),
        files,
    }
}

/// The files that a scene names.
fn files_of(scene: &Scene) -> Vec<&Path> {
    let mut files: Vec<&Path> = Vec::new();
    if let Some(s) = &scene.solid {
        files.extend(
            [&s.mesh, &s.nodes, &s.elements, &s.constraints].into_iter().flatten().map(PathBuf::as_path),
        );
        let histories = s.load.iter().map(|l| &l.history).chain(s.support.iter().map(|l| &l.history));
        files.extend(histories.flatten().filter_map(|h| h.file.as_deref()));
    }
    for g in &scene.grains {
        files.extend(g.library.as_deref());
        files.extend(g.packing.as_deref());
        files.extend(g.gradation.as_ref().map(|g| g.file.as_path()));
        files.extend(g.region.as_ref().and_then(|r| r.surface.as_deref()));
    }
    files.extend(scene.track.iter().filter_map(|t| t.load.as_ref()?.file.as_deref()));
    files.extend(scene.walls.iter().filter_map(|w| w.file.as_deref()));
    files.extend(scene.bond.iter().filter_map(|b| b.pairs.as_deref()));
    files
}

/// One run in progress.
struct Stage<'a> {
    document: &'a Document,
    job: &'a Job,
    dir: &'a Path,
    quiet: bool,
    memory: Option<u64>,
    /// Whether the folder is cleared of earlier results and holds those of this run.
    prepared: Cell<bool>,
    keeper: Keeper,
    /// Whether the run proper goes on from a checkpoint, so that the files in the folder are its own.
    goes_on: bool,
    /// The checkpoint that the run goes on from, until its stage takes it.
    loaded: RefCell<Option<Loaded>>,
    /// The bed that has settled, for the checkpoints of the run proper.
    settled: RefCell<Option<Settled>>,
}

impl Stage<'_> {
    fn run(&self, summary: &mut Summary) -> Result<(), Failure> {
        if let Some(solid) = &self.job.solid {
            summary.warnings.extend(solid.warnings.iter().cloned());
            let mesh = solid.model.mesh();
            summary.model.nodes = mesh.node_count();
            summary.model.elements = mesh.element_count();
            summary.model.unknowns = solid.model.free_dof_count();
            let prediction = Prediction::of(solid)?;
            prediction.check(self.memory)?;
            summary.model.predicted_memory = Some(prediction.total());
            summary.sources.extend(solid_sources(solid, self.job.grains.is_some()));
        }
        summary.sources.extend(self.job.grains.iter().flat_map(GrainsPart::sources));
        match (&self.job.solid, &self.job.grains, &self.job.coupling) {
            (Some(solid), None, _) => self.solid_alone(solid, summary),
            (None, Some(grains), _) => {
                let mut resumed = self.resumed(RUN);
                let (grains, deposited) = self.deposit(grains, None, resumed.as_mut(), summary)?;
                let grains = &grains;
                let (bodies, _) = self.with_sleeper(grains, deposited, None)?;
                let model = self.grain_model(grains, bodies, summary)?;
                let mut system = match &mut resumed {
                    Some(loaded) => GrainsSystem::resume(model, loaded)?,
                    None => GrainsSystem::new(model)?,
                };
                self.prepare()?;
                self.grain_stage(&mut system, grains, resumed, summary)?;
                self.record_packing(&system, grains, summary)
            }
            (Some(solid), Some(grains), Some(plan)) => {
                let ground = plan.ground(solid, grains);
                let transfer_kind = plan.transfer_kind(&ground);
                let mut resumed = self.resumed(RUN);
                let (grains, deposited) = self.deposit(grains, Some(&ground), resumed.as_mut(), summary)?;
                let grains = &grains;
                let (bodies, bases) = self.with_sleeper(grains, deposited, Some(&ground))?;
                let model = self.grain_model(grains, bodies, summary)?;
                let (classes, substeps) = plan.classes(grains, &model, solid, &ground);
                let whole = solid.sleepers.as_ref().map(|s| s.set_down(&solid.model, &bases));
                let body = Body { part: solid, model: whole.as_ref().unwrap_or(&solid.model), bases: &bases };
                let surface = if whole.is_some() { plan.surface(body.model, grains) } else { ground };
                let load = grains.load.as_ref();
                let mut system =
                    self.couple(body, model, plan, substeps, surface, load, resumed.as_mut(), summary)?;
                let substeps = system.model.substeps;
                let remarks = exchange::remarks(&classes, plan.scheme, substeps);
                if !self.quiet {
                    // Before anything can blow up.
                    remarks.iter().for_each(|r| eprintln!("note: {r}"));
                }
                summary.warnings.extend(remarks);
                let lowest = system.work.surface.lowest();
                summary.coupling = Some(CouplingRecord {
                    transfer: Default::default(),
                    scheme: plan.scheme,
                    substeps,
                    stability: exchange::stability(&classes),
                    classes,
                    passes: Default::default(),
                    interface_work_error: 0.0,
                    transfer_kind,
                });
                self.prepare()?;
                let outcome = self.grain_stage(&mut system, grains, resumed, summary);
                if let Some(record) = &mut summary.coupling {
                    record.transfer = system.state.audit;
                    record.passes = system.state.passes;
                    record.interface_work_error = system.spent().interface();
                }
                summary.warnings.extend(unconverged(&system.state.passes));
                summary.warnings.extend(late(&system.spent()));
                summary.warnings.extend(fallen(&system, lowest));
                outcome?;
                self.record_packing(&system, grains, summary)?;
                if self.job.output.tables {
                    let moved = &system.state.solid;
                    let reactions = fem::energy::reactions(body.model, moved, system.work.load());
                    statics::write_tables(body.model, moved, &reactions, self.dir)?;
                }
                summary.newton = system.work.newton().map(|s| NewtonRecord::of(&s));
                Ok(())
            }
            _ => unreachable!("a job has a solid or grains, and both only with a coupling"),
        }
    }

    fn prepare(&self) -> Result<(), Failure> {
        if self.goes_on {
            folder::resume(self.dir, &self.job.output)?;
        } else {
            self.keeper.clear_others()?;
            folder::prepare(self.dir, &self.job.output)?;
        }
        self.prepared.set(true);
        Ok(())
    }

    /// The checkpoint that the run goes on from, if it is of the stage `stage`.
    fn resumed(&self, stage: &str) -> Option<Loaded> {
        self.loaded.borrow_mut().take_if(|loaded| loaded.moment.stage == stage)
    }

    fn grain_model(
        &self,
        grains: &GrainsPart,
        bodies: Vec<dem::BodyInput>,
        summary: &mut Summary,
    ) -> Result<dem::Model, Failure> {
        let input = grains.input(bodies);
        check_joined(self.document, &grains.bonds, &input.bonds)?;
        if !grains.bonds.is_empty() {
            summary.sources.extend(BOND_SOURCES);
        }
        let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
        grains.check_ram(self.document, model.dt())?;
        grains.check_pads(self.document, model.dt())?;
        if grains.rail.is_some() {
            summary.sources.extend(RAIL_SOURCES);
        }
        summary.model.bodies = model.body_count();
        summary.model.spheres = model.sphere_count();
        summary.model.grain_step = Some(model.dt());
        summary.model.grain_step_limit = Some(model.dt_limit().dt);
        summary.model.grain_step_set_by = Some(model.dt_limit().to_string());
        Ok(model)
    }

    /// Joins grains and solid. The solid starts in static equilibrium with its weight and the grains that rest on
    /// it; the mesh file describes that loaded shape, as a survey would.
    fn couple<'b>(
        &self,
        body: Body<'b>,
        grains: dem::Model,
        plan: &CouplingPart,
        substeps: u32,
        mut surface: SolidSurface,
        load: Option<&'b CyclicLoad>,
        resumed: Option<&mut Loaded>,
        summary: &mut Summary,
    ) -> Result<CoupledSystem<'b>, Failure> {
        let progress = Progress::start("equilibrium", 1.0, self.quiet);
        let solid = body.part;
        let dead_load = solid.dead_load(body.model);
        let (reference, memory, state, seat_work) = match resumed {
            Some(loaded) => loaded.take()?,
            None => {
                let (state, resting, contacts) = equilibrium(body, &grains, &mut surface, &dead_load)?;
                let reference = state.u.clone();
                let start = coupling::step::State::new(state, resting);
                // Only the lagged scheme goes on with the load of before.
                let lagged = plan.scheme == Scheme::Lagged;
                (reference, None, if lagged { start.carrying(contacts) } else { start }, 0.0)
            }
        };
        let model = coupling::step::Model {
            solid: body.model,
            dead_load,
            reference,
            substeps,
            scheme: plan.scheme,
            theta: plan.theta,
            newton: solid.newton,
            grains,
        };
        let mut work = coupling::step::Work::new(&model, &state, surface)
            .and_then(|mut work| work.recall(&model, memory.as_ref()).map(|()| work))
            .map_err(|e| solid.failure(&e))?;
        if let Some(reduction) = solid.reduction {
            let reduced =
                fem::reduction::Reduced::new(body.model, work.surface.faces(), reduction).map_err(|e| {
                    Failure::from(self.document.error("solid.reduction", e.to_string(), "another choice"))
                })?;
            work.reduce(&model, Arc::new(reduced)).map_err(|e| solid.failure(&e))?;
            summary.model.reduction = work.reduction();
        }
        summary.model.solid_step = Some(model.window());
        progress.finish("solid in equilibrium with its weight and the bed, window matrix factored");
        let seats = solid.sleepers.as_ref().map(|bodies| Meshed {
            bodies,
            bases: body.bases,
            load,
            first_face: plan.ground_faces,
            work: seat_work,
        });
        Ok(CoupledSystem { model, state, work, loads: &solid.loads, ground_faces: plan.ground_faces, seats })
    }
}

/// The solid of a coupled run: its model has the meshed sleepers where they are set down, with their bases at these heights
/// [m].
#[derive(Clone, Copy)]
struct Body<'a> {
    part: &'a SolidPart,
    model: &'a fem::Model,
    bases: &'a [f64],
}

/// A remark on windows of the iterated scheme that found no end.
fn unconverged(passes: &Passes) -> Option<String> {
    (passes.unconverged > 0).then(|| {
        format!(
            "{} of {} windows had not converged after the last pass allowed: raise coupling.max_passes, or take fewer \
             coupling.substeps",
            passes.unconverged, passes.windows
        )
    })
}

/// Part of what was turned over, above which dashpots that act late are remarked on.
const LATE: f64 = 0.05;

/// A remark on dashpots at the solid's surface that take much less than their law has, because the solid does not move as
/// they were told.
fn late(spent: &Spent) -> Option<String> {
    let law = spent.dissipated() - spent.dashpot_lag;
    let part = -spent.dashpot_lag / spent.work().abs().max(law);
    (part > LATE).then(|| {
        format!(
            "the dashpots at the solid's surface took {:.3e} J less than their law has, {:.1} % of what was turned over: they act on \
             the surface's velocity at the start of a window; take fewer coupling.substeps, or coupling.theta above 0.5",
            -spent.dashpot_lag,
            100.0 * part
        )
    })
}

/// A remark on grains that have left the solid and lie or fall below its surface, whose lowest point was at `lowest` [m].
fn fallen(system: &CoupledSystem<'_>, lowest: f64) -> Option<String> {
    let (model, state) = (&system.model.grains, &system.state.grains);
    let fell = |b: &usize| state.present(*b) && state.position(*b).z < lowest - model.radius(*b);
    let mut below = (0..model.body_count()).filter(fell);
    let first = below.next()?;
    let x = state.position(first);
    Some(format!(
        "bodies that have left the solid and are below its surface: {}, the first is body {first} at ({:.4}, {:.4}, {:.4}) m: enlarge the \
         mesh, or put walls at its borders",
        1 + below.count(),
        x.x,
        x.y,
        x.z
    ))
}

/// The solid in equilibrium with its weight, its loads and the grains that lie on it, the grains with their contacts, and
/// the load of these [N].
fn equilibrium(
    body: Body<'_>,
    grains: &dem::Model,
    surface: &mut SolidSurface,
    dead_load: &[f64],
) -> Result<(fem::State, dem::State, Vec<f64>), Failure> {
    let Body { part: solid, model, .. } = body;
    let mut load = dead_load.to_vec();
    solid.add_loads(0.0, &mut load);
    let (contacts, resting) = coupling::step::resting_load(grains, surface, model.mesh())
        .map_err(|e| Failure::Numerical(format!("grains: {e}")))?;
    for (l, c) in load.iter_mut().zip(&contacts) {
        *l += c;
    }
    // Sleepers fall onto the grains only now: what stands is the ground.
    let ground = solid.ground().map_err(|e| Failure::Other(e.to_string()))?;
    let standing = ground.as_ref().unwrap_or(model);
    let (load, dead_load) = (&load[..standing.dof_count()], &dead_load[..standing.dof_count()]);
    let rest = if solid.is_linear() {
        let rest = fem::statics::solve(standing, load).map_err(|e| solid.failure(&e))?;
        let mut state = fem::state::State::new(standing);
        state.u.copy_from_slice(&rest.u);
        state
    } else {
        initial::under_load(solid, standing, dead_load, load)?
    };
    if ground.is_none() {
        return Ok((rest, resting, contacts));
    }
    let mut state = fem::state::State::new(model);
    for (all, own) in [(&mut state.u, &rest.u), (&mut state.v, &rest.v), (&mut state.a, &rest.a)] {
        all[..own.len()].copy_from_slice(own);
    }
    state.points = rest.points;
    if !state.points.is_empty() {
        state.points.resize(model.point_count(), model.value_count());
    }
    Ok((state, resting, contacts))
}

/// Sources of the methods that a solid uses.
fn solid_sources(part: &SolidPart, coupled: bool) -> Vec<&'static str> {
    let mut sources = vec![
        "elements: serendipity and linear kinds with mean dilatation, Zienkiewicz & Taylor, The Finite Element Method; Hughes \
         1980",
        "sparse factorization: multifrontal (Duff & Reid 1983) over dense kernels of the crate faer, nested dissection by \
         coordinates (George 1973)",
    ];
    match &part.analysis {
        _ if coupled => {
            sources.push("time integration of a window: mid-point form, Simo & Tarnow, ZAMP 43, 1992")
        }
        Analysis::Dynamic(TimeMethod::Hht(_)) => {
            sources.push("time integration: Hilber, Hughes & Taylor, Earthq. Eng. Struct. Dyn. 5, 1977");
        }
        Analysis::Dynamic(TimeMethod::Newmark(_)) => {
            sources.push("time integration: Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959");
        }
        Analysis::StrengthReduction(_) => {
            sources.push("strength reduction: Griffiths & Lane, Geotechnique 49(3), 1999");
        }
        Analysis::Static | Analysis::QuasiStatic(_) => {}
    }
    if !part.model.is_linear() {
        sources.extend(part.model.law_sources());
    }
    if !part.model.matrices().dashpots().is_empty() {
        sources.push("absorbing boundaries: Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95, 1969");
    }
    sources
}

const RAIL_SOURCES: [&str; 2] = [
    "rail: Euler-Bernoulli beam of cubic elements, Przemieniecki, Theory of Matrix Structural Analysis, 1968",
    "rail in time: average acceleration, Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
];

const BOND_SOURCES: [&str; 1] =
    ["bonds: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004; Wang, Acta Geotechnica 4, 2009"];
