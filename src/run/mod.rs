//! The run: fill, settle, place the sleeper, load, write.

mod cycles;
mod frames;
mod record;
mod statics;
mod summary;
mod system;

pub use cycles::{Cycle, CycleRecorder};
pub use summary::{Summary, peak_memory};

use crate::failure::Failure;
use crate::model::grains::{DepositionPlan, GrainsPart, refused};
use crate::model::{CouplingPart, Job};
use crate::progress::Progress;
use crate::scene::{Document, Scene};
use record::{Recorder, Sleeper};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use summary::{CouplingRecord, EnergyRecord, Hash, MomentumRecord, SettlementRecord, StageRecord};
use system::{CoupledSystem, GrainsSystem, SolidSystem, System};
use trackbed_coupling as coupling;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
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
    /// Print nothing.
    pub quiet: bool,
}

/// Runs a scene and writes its results.
///
/// # Errors
/// Bad input, before anything is written; or a numerical failure, with what was written until then left in place.
pub fn run(scene: &Path, options: &Options) -> Result<Summary, Failure> {
    let mut document = Document::open(scene)?;
    for assignment in &options.set {
        document.set(assignment)?;
    }
    let parsed: Scene = document.read()?;
    let pool = thread_pool(options.threads)?;
    pool.install(|| {
        let job = Job::new(&document, &parsed)?;
        let dir = options.out.clone().unwrap_or_else(|| default_folder(scene));
        let mut summary = Summary {
            status: "running".into(),
            title: job.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene_hash: hash(&document, &parsed),
            overrides: document.overrides().iter().map(|(k, v)| format!("{k}={v}")).collect(),
            threads: rayon::current_num_threads(),
            ..Summary::default()
        };
        let stage = Stage {
            document: &document,
            job: &job,
            dir: &dir,
            quiet: options.quiet,
            prepared: Cell::new(false),
        };
        let result = stage.run(&mut summary);
        summary.peak_memory = peak_memory();
        match &result {
            Ok(()) => summary.status = "done".into(),
            // Bad input leaves nothing behind, not even a summary.
            Err(Failure::Input(_)) => {}
            Err(failure) => summary.status = format!("failed: {failure}"),
        }
        if matches!(result, Err(Failure::Input(_))) {
            return result.map(|()| summary);
        }
        // A failure before the first file, such as one while settling, has no folder yet, or one with the results of
        // an earlier run. What stopped the run comes before what stopped its summary.
        let cleared = if stage.prepared.get() { Ok(()) } else { stage.prepare() };
        let written = cleared.and_then(|()| summary.write(&dir)).and_then(|()| summary.write_log(&dir));
        result.and(written).map(|()| summary)
    })
}

/// The pool that a run works in: as many threads as asked for, with stacks deep enough for recursive elimination.
fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
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
fn default_folder(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = scene.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    let name = match (stem.as_str(), folder) {
        ("scene", Some(folder)) => folder,
        _ => stem,
    };
    Path::new("results").join(name)
}

/// Hash of the scene, its overrides and the files it names.
fn hash(document: &Document, scene: &Scene) -> String {
    let mut hash = Hash::default();
    hash.add(document.text().as_bytes());
    for (key, value) in document.overrides() {
        hash.add(key.as_bytes());
        hash.add(value.as_bytes());
    }
    let mut files: Vec<&Path> = Vec::new();
    if let Some(s) = &scene.solid {
        files.extend([s.nodes.as_path(), s.elements.as_path()]);
        files.extend(s.constraints.as_deref());
    }
    for g in &scene.grains {
        files.extend(g.library.as_deref());
        files.extend(g.packing.as_deref());
        files.extend(g.gradation.as_ref().map(|g| g.file.as_path()));
    }
    for file in files {
        // Every one of them was read before; one that has gone since changes the hash, which is what it is for.
        hash.add(&std::fs::read(document.resolve(file)).unwrap_or_default());
    }
    hash.hex()
}

