//! Studies: variations of a scene, compared in error and cost, or in their response to parameters.
//!
//! A `file` is resolved to a `plan`, run as separate processes (`schedule`) in a directory (`store`).

mod analysis;
mod axis;
mod curve;
mod design;
mod emulator;
mod extreme;
mod factor;
mod figure;
mod file;
mod hazard;
mod label;
mod layout;
mod maps;
mod outcome;
mod page;
mod parameter;
mod plan;
mod plot;
mod point;
mod posterior;
mod process;
mod quantity;
mod sample;
mod schedule;
mod score;
mod statistics;
mod store;
mod summary;
mod table;
mod target;
mod text;
mod trade;

pub use file::{Norm, QuantityTable};
pub use label::file_names;
pub use layout::{Cell, Table, aligned, four_digits, markdown};
pub use page::{is_study, write as report};
pub use plan::seed_keys;
pub use process::{command, verdict};
pub use quantity::{Quantity, resolve_one as quantity};
pub use sample::number;
pub use score::scored;
pub use trade::Request;

use analysis::Analysis;
use file::StudyFile;
use outcome::Outcome;
use plan::{Plan, Run};
use schedule::{Schedule, Task};
use std::path::{Path, PathBuf};
use store::{Found, Store};
use trackbed_input::model::read_scene;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_run::{self as run, Interrupt, Lock};
use trade::Trade;

const PRINTED: usize = 20;
const SPELLED_OUT: usize = 3;
const MOST_JOBS: usize = 1024;

/// Study options.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Results directory; default `results/<name of the study file>`.
    pub out: Option<PathBuf>,
    /// Threads per run.
    pub threads: Option<usize>,
    /// Concurrent runs.
    pub jobs: Option<usize>,
    /// Only runs k, k + n, …, from 1, without tables: k and n.
    pub part: Option<(usize, usize)>,
    /// Write tables from existing runs.
    pub merge: bool,
    /// Skip completed runs, resume interrupted ones.
    pub resume: bool,
    /// Overwrite existing results.
    pub force: bool,
    /// Print nothing.
    pub quiet: bool,
    /// Stop request.
    pub interrupt: Interrupt,
}

/// Result of a study.
#[derive(Debug)]
pub struct Finished {
    /// Tables for the terminal.
    pub text: String,
    /// Failed runs that the exit code reports.
    pub failure: Option<Failure>,
}

/// Validates a scene with overrides, like `check`.
pub type Check<'a> = &'a dyn Fn(&Path, &[String]) -> Result<(), Failure>;

/// Returns the number of runs.
///
/// # Errors
/// Input errors.
pub fn count_runs(file: &Path) -> Result<usize, Failure> {
    let document = Document::open(file)?;
    Ok(Plan::new(&document, &document.read::<StudyFile>()?)?.runs.len())
}

/// Runs a study and returns its tables.
///
/// # Errors
/// Input errors, interrupts, a failed reference.
pub fn execute(file: &Path, options: &Options, check: Check<'_>) -> Result<Finished, Failure> {
    let document = Document::open(file)?;
    if !document.has("scene") && ["solid", "grains", "material"].iter().any(|key| document.has(key)) {
        let expected = "a study, or the option --trade";
        return Err(Failure::Input(format!("{}: found a scene, expected {expected}", file.display())));
    }
    let dir = options.out.clone().unwrap_or_else(|| run::default_folder(file, &[]));
    let origin = Origin { study: run::quoted(file), written: None };
    perform(&document, &dir, &origin, options, check)
}

/// Runs a study of the accuracy and cost of the settings of a scene, and returns its tables.
///
/// # Errors
/// As [`execute`]; a scene without settings or results to compare.
pub fn trade(request: &Request<'_>, options: &Options, check: Check<'_>) -> Result<Finished, Failure> {
    let trade = Trade::new(request, check)?;
    let dir = options.out.clone().unwrap_or_else(|| {
        // Beside the results of the scene.
        let mut name = run::default_folder(request.scene, request.set).into_os_string();
        name.push("_trade");
        name.into()
    });
    let absolute = std::path::absolute(request.scene).map_err(|e| Failure::Input(e.to_string()))?;
    let file = dir.join(trade::FILE);
    let document = Document::parse(Path::new(trade::FILE), trade.text(request.scene))?;
    let origin = Origin { study: run::quoted(&file), written: Some((file, trade.text(&absolute))) };
    // `Trade::new` has checked each setting.
    let mut finished = perform(&document, &dir, &origin, options, &|_, _| Ok(()))?;
    finished.text += &trade.left_out.iter().map(|note| format!("left out: {note}\n")).collect::<String>();
    Ok(finished)
}

