//! Run of a scene.

mod bed;
mod bibtex;
mod bond_output;
mod checkpoint;
mod checkpoint_store;
mod companion;
mod context;
mod device;
mod energy_watch;
pub mod estimate;
mod events;
mod flow;
mod folder;
mod frames;
mod from;
mod hash;
mod hazard;
mod initial;
mod lock;
mod memory;
#[cfg(feature = "mpi")]
pub mod mpi;
mod occupied;
mod origin;
mod packing;
mod ranks;
mod record;
mod recorder;
mod run_file;
mod runout;
mod sources;
mod specimen;
pub mod stages;
mod structures;
mod summary;
mod system;
mod threads;
mod track_output;
mod validity;
mod wall_output;

pub use checkpoint::check_file as check_checkpoint;
pub use checkpoint_store::Interrupt;
pub use companion::{Accompanied, Companion, Shown};
pub use device::Place;
pub use from::{hash_after, state_hash};
pub use hash::Hash;
pub use lock::Lock;
pub use memory::{Prediction, methods, parse_size, size};
pub use origin::{default_folder, named_files, quoted, scene_hash};
pub use ranks::{Ranked, follow};
pub use run_file::RunFile;
use summary::{LibraryRecord, RunRecord, Verdict};
pub use summary::{Summary, peak_memory};

pub use threads::thread_pool;

pub use trackbed_io::progress::Verbosity;

use checkpoint::{Loaded, Slots};
use checkpoint_store::CheckpointStore;
use context::Run;
use run_file::Source;
use stages::{Carried, RUN, RunState};
use std::cell::{Cell, OnceCell};
use std::path::{Path, PathBuf};
use trackbed_input::model::{self, Job};
use trackbed_input::plausible;
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;
use trackbed_io::guard::guarded;
use trackbed_io::message;

/// Run options.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Scene text in place of the file's.
    pub text: Option<String>,
    /// Results directory; default `results/<name>`.
    pub out: Option<PathBuf>,
    /// Threads; default all cores.
    pub threads: Option<usize>,
    /// Overrides `key.path=value`.
    pub set: Vec<String>,
    /// Memory limit of the solid [bytes]; default free.
    pub memory: Option<u64>,
    /// Device of the DEM steps.
    pub device: Place,
    /// Ranks that share the DEM steps.
    pub ranks: Ranked,
    /// Resume from the last checkpoint.
    pub resume: bool,
    /// Finished run whose final state is the start.
    pub from: Option<PathBuf>,
    /// Import only the grains of that run.
    pub bed: bool,
    /// Overwrite checkpoint, results and unrelated files.
    pub force: bool,
    /// Reject implausible values.
    pub strict: bool,
    /// Stop request.
    pub interrupt: Interrupt,
    /// Observer.
    pub accompanied: Accompanied,
    /// Verbosity.
    pub verbosity: Verbosity,
}

/// Outcome of a run.
#[derive(Debug)]
pub enum Outcome {
    /// Completed.
    Done(Box<Summary>),
    /// Resumed, but already completed; results directory.
    WasDone(PathBuf),
}