/// One run in progress.
struct Stage<'a> {
    document: &'a Document,
    job: &'a Job,
    dir: &'a Path,
    quiet: bool,
    /// Whether the folder is cleared of earlier results and holds those of this run.
    prepared: Cell<bool>,
}

impl Stage<'_> {
    fn run(&self, summary: &mut Summary) -> Result<(), Failure> {
        if let Some(solid) = &self.job.solid {
            summary.warnings.extend(solid.warnings.iter().cloned());
            let mesh = solid.model.mesh();
            summary.model.nodes = mesh.node_count();
            summary.model.elements = mesh.element_count();
            summary.model.unknowns = solid.model.free_dof_count();
            summary.sources.extend(SOLID_SOURCES);
        }
        if self.job.grains.is_some() {
            summary.sources.extend(GRAIN_SOURCES);
        }
        match (&self.job.solid, &self.job.grains, &self.job.coupling) {
            (Some(solid), None, _) => match &solid.newmark {
                None => statics::run(self.job, solid, self.dir, || self.prepare(), summary),
                Some(method) => {
                    let dt = self.job.solid_step.expect("a dynamic solid has a step");
                    let solver = fem::newmark::NewmarkSolver::conditionally_stable(&solid.model, *method, dt)
                        .map_err(|e| solid.failure(&e))?;
                    let mut system = SolidSystem::new(solid, solver).map_err(|e| solid.failure(&e))?;
                    summary.model.solid_step = Some(dt);
                    self.prepare()?;
                    self.main_stage(&mut system, None, summary)?;
                    if self.job.output.tables {
                        let load = system.load();
                        let reactions = fem::energy::reactions(&solid.model, &system.state, load);
                        statics::write_tables(&solid.model, &system.state.u, &reactions, self.dir)?;
                    }
                    Ok(())
                }
            },
            (None, Some(grains), _) => {
                let deposited = self.deposit(grains, None, summary)?;
                let bodies = self.with_sleeper(grains, deposited, None)?;
                let model = self.grain_model(grains.input(bodies), summary)?;
                let mut system = GrainsSystem::new(model)?;
                self.prepare()?;
                self.grain_stage(&mut system, grains, summary)
            }
            (Some(solid), Some(grains), Some(plan)) => {
                let surface = SolidSurface::new(solid.model.mesh(), plan.faces.clone());
                let deposited = self.deposit(grains, Some(&surface), summary)?;
                let bodies = self.with_sleeper(grains, deposited, Some(&surface))?;
                let model = self.grain_model(grains.input(bodies), summary)?;
                let mut system = self.couple(solid, model, plan, surface, summary)?;
                let stability = grains.stability(
                    &system.model.grains,
                    system.model.window(),
                    system.model.solid,
                    &plan.faces,
                );
                if stability.stiffness.max(stability.damping) > 1.0 {
                    summary.warnings.push(format!(
                        "the exchange may be unstable: W = {:.2}, D = {:.2}, both should be below 1; use fewer \
                         coupling.substeps or softer contacts",
                        stability.stiffness, stability.damping
                    ));
                }
                self.prepare()?;
                self.grain_stage(&mut system, grains, summary)?;
                summary.coupling = Some(CouplingRecord {
                    transfer: system.state.audit,
                    substeps: plan.substeps,
                    stability,
                    interface_work_error: system.spent().interface(),
                    transfer_kind: "point, through the shape functions of the touched face",
                });
                Ok(())
            }
            _ => unreachable!("a job has a solid or grains, and both only with a coupling"),
        }
    }

    fn prepare(&self) -> Result<(), Failure> {
        record::prepare(self.dir, &self.job.output)?;
        self.prepared.set(true);
        Ok(())
    }

    fn grain_model(&self, input: dem::ModelInput, summary: &mut Summary) -> Result<dem::Model, Failure> {
        let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
        summary.model.bodies = model.body_count();
        summary.model.spheres = model.sphere_count();
        summary.model.grain_step = Some(model.dt());
        summary.model.grain_step_limit = Some(model.dt_limit().dt);
        summary.model.grain_step_set_by = Some(model.dt_limit().to_string());
        Ok(model)
    }

    /// Lets filled grains settle and levels the bed; the bodies come back at rest where they lie.
    fn deposit(
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
            parts: Default::default(),
        });
        if bodies.is_empty() {
            return Err(self.document.error("deposition.level", "no grain below it", "at least one").into());
        }
        Ok(bodies)
    }

    /// Adds the sleeper, just above the highest grain below it.
    fn with_sleeper(
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

    /// Joins grains and solid. The solid starts in static equilibrium with its weight and the grains that rest on
    /// it; the mesh file describes that loaded shape, as a survey would.
    fn couple<'b>(
        &self,
        solid: &'b crate::model::solid::SolidPart,
        grains: dem::Model,
        plan: &CouplingPart,
        mut surface: SolidSurface,
        summary: &mut Summary,
    ) -> Result<CoupledSystem<'b>, Failure> {
        let progress = Progress::start("equilibrium", 1.0, self.quiet);
        let dead_load = solid.model.gravity_load();
        let mut load = dead_load.clone();
        solid.add_loads(0.0, &mut load);
        let (contacts, resting) = coupling::step::resting_load(&grains, &mut surface, solid.model.mesh())
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))?;
        for (l, c) in load.iter_mut().zip(&contacts) {
            *l += c;
        }
        let rest = fem::statics::solve(&solid.model, &load).map_err(|e| solid.failure(&e))?;
        let mut state = fem::state::State::new(&solid.model);
        state.u.copy_from_slice(&rest.u);
        let model = coupling::step::Model {
            solid: &solid.model,
            dead_load,
            reference: rest.u,
            substeps: plan.substeps,
            theta: plan.theta,
            grains,
        };
        let state = coupling::step::State::new(state, resting);
        let work = coupling::step::Work::new(&model, &state, surface).map_err(|e| solid.failure(&e))?;
        summary.model.solid_step = Some(model.window());
        progress.finish("solid in equilibrium with its weight and the bed, window matrix factored");
        Ok(CoupledSystem { model, state, work, loads: &solid.loads })
    }

    /// The run proper of a scene with grains, with its accounts.
    fn grain_stage<S: System>(
        &self,
        system: &mut S,
        grains: &GrainsPart,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        let momentum = |s: &S| {
            let g = s.grains().expect("a system with grains");
            dem::measure::momentum(g.model, g.state)
        };
        let view = system.grains().expect("a system with grains");
        summary.model.coordination = Some(dem::measure::coordination(view.model, view.state));
        let before = momentum(system);
        self.main_stage(system, Some(grains), summary)?;
        let after = momentum(system);
        let ledger = &system.grains().expect("a system with grains").state.ledger;
        let impulse = ledger.impulse();
        let (mut linear, mut angular) = (0.0, 0.0);
        for part in [&ledger.gravity, &ledger.walls, &ledger.surface, &ledger.applied, &ledger.constraints] {
            linear += part.linear.norm();
            angular += part.angular.norm();
        }
        let relative = |error: f64, scale: f64| if scale > 0.0 { error / scale } else { error };
        summary.momentum = Some(MomentumRecord {
            linear: relative((after.linear - before.linear - impulse.linear).norm(), linear),
            angular: relative((after.angular - before.angular - impulse.angular).norm(), angular),
        });
        Ok(())
    }

    /// Advances a system to the end of the run, recording.
    fn main_stage<S: System>(
        &self,
        system: &mut S,
        grains: Option<&GrainsPart>,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        let job = self.job;
        let window = system.window();
        let windows = ((job.end / window).ceil() as u64).max(1);
        let frames = u64::from(job.output.frames).min(windows);
        let interval = job.output.history_interval.map_or(job.end / 1000.0, |i| i.si);
        let every = ((interval / window).round() as u64).max(1);

        let load = grains.and_then(|g| g.load.as_ref());
        let sleeper = grains.and_then(|g| g.sleeper.as_ref());
        let body = system.grains().map_or(0, |g| g.model.body_count()).saturating_sub(1);
        let apply = |t: f64, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>| {
            if let (Some(load), Some(plan)) = (load, sleeper) {
                let share = load.force(t) / plan.seats.len() as f64;
                let (x, q) = (state.position(body), state.orientation(model, body));
                for seat in &plan.seats {
                    let point = x + q * dem::Vec3::from(*seat);
                    out.push(dem::AppliedForce { body, force: dem::Vec3::new(0.0, 0.0, -share), point });
                }
            }
        };
        let at = |t: f64| sleeper.map(|_| Sleeper { body, load: load.map_or(0.0, |l| l.force(t)) });

        let mut recorder = Recorder::start(job, self.dir, system, at(0.0))?;
        recorder.row(0.0, system, at(0.0))?;
        recorder.frame(0.0, system)?;
        let progress = Progress::start("running", windows as f64, self.quiet);
        let mut next_frame = 1;
        let mut done = 0;
        let outcome = (1..=windows).try_for_each(|k| -> Result<(), Failure> {
            let time = k as f64 * window;
            system.advance(&apply)?;
            if let Some(cycle) = recorder.follow(time, system, at(time))? {
                progress.message(format!(
                    "cycle {}: settlement {:.3} mm",
                    cycle.number,
                    1e3 * cycle.settlement
                ));
            }
            if k % every == 0 || k == windows {
                recorder.row(time, system, at(time)).map_err(|e| e.at(time))?;
            }
            if frames > 0 && k * frames >= next_frame * windows {
                recorder.frame(time, system).map_err(|e| e.at(time))?;
                next_frame += 1;
            }
            progress.at(k as f64);
            done = k;
            Ok(())
        });
        let (grain_steps, solid_steps) = system.steps_per_window();
        let seconds = progress.finish(&format!("{:.3} s simulated", done as f64 * window));
        summary.stages.push(StageRecord {
            name: "run".into(),
            seconds,
            grain_steps: done * grain_steps,
            solid_steps: done * solid_steps,
            parts: Default::default(),
        });
        summary.settlement = settlement(recorder.cycles());
        let balance = recorder.balance();
        let work = balance.spent.work();
        let turnover = work.abs().max(balance.spent.dissipated());
        summary.energy = Some(EnergyRecord {
            start: balance.start,
            end: balance.now,
            spent: balance.spent,
            error: balance.error(),
            work,
            relative_error: (turnover > 0.0).then(|| balance.error().abs() / turnover),
            largest_error: recorder.largest_error,
        });
        recorder.plot_settlement()?;
        outcome
    }
}

