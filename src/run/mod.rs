//! The run: fill, settle, place the sleeper, load, write.

mod cycles;
mod failure_factor;
mod frames;
mod initial;
mod main_stage;
mod memory;
mod plastic;
mod record;
mod settle;
mod solid_alone;
mod statics;
mod summary;
mod system;
mod wall_output;

pub use cycles::{Cycle, CycleRecorder};
pub use memory::{Prediction, parse_size, size};
pub use summary::{Summary, peak_memory};

use crate::failure::Failure;
use crate::model::grains::refused;
use crate::model::solid::{Analysis, SolidPart, TimeMethod};
use crate::model::{CouplingPart, Job};
use crate::progress::Progress;
use crate::scene::{Document, Scene};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use summary::{CouplingRecord, Hash, NewtonRecord};
use system::{CoupledSystem, GrainsSystem, System};
use trackbed_coupling as coupling;
use trackbed_coupling::surface::SolidSurface;
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
            memory: options.memory,
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
    }
    files.extend(scene.walls.iter().filter_map(|w| w.file.as_deref()));
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
    memory: Option<u64>,
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
            let prediction = Prediction::of(solid)?;
            prediction.check(self.memory)?;
            summary.model.predicted_memory = Some(prediction.total());
            summary.sources.extend(solid_sources(solid, self.job.grains.is_some()));
        }
        if self.job.grains.is_some() {
            summary.sources.extend(GRAIN_SOURCES);
        }
        match (&self.job.solid, &self.job.grains, &self.job.coupling) {
            (Some(solid), None, _) => self.solid_alone(solid, summary),
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
                if self.job.output.tables {
                    let moved = &system.state.solid;
                    let reactions = fem::energy::reactions(&solid.model, moved, system.work.load());
                    statics::write_tables(&solid.model, moved, &reactions, self.dir)?;
                }
                summary.newton = system.work.newton().map(|s| NewtonRecord::of(&s));
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
        let state = if solid.is_linear() {
            let rest = fem::statics::solve(&solid.model, &load).map_err(|e| solid.failure(&e))?;
            let mut state = fem::state::State::new(&solid.model);
            state.u.copy_from_slice(&rest.u);
            state
        } else {
            initial::under_load(solid, &dead_load, &load)?
        };
        let model = coupling::step::Model {
            solid: &solid.model,
            dead_load,
            reference: state.u.clone(),
            substeps: plan.substeps,
            theta: plan.theta,
            newton: solid.newton,
            grains,
        };
        let state = coupling::step::State::new(state, resting);
        let work = coupling::step::Work::new(&model, &state, surface).map_err(|e| solid.failure(&e))?;
        summary.model.solid_step = Some(model.window());
        progress.finish("solid in equilibrium with its weight and the bed, window matrix factored");
        Ok(CoupledSystem { model, state, work, loads: &solid.loads })
    }
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
        sources.push(
            "plasticity: return maps in principal stresses, de Souza Neto, Peric & Owen 2008; Clausen, Damkilde & Andersen \
             2006",
        );
    }
    if !part.model.matrices().dashpots().is_empty() {
        sources.push("absorbing boundaries: Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95, 1969");
    }
    sources
}

const GRAIN_SOURCES: [&str; 3] = [
    "contact: linear spring-dashpot with Coulomb friction, Cundall & Strack, Geotechnique 29(1), 1979",
    "restitution of the clipped dashpot: Schwager & Poschel, Granular Matter 9, 2007",
    "integration: leapfrog (velocity Verlet), Verlet, Phys. Rev. 159, 1967",
];