/// Origin of a study.
struct Origin {
    /// Study file in commands.
    study: String,
    /// Study file that the study itself writes.
    written: Option<(PathBuf, String)>,
}

fn perform(
    document: &Document,
    dir: &Path,
    origin: &Origin,
    options: &Options,
    check: Check<'_>,
) -> Result<Finished, Failure> {
    let parsed: StudyFile = document.read()?;
    let plan = Plan::new(document, &parsed)?;
    let store = Store::new(dir);
    if options.merge && !dir.join("runs").is_dir() {
        let expected = "a directory with runs of the study (--out)";
        return Err(Failure::Input(format!(
            "--merge: {}: found no runs, expected {expected}",
            dir.display()
        )));
    }
    let hashes = prepare(document, &plan, options, check)?;
    // Each run has a lock.
    let _lock = match options.part {
        None => Some(Lock::take(dir)?),
        Some(_) => None,
    };
    if !options.merge {
        carry_out(document.file(), origin, &plan, &store, &hashes, options)?;
        if let Some((k, n)) = options.part {
            let text =
                format!("{}: runs {k}, {k} + {n}, … completed; `--merge` writes the tables\n", dir.display());
            return Ok(Finished { text, failure: None });
        }
    }
    let found = plan.runs.iter().zip(&hashes).map(|(run, hash)| store.look(run, hash));
    tables(&plan, &store, &found.collect::<Result<Vec<Found>, Failure>>()?)
}

fn ours(options: &Options, k: usize) -> bool {
    options.part.is_none_or(|(part, parts)| k % parts == part - 1)
}

fn prepare(
    document: &Document,
    plan: &Plan,
    options: &Options,
    check: Check<'_>,
) -> Result<Vec<String>, Failure> {
    let mut refused: Vec<(&str, String)> = Vec::new();
    let mut hashes = Vec::new();
    let mut checked = None;
    let scene = Document::open(&plan.scene)?;
    for (k, run) in plan.runs.iter().enumerate() {
        let hash = scene_hash(&scene, &run.set);
        // One seed per set is enough.
        let needed = ours(options, k) && !options.merge && checked != Some(run.setting);
        let verdict = hash.and_then(|hash| {
            if needed {
                checked = Some(run.setting);
                check(&plan.scene, &run.set)?;
                if plan.hazard.is_some() {
                    records_passage(&scene, &run.set)?;
                }
            }
            Ok(hash)
        });
        match verdict {
            Ok(hash) => hashes.push(hash),
            Err(fault) if fault.is_input() => refused.push((run.label.as_str(), fault.to_string())),
            Err(other) => return Err(other),
        }
    }
    if refused.is_empty() { Ok(hashes) } else { Err(refusal(document, &refused)) }
}

/// Refuses a scene without the cells that maps need.
fn records_passage(scene: &Document, set: &[String]) -> Result<(), Failure> {
    let mut document = scene.clone();
    document.set_all(set)?;
    if read_scene(&document)?.runout.is_some_and(|runout| runout.passage) {
        return Ok(());
    }
    let expected = "`passage = true`, from which [hazard] of the study makes its maps";
    Err(document.error("runout.passage", "nothing", expected).into())
}

/// A common error is stated once.
fn refusal(document: &Document, refused: &[(&str, String)]) -> Failure {
    let (label, text) = &refused[0];
    let file = document.file().display();
    if refused.len() == 1 {
        return plan::of_setting(document, label, text);
    }
    if refused.iter().all(|(_, other)| other == text) {
        return Failure::Input(format!("{file}: \"{label}\" and {} more: {text}", refused.len() - 1));
    }
    let first = refused.iter().take(SPELLED_OUT);
    let mut texts: Vec<String> = first.map(|(label, text)| format!("\"{label}\": {text}")).collect();
    let others: Vec<String> = refused.iter().skip(SPELLED_OUT).map(|r| format!("\"{}\"", r.0)).collect();
    if !others.is_empty() {
        texts.push(format!("and {}", others.join(", ")));
    }
    Failure::Input(format!("{file}: {} runs rejected: {}", refused.len(), texts.join("; ")))
}

fn scene_hash(scene: &Document, set: &[String]) -> Result<String, Failure> {
    let mut document = scene.clone();
    document.set_all(set)?;
    let parsed = read_scene(&document)?;
    Ok(run::scene_hash(&document, &parsed))
}