/// Time that bodies need to get going before slowness counts as rest [s].
const START_OF_SETTLING: f64 = 0.05;

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

fn settlement(cycles: &[Cycle]) -> Option<SettlementRecord> {
    if cycles.is_empty() {
        return None;
    }
    let per_cycle: Vec<f64> = cycles.iter().map(|c| c.settlement).collect();
    let increments: Vec<f64> =
        per_cycle.iter().enumerate().map(|(i, s)| if i == 0 { *s } else { s - per_cycle[i - 1] }).collect();
    let half = increments.len() / 2;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let slowing =
        (half > 0).then(|| mean(&increments[increments.len() - half..]) / mean(&increments[..half]));
    Some(SettlementRecord { per_cycle, increments, slowing })
}

const SOLID_SOURCES: [&str; 3] = [
    "20-node hexahedron: serendipity functions, Zienkiewicz & Taylor, The Finite Element Method",
    "time integration: Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
    "sparse Cholesky: supernodal LLT of the crate faer, nested dissection by coordinates (George 1973)",
];

const GRAIN_SOURCES: [&str; 3] = [
    "contact: linear spring-dashpot with Coulomb friction, Cundall & Strack, Geotechnique 29(1), 1979",
    "restitution of the clipped dashpot: Schwager & Poschel, Granular Matter 9, 2007",
    "integration: leapfrog (velocity Verlet), Verlet, Phys. Rev. 159, 1967",
];
