//! What each command does.

mod check;
mod modal;

use crate::cli::{Command, MeshArgs, MeshCommand, RunArgs};
use crate::failure::Failure;
use crate::model::solid::read_mesh;
use crate::read::{ListLayout, Lists, read_lists};
use crate::scene::{Document, Scene};
use crate::{mesh_tools, run};
use std::io::Write;

/// Carries out a command.
///
/// # Errors
/// As the command says; see [`Failure`] for exit codes.
pub fn execute(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(args) => run_scene(args),
        Command::Check(args) => print(&check::check(&args.scene, &args.set, memory(args.memory.as_deref())?)?),
        Command::Modal(args) => print(&modal::modal(&args)?),
        Command::Mesh { command: MeshCommand::Info(args) } => {
            let lists = lists(&args)?;
            let info = mesh_tools::info(&lists.mesh, &lists.constraints);
            print(&format!("{info}\n{}", remarks(&lists)))
        }
        Command::Mesh { command: MeshCommand::Check(args) } => {
            let lists = lists(&args)?;
            let problems = mesh_tools::check(&lists.mesh, &lists.constraints);
            if problems.is_empty() {
                return print(&format!("{}: no fault found\n{}", args.input.display(), remarks(&lists)));
            }
            let text = problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
            Err(Failure::Input(format!(
                "{}: found {text}, expected a mesh without faults",
                args.input.display()
            )))
        }
        Command::Mesh { command: MeshCommand::Convert { mesh, output } } => {
            if output.extension().is_none_or(|e| e != "vtu") {
                let found = output.display();
                return Err(Failure::Input(format!("output: found {found}, expected a file ending in .vtu")));
            }
            let lists = lists(&mesh)?;
            mesh_tools::convert(&lists.mesh, &lists.constraints, &output)?;
            print(&format!("{} written\n{}", output.display(), remarks(&lists)))
        }
    }
}

fn run_scene(args: RunArgs) -> Result<(), Failure> {
    let memory = memory(args.memory.as_deref())?;
    let options =
        run::Options { out: args.out, threads: args.threads, set: args.set, memory, quiet: args.quiet };
    let summary = run::run(&args.scene, &options)?;
    if args.quiet { Ok(()) } else { print(&summary.report()) }
}

/// The size that `--memory` names [bytes].
fn memory(text: Option<&str>) -> Result<Option<u64>, Failure> {
    let parse = |t: &str| {
        let expected = "a size above 0 such as 800MB or 8GB";
        run::parse_size(t).ok_or_else(|| Failure::Input(format!("--memory: found {t}, expected {expected}")))
    };
    text.map(parse).transpose()
}

/// Reads a mesh from a folder of lists, or the one that a scene names.
fn lists(args: &MeshArgs) -> Result<Lists, Failure> {
    if args.input.is_dir() {
        let constraints = args.input.join("DOF.DAT");
        let constraints = constraints.exists().then_some(constraints);
        return read_lists(
            &args.input.join("NODECOORD.DAT"),
            &args.input.join("ELEMENTNUM.DAT"),
            constraints.as_deref(),
            &ListLayout::default(),
        )
        .map_err(Failure::from);
    }
    let document = Document::open(&args.input)?;
    let scene: Scene = document.read()?;
    match &scene.solid {
        Some(solid) => read_mesh(&document, solid),
        None => Err(document.error("solid", "nothing", "a solid with a mesh").into()),
    }
}

fn remarks(lists: &Lists) -> String {
    lists.warnings.iter().map(|w| format!("note: {w}\n")).collect()
}

/// Prints to standard output; a reader that has gone away is no failure.
fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}
