//! Commands.

mod archive;
pub mod check;
mod convert;
mod demo;
mod element;
pub mod explain;
mod life;
mod manual;
mod mesh;
mod modal;
mod output;
mod render;
mod report;
mod reproduce;
mod schema;
mod stone;
mod study;
mod verify;
mod view;

use crate::cli::{Command, MeshCommand, NewArgs, RunArgs};
use std::path::Path;
use trackbed_io::columns;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_post::preview::Source;
use trackbed_run as run;

use crate::start;
use output::print;

/// Executes a command.
///
/// # Errors
/// See [`Failure`] for exit codes.
pub fn execute(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(args) => run_scene(args),
        Command::Explain { args, threads, trial, json } => {
            let memory = memory(args.memory.as_deref())?;
            note_earlier_names(&args.scene, &args.set);
            let how = explain::How { memory, strict: args.strict, threads, trial };
            let report = explain::explain(&Source::new(&args.scene, &args.set), &how)?;
            print(&if json { report.json() } else { report.text(args.verbose) })
        }
        Command::Check { args, json } => {
            note_earlier_names(&args.scene, &args.set);
            let source = Source::new(&args.scene, &args.set);
            let report = check::check(&source, memory(args.memory.as_deref())?, args.strict)?;
            print(&if json { report.json() } else { report.text(args.verbose) })
        }
        Command::New(args) => new(&args),
        Command::Schema { columns: true, .. } => print(&columns::list()),
        Command::Schema { markdown, .. } => schema::schema(markdown),
        Command::Completions { shell } => manual::completions(shell),
        Command::Manual { folder } => manual::manual(&folder),
        Command::Demo(args) => demo::demo(args, run_scene, view::view),
        Command::Study(args) => study::study(args),
        Command::Element(args) => element::element(args),
        Command::Report(args) => report::report(args),
        Command::Reproduce(args) => reproduce::reproduce(args, run_scene),
        Command::Verify(args) => verify::verify(args),
        Command::Life(args) => life::life(args),
        Command::Modal(args) => {
            note_earlier_names(&args.scene, &args.set);
            print(&modal::modal(&args)?)
        }
        Command::Mesh { command: MeshCommand::Info(args) } => mesh::info(&args),
        Command::Mesh { command: MeshCommand::Check(args) } => mesh::check(&args),
        Command::Mesh { command: MeshCommand::Convert { mesh, output, format, force } } => {
            mesh::convert(&mesh, &output, format, force)
        }
        Command::Convert(args) => convert::convert(&args),
        Command::Stone { command } => stone::stone(&command),
        Command::View(args) => view::view(&args),
        Command::Render(args) => render::render(&args),
    }
}

/// Names that a scene should have; nothing if it cannot be read, which its command reports.
fn note_earlier_names(scene: &Path, set: &[String]) {
    Source::new(scene, set).notes().iter().for_each(|note| message::note(note));
}

fn new(args: &NewArgs) -> Result<(), Failure> {
    let Some(template) = &args.template else { return print(&start::list()) };
    let folder = args.folder.clone().unwrap_or_else(|| template.into());
    let scene = start::make(template, &folder)?;
    let scene = scene.display();
    print(&format!(
        "{scene} written; next:\n  trackbed view {scene}\n  trackbed check {scene}\n  trackbed run {scene}\n"
    ))
}

#[cfg(not(feature = "mpi"))]
fn run_scene(args: RunArgs) -> Result<(), Failure> {
    lead(args, run::Ranked::default())
}

#[cfg(feature = "mpi")]
fn run_scene(args: RunArgs) -> Result<(), Failure> {
    let Some(world) = run::mpi::join()? else { return lead(args, run::Ranked::default()) };
    let (scene, set, out) = (args.scene.clone(), args.set.clone(), args.out.clone());
    // One rank per CPU, each with one thread.
    let args = RunArgs { threads: args.threads.or(Some(1)), ..args };
    let threads = args.threads;
    world.share(
        |link| lead(args, run::Ranked::first(link)),
        |link| run::follow(&scene, &set, threads, link),
        &out.unwrap_or_else(|| run::default_folder(&scene, &set)),
    )
}

fn lead(args: RunArgs, ranks: run::Ranked) -> Result<(), Failure> {
    let memory = memory(args.memory.as_deref())?;
    let verbosity = args.verbosity();
    if verbosity > run::Verbosity::Quiet && !args.resume {
        note_earlier_names(&args.scene, &args.set);
    }
    let options = run::Options {
        text: None,
        out: args.out,
        threads: args.threads,
        device: args.device,
        ranks,
        set: args.set,
        memory,
        resume: args.resume,
        from: args.from,
        bed: args.bed,
        force: args.force,
        strict: args.strict,
        interrupt: run::Interrupt::on_signals("the current step")?,
        accompanied: run::Accompanied::default(),
        verbosity,
    };
    match run::run(&args.scene, &options)? {
        run::Outcome::Done(_) if args.quiet => Ok(()),
        run::Outcome::Done(summary) => {
            // Results are saved, so output may fail.
            let text = format!("{}results are in {}\n", summary.report(args.verbose), summary.dir.display());
            if let Err(failure) = print(&text) {
                message::warn(&format!("standard output: {failure}"));
            }
            Ok(())
        }
        run::Outcome::WasDone(dir) => {
            print(&format!("{}: run completed, nothing to resume\n", dir.display()))
        }
    }
}

fn memory(text: Option<&str>) -> Result<Option<u64>, Failure> {
    let parse = |t: &str| {
        let expected = "a size above 0 such as 800MB or 8GB";
        run::parse_size(t).ok_or_else(|| Failure::Input(format!("--memory: found {t}, expected {expected}")))
    };
    text.map(parse).transpose()
}