/// Runs a scene and writes its results.
///
/// # Errors
/// Input errors, before any output; numerical failures, interrupts.
pub fn run(scene: &Path, options: &Options) -> Result<Outcome, Failure> {
    let mut document = Document::open_or(scene, options.text.as_deref())?;
    document.set_all(&options.set)?;
    let parsed = model::read_scene(&document)?;
    let pool = thread_pool(options.threads)?;
    let dir = options.out.clone().unwrap_or_else(|| default_folder(scene, &options.set));
    let mut origin = origin::origin(&document, &parsed);
    let mut previous = None;
    if let Some(from) = &options.from {
        if std::fs::canonicalize(from)
            .is_ok_and(|from| std::fs::canonicalize(&dir).is_ok_and(|dir| dir == from))
        {
            let found = format!("--from: found {}, the results directory of this run", from.display());
            return Err(Failure::Input(format!("{found}, expected another directory than --out")));
        }
        let before = from::open(from, &document, &origin, options.bed)?;
        origin.scene_hash = from::hash_after(&origin.scene_hash, &before.hash);
        previous = Some(before);
    }
    let source = options.from.as_deref().map(|dir| Source { dir, bed: options.bed });
    let (scene_hash, overrides) = (origin.scene_hash.clone(), origin.overrides.clone());
    let mut slots = Slots::new(&dir, origin.clone());
    let mut loaded = None;
    // Output before the first checkpoint is no loss.
    let own = options.resume && RunFile::of(&document, source).is_of(&dir);
    if options.resume {
        if origin::was_done(&dir, &scene_hash)? {
            return Ok(Outcome::WasDone(dir));
        }
        loaded = resumed(&mut slots, &dir, &document, own)?;
    }
    pool.install(|| {
        let job = model::resolve(&document, &parsed)?;
        if let Some(source) = source {
            from::check(&job, &document, source, previous.as_ref().and_then(|p| p.added))?;
        }
        device::check(options.device, &job)?;
        ranks::check(&options.ranks, options.device, &job)?;
        let findings = weigh(&document, &parsed, &job, options)?;
        let mut lock = Lock::take(&dir)?;
        if loaded.is_none() && !options.force && !own {
            occupied::check(&dir, &origin, &slots, &lock)?;
        }
        lock.name(scene);
        let record = RunRecord {
            status: "running".into(),
            title: job.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene_hash,
            overrides,
            threads: rayon::current_num_threads(),
            ..RunRecord::default()
        };
        let summary = Summary { run: record, dir: dir.clone(), ..Summary::default() };
        let command = match options.text {
            Some(_) => origin::resume_call(&dir),
            None => origin::resume_command(scene, &dir, &options.set, source),
        };
        let (interrupt, interval) = (options.interrupt.clone(), job.output.checkpoint);
        let set_down = OnceCell::new();
        let run = Run {
            document: &document,
            job: &job,
            dir: &dir,
            verbosity: options.verbosity,
            memory: options.memory,
            device: options.device,
            ranks: &options.ranks,
            prepared: Cell::new(false),
            checkpoints: CheckpointStore::new(slots, interrupt, interval, command),
            continued: loaded.as_ref().is_some_and(|l| l.moment.stage == RUN),
            set_down: &set_down,
            from: source,
            findings: Cell::new(findings),
            accompanied: &options.accompanied,
        };
        let state = begun(loaded, previous, options, summary)?;
        carry_out(&run, state, &lock)
    })
}

/// None before the first checkpoint.
///
/// # Errors
/// No run of this scene, or an unsuitable checkpoint.
fn resumed(slots: &mut Slots, dir: &Path, document: &Document, own: bool) -> Result<Option<Loaded>, Failure> {
    if !slots.any() && (own || lock::is_there(dir)) {
        message::note(&format!("{}: no checkpoint yet; the run starts from the beginning", dir.display()));
        return Ok(None);
    }
    let (checkpoint, remarks) = slots.load(document)?;
    remarks.iter().for_each(|remark| message::warn(remark));
    Ok(Some(checkpoint))
}

fn begun<'a>(
    loaded: Option<Loaded>,
    previous: Option<from::Previous>,
    options: &Options,
    summary: Summary,
) -> Result<RunState<'a>, Failure> {
    let mut state = RunState::new(loaded, summary);
    if let Some(mut before) = previous.filter(|_| state.loaded.is_none()) {
        if options.verbosity > Verbosity::Quiet {
            message::note(from::carries(options.bed, before.added.is_some()));
        }
        match options.bed {
            true => state.carried = Some(Carried::read(&mut before.loaded, before.coupled)?),
            false if before.added.is_some() => state.reworked = Some(before),
            false => state.loaded = Some(before.loaded),
        }
    }
    Ok(state)
}

fn weigh(
    document: &Document,
    scene: &Scene,
    job: &Job,
    options: &Options,
) -> Result<Vec<plausible::Finding>, Failure> {
    let findings = plausible::weigh(scene, job);
    if options.strict {
        plausible::refuse(document, &findings)?;
    }
    // Printed before by the resumed run.
    Ok(if options.verbosity == Verbosity::Quiet || options.resume { Vec::new() } else { findings })
}