fn carry_out(
    file: &Path,
    origin: &Origin,
    plan: &Plan,
    store: &Store,
    hashes: &[String],
    options: &Options,
) -> Result<(), Failure> {
    let own =
        || plan.runs.iter().zip(hashes).enumerate().filter(|(k, _)| ours(options, *k)).map(|(_, own)| own);
    if let Some((path, text)) = &origin.written
        && !options.force
        && std::fs::read_to_string(path).is_ok_and(|other| other != *text)
    {
        let expected = "the same --set, --seeds and --tolerance, --force, or another --out";
        return Err(Failure::Input(format!("{}: found another study, expected {expected}", path.display())));
    }
    if !options.resume
        && !options.force
        && let Some((run, _)) = own().find(|(run, _)| store.has(run))
    {
        let found = format!("found the run \"{}\"", run.label);
        let expected = "--resume, --force to start from scratch, or another --out";
        return Err(Failure::Input(format!("{}: {found}, expected {expected}", store.dir().display())));
    }
    let mut tasks = Vec::new();
    let mut kept = 0;
    for (run, hash) in own() {
        let found = if options.force { Found::Nothing } else { store.look(run, hash)? };
        match found {
            Found::Done(..) | Found::Failed(_) => kept += 1,
            found => tasks.push(Task { run, scene_hash: hash, found }),
        }
    }
    let total = kept + tasks.len();
    let (jobs, threads) = shares(plan, options, tasks.len())?;
    if kept > 0 && !options.quiet {
        message::say(&format!("{kept} of {total} runs exist"));
    }
    store.make()?;
    if let Some((path, text)) = &origin.written {
        store::write(path, text)?;
    }
    if !plan.has_reference() {
        store::write(&store.dir().join("samples.csv"), &csv(table::samples(plan))?)?;
    }
    options.interrupt.end_at_once(false);
    let (scene, interrupt, quiet) = (plan.scene.as_path(), &options.interrupt, options.quiet);
    let schedule = Schedule { scene, store, jobs, threads, interrupt, quiet };
    let result = schedule.carry_out(tasks, |run| first_run(file, plan, store, run));
    options.interrupt.end_at_once(true);
    result.map_err(|failure| match failure {
        Failure::Interrupted(_) => {
            let mut part = options.part.map_or(String::new(), |(k, n)| format!(" --task {k}/{n}"));
            for (option, value) in [("jobs", options.jobs), ("threads", options.threads)] {
                part += &value.map_or(String::new(), |n| format!(" --{option} {n}"));
            }
            let (study, dir) = (&origin.study, run::quoted(store.dir()));
            Failure::Interrupted(format!(
                "interrupted; resume with: trackbed study {study} --resume --out {dir}{part}"
            ))
        }
        other => other,
    })
}

/// Rejects missing quantities before other runs start in vain.
fn first_run(file: &Path, plan: &Plan, store: &Store, run: &Run) -> Result<(), Failure> {
    for (k, quantity) in plan.quantities.iter().enumerate() {
        if let Err(fault) = sample::read(quantity, &store.results(run)) {
            let (file, label) = (file.display(), &run.label);
            return Err(Failure::Input(format!(
                "{file}: quantity.{k}: found that {fault} (of the run \"{label}\"), expected what runs of the scene leave; the runs \
                 so far are kept for --resume"
            )));
        }
    }
    Ok(())
}

/// By default their product is the number of cores.
fn shares(plan: &Plan, options: &Options, runs: usize) -> Result<(usize, usize), Failure> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = options.jobs.or(plan.jobs);
    if let Some(jobs) = jobs.filter(|n| !(1..=MOST_JOBS).contains(n)) {
        return Err(Failure::Input(format!("--jobs: found {jobs}, expected 1 to {MOST_JOBS}")));
    }
    if options.threads == Some(0) {
        return Err(Failure::Input("--threads: found 0, expected at least 1".into()));
    }
    let jobs = jobs.unwrap_or_else(|| (cores / options.threads.unwrap_or(1)).max(1)).min(runs.max(1));
    let threads = options.threads.unwrap_or_else(|| (cores / jobs).max(1));
    if jobs * threads > cores && !options.quiet {
        message::note(&format!(
            "{jobs} runs of {threads} threads on {cores} cores: wall times are not meaningful"
        ));
    }
    Ok((jobs, threads))
}

