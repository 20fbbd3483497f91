//! `trackbed mesh`: measures, checks and converts meshes.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::output::{print, refuse_existing};
use crate::cli::{MeshArgs, MeshFormat};
use trackbed_input::model::solid::mesh_file;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::mesh_tools::{self, Problem};
use trackbed_io::read::{MESH_ENDINGS, MeshFile, folder_files, mesh_files, read_mesh_file};
use trackbed_io::write::{MeshOptions, write_mesh_file};

pub(super) fn info(args: &MeshArgs) -> Result<(), Failure> {
    let file = read(args)?;
    let mut text = mesh_tools::info(&file.mesh, &file.constraints).to_string();
    let mut line = |t: String| writeln!(text, "{t}").expect("writing to a string does not fail");
    for (name, count) in &file.element_types {
        line(format!("in the file       {count:>10}   {name}"));
    }
    for (number, m) in &file.materials {
        let density = m.density.map_or(String::new(), |d| format!(", density {d}"));
        line(format!("constants of material {number}: E {}, nu {}{density}", m.young, m.poisson));
    }
    for (what, sets) in [("nodes", &file.node_sets), ("elements", &file.element_sets)] {
        for (name, members) in sets {
            line(format!("set               {:>10}   {what} in {name}", members.len()));
        }
    }
    for (name, members) in &file.face_sets {
        line(format!("set               {:>10}   faces in {name}", members.len()));
    }
    print(&format!("{text}\n{}", remarks(&file.warnings)))
}

pub(super) fn check(args: &MeshArgs) -> Result<(), Failure> {
    let file = read(args)?;
    let mut problems = mesh_tools::check(&file.mesh, &file.constraints);
    let mut notes = file.warnings.clone();
    // Supports can be in the scene.
    if file.constraints.is_empty() && !is_scene(&args.input) {
        problems.retain(|problem| !matches!(problem, Problem::Unconstrained { .. }));
        let subject = if file.no_constraints { "this format" } else { "the mesh" };
        notes.push(format!("{subject} contains no constraints; add [[solid.support]] to the scene"));
    }
    if problems.is_empty() {
        return print(&format!("{}: no defects found\n{}", args.input.display(), remarks(&notes)));
    }
    let text = mesh_tools::sentences(&file.mesh, &problems).join("; ");
    Err(Failure::Input(format!("{}: found {text}, expected a mesh without defects", args.input.display())))
}

pub(super) fn convert(
    args: &MeshArgs,
    output: &Path,
    format: Option<MeshFormat>,
    force: bool,
) -> Result<(), Failure> {
    let ending = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    if !ending.is_empty() && !MESH_ENDINGS.contains(&ending.as_str()) {
        let found = output.display();
        return Err(Failure::Input(format!(
            "output: found {found}, expected a file .cdb, .msh, .inp, .vtu or .vtk, or a directory for the lists"
        )));
    }
    if format.is_some() && ending != "msh" {
        let found = output.display();
        return Err(Failure::Input(format!("--format: found {found}, expected an output file .msh")));
    }
    refuse_input(&args.input, output)?;
    for file in written(output) {
        refuse_existing(&file, force)?;
    }
    let file = read(args)?;
    let options = MeshOptions { msh2: format == Some(MeshFormat::Msh2) };
    let lost = write_mesh_file(output, &file, options)?;
    print(&format!("{} written\n{}{}", output.display(), remarks(&file.warnings), remarks(&lost)))
}

fn written(output: &Path) -> Vec<PathBuf> {
    match output.extension() {
        None => folder_files(output),
        Some(_) => vec![output.to_path_buf()],
    }
}

fn refuse_input(input: &Path, output: &Path) -> Result<(), Failure> {
    let mut read = vec![input.to_path_buf()];
    if is_scene(input) {
        let document = Document::open(input)?;
        let scene = document.scene()?;
        let named = scene.solid.iter().flat_map(|s| [&s.mesh, &s.nodes, &s.elements, &s.constraints]);
        read.extend(named.flatten().map(|file| document.resolve(file)));
    }
    let read = read.iter().flat_map(|file| mesh_files(file));
    let read: Vec<PathBuf> = read.filter_map(|file| file.canonicalize().ok()).collect();
    let written = written(output);
    let both = written.iter().find(|file| file.canonicalize().is_ok_and(|file| read.contains(&file)));
    match both {
        None => Ok(()),
        Some(file) => {
            let found = format!("{}, the input file", file.display());
            Err(Failure::Input(format!("output: found {found}, expected another file")))
        }
    }
}

fn is_scene(input: &Path) -> bool {
    input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

fn read(args: &MeshArgs) -> Result<MeshFile, Failure> {
    if !is_scene(&args.input) {
        let mut file = read_mesh_file(&args.input)?;
        let unit = file.unit.take().map(|error| error.to_string());
        file.warnings.extend(unit);
        return Ok(file);
    }
    let document = Document::open(&args.input)?;
    let scene = document.scene()?;
    match &scene.solid {
        Some(solid) => mesh_file(&document, solid),
        None => Err(document.error("solid", "nothing", "a solid with a mesh").into()),
    }
}

fn remarks(warnings: &[String]) -> String {
    warnings.iter().map(|w| format!("warning: {w}\n")).collect()
}