/// Always writes the summary.
fn carry_out<'a>(run: &Run<'a>, mut state: RunState<'a>, lock: &Lock) -> Result<Outcome, Failure> {
    let result = guarded(|| {
        // Reported before hours of packing.
        let begins = state.loaded.is_none() && state.carried.is_none();
        if let Some(grains) = run.job.grains.as_ref().filter(|g| g.is_packed() && begins) {
            stages::preview(run.document, run.job, grains)?;
            run.remark();
        }
        describe(run, &mut state.summary)?;
        state.begin(run.job)?;
        stages::of(run.job).try_for_each(|stage| stage.run(run, &mut state))
    });
    let summary = &mut state.summary;
    summary.warnings.extend(validity::messages(&summary.validity));
    summary.verdict = Verdict::of(summary);
    let result = result.and_then(|()| summary.verdict.judge());
    if let Err(Failure::Numerical(_)) = &result {
        summary.verdict.fail();
    }
    summary.run.peak_memory = peak_memory();
    summary.run.cpu_seconds = trackbed_io::system::cpu_seconds();
    match &result {
        Ok(()) => summary.run.status = "done".into(),
        // Input errors leave no files.
        Err(failure) if failure.is_input() => {}
        Err(Failure::Interrupted(_)) => summary.run.status = "interrupted".into(),
        Err(failure) => summary.run.status = format!("failed: {failure}"),
    }
    let result = match result {
        Err(failure) if failure.is_input() => return Err(failure),
        other => other,
    };
    // Another directory may be at this path.
    if let Some(place) = lock.moved() {
        return Err(run.gone(place.as_deref()));
    }
    // The directory may be missing, or hold old results.
    let cleared = if run.prepared.get() { Ok(()) } else { run.prepare() };
    let written = cleared.and_then(|()| summary.write(run.dir)).and_then(|()| summary.write_log(run.dir));
    let result = match (result, run.checkpoints.kept()) {
        (Err(Failure::Numerical(text)), Some(kept)) => {
            Err(Failure::Numerical(format!("{}. Last checkpoint: {kept}", text.trim_end_matches('.'))))
        }
        (Err(Failure::Other(text)), Some(kept)) => {
            Err(Failure::Other(format!("{}. Last checkpoint: {kept}", text.trim_end_matches('.'))))
        }
        (result, _) => result,
    };
    result.and(written)?;
    // Until here the last checkpoint is needed.
    run.checkpoints.clear()?;
    Ok(Outcome::Done(Box::new(state.summary)))
}

fn describe(run: &Run<'_>, summary: &mut Summary) -> Result<(), Failure> {
    if let Some(solid) = &run.job.solid {
        summary.warnings.extend(solid.warnings.iter().cloned());
        summary.warnings.extend(stages::solid_remarks::missed(run.job));
        let mesh = solid.model.mesh();
        summary.model.nodes = mesh.node_count();
        summary.model.elements = mesh.element_count();
        summary.model.unknowns = solid.model.free_dof_count();
        let prediction = Prediction::of(solid)?;
        prediction.check(run.memory)?;
        summary.model.predicted_memory = Some(prediction.total());
        summary.sources.extend(sources::solid(solid, run.job.grains.is_some()));
        summary.solid.libraries = LibraryRecord::of(solid);
    }
    if let Some(part) = &run.job.grains {
        let compiled = part.materials.own_law.map(|law| (law, law.compile()));
        if run.verbosity > Verbosity::Quiet {
            part.materials.law_lines.iter().for_each(|line| message::note(line));
            if let Some((law, compiled)) = &compiled {
                message::note(&match compiled {
                    Ok(compiler) => format!("contact law \"{}\" compiled by {compiler}", law.name()),
                    Err(why) => format!("contact law \"{}\" interpreted, slower: {why}", law.name()),
                });
            }
        }
        summary.warnings.extend(part.groups.remarks.iter().cloned());
        summary.sources.extend(part.materials.sources());
        summary.sources.extend(part.body_forces().map(|f| f.source()));
        summary.sources.extend(part.scarred().then_some(trackbed_dem::scarring::SOURCE));
    }
    Ok(())
}