fn csv(text: Result<String, csv::Error>) -> Result<String, Failure> {
    text.map_err(|e| Failure::Other(e.to_string()))
}

fn tables(plan: &Plan, store: &Store, found: &[Found]) -> Result<Finished, Failure> {
    let outcome = Outcome::of(plan, store, found);
    let maps = maps::write(plan, store, &outcome, found)?;
    let analysis = Analysis { hazard: maps, ..Analysis::of(plan, &outcome) };
    write_files(plan, store, &outcome, &analysis)?;
    let table = match plan.has_reference() {
        true => text::printed(plan, &outcome, PRINTED) + &summary::printed_best(&analysis),
        false => summary::printed(&analysis, PRINTED),
    };
    let mut lines = format!("{}\n{table}", plan.title);
    lines += &summary::printed_hazard(&analysis);
    if !outcome.extremes.is_empty() {
        lines += &format!("\n{}", extreme::table(&outcome.extremes).aligned(2));
    }
    for remark in text::remarks(plan, &outcome) {
        lines += &format!("warning: {remark}\n");
    }
    let missing = outcome::missing(plan, found);
    if !missing.is_empty() {
        let labels: Vec<String> = missing.iter().map(|run| format!("\"{}\"", run.label)).collect();
        lines +=
            &format!("{} of {} runs are missing: {}\n", labels.len(), plan.runs.len(), labels.join(", "));
    }
    if plan.has_reference() {
        lines += &format!("{}\n{}\n", text::front(&outcome), text::recommendation(plan, &outcome));
    }
    lines += &format!("Table: {}\n", store.dir().join("study.md").display());
    let failure = if plan.has_reference() { None } else { failed_runs(plan, store, found) };
    let reference = &outcome.rows[outcome.reference];
    let failed = plan
        .runs
        .iter()
        .zip(found)
        .any(|(run, found)| run.setting == outcome.reference && matches!(found, Found::Failed(_)));
    if plan.has_reference() && failed && reference.done == 0 {
        let (dir, reasons) = (store.dir().display(), reference.reasons.join("; "));
        return Err(Failure::Numerical(format!(
            "reference run failed, no errors in the table of {dir}: {reasons}"
        )));
    }
    Ok(Finished { text: lines, failure })
}

fn write_files(plan: &Plan, store: &Store, outcome: &Outcome, analysis: &Analysis) -> Result<(), Failure> {
    let dir = store.dir();
    store::write(&dir.join("study.csv"), &csv(table::cases(plan, outcome, analysis))?)?;
    store::write(&dir.join("study.json"), &table::json(plan, outcome, analysis))?;
    let page = match plan.has_reference() {
        true => text::markdown(plan, outcome) + &summary::sections(analysis),
        false => summary::markdown(&plan.title, &plan.scene.display().to_string(), analysis),
    } + &extreme::section(&outcome.extremes);
    store::write(&dir.join("study.md"), &page)?;
    if plan.has_reference() {
        plot::pareto(plan, outcome).write(&dir.join("pareto.svg"))?;
    }
    if !analysis.targets.is_empty() {
        store::write(&dir.join("targets.csv"), &csv(table::targets(analysis))?)?;
    }
    if analysis.factors.is_empty() {
        return Ok(());
    }
    store::write(&dir.join("sensitivity.csv"), &csv(table::sensitivities(analysis))?)?;
    let plots: Vec<_> = figure::all(analysis).into_iter().map(|f| (f.title, f.file)).collect();
    store.write_plots(&plots)
}

/// Runs that ended with an error, for the exit code.
fn failed_runs(plan: &Plan, store: &Store, found: &[Found]) -> Option<Failure> {
    let failed = |found: &Found| match found {
        Found::Failed(_) => true,
        Found::Unfinished(record, _) => record.exit_code.is_some_and(|code| code != 130),
        _ => false,
    };
    let runs = plan.runs.iter().zip(found).filter(|(_, found)| failed(found));
    let reasons: Vec<String> =
        runs.map(|(run, found)| format!("\"{}\": {}", run.label, outcome::why(found))).collect();
    if reasons.is_empty() {
        return None;
    }
    let first = reasons.iter().take(SPELLED_OUT).cloned().collect::<Vec<_>>().join("; ");
    let more = if reasons.len() > SPELLED_OUT { "; …" } else { "" };
    let (count, all) = (reasons.len(), plan.runs.len());
    let dir = store.dir().display();
    Some(Failure::Numerical(format!(
        "{count} of {all} runs failed, not in the tables of {dir}: {first}{more}"
    )))
}
