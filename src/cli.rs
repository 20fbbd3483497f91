//! The command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Coupled DEM–FEM solver for ballasted railway track.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene: fill, settle, load, and write the results.
    Run(RunArgs),
    /// Validate a scene without running it, and say what a run would do and need.
    #[command(alias = "explain")]
    Check(CheckArgs),
    /// Natural frequencies and modes of the solid part of a scene.
    Modal(ModalArgs),
    /// Read a mesh: count and measure it, find its faults, or convert it.
    Mesh {
        /// What to do with the mesh.
        #[command(subcommand)]
        command: MeshCommand,
    },
}

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Folder of the results; default `results/<name of the scene's folder or file>`.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; default all cores. The results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Replace one key of the scene, as key.path=value; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Refuse a solid that needs more memory than this, such as 8GB; default: what the machine has free.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Go on from the last checkpoint in the folder of the results. Scene and overrides must be the same, threads need not.
    #[arg(long)]
    pub resume: bool,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `modal`.
#[derive(Debug, Args)]
pub struct ModalArgs {
    /// Scene file (TOML) with a solid.
    pub scene: PathBuf,
    /// Number of modes.
    #[arg(short = 'n', long, default_value_t = 6)]
    pub count: usize,
    /// Folder of the results; default `results/<name>_modes`.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; default all cores. The results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Replace one key of the scene, as key.path=value; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Replace one key of the scene, as key.path=value; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Refuse a solid that needs more memory than this, such as 8GB; default: what the machine has free.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
}

/// The commands of `mesh`.
#[derive(Debug, Subcommand)]
pub enum MeshCommand {
    /// Counts, sizes, materials, volumes and quality.
    Info(MeshArgs),
    /// Faults of the mesh; exit code 2 when there are any.
    Check(MeshArgs),
    /// Write the mesh in another form.
    Convert {
        /// The mesh.
        #[command(flatten)]
        mesh: MeshArgs,
        /// File to write, ending in .cdb, .msh, .inp, .vtu or .vtk; without an ending a folder with the ANSYS lists.
        output: PathBuf,
        /// Version of a .msh file; default 4.1.
        #[arg(long)]
        format: Option<MeshFormat>,
    },
}

/// Versions of Gmsh's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MeshFormat {
    /// Gmsh 4.1.
    Msh4,
    /// Gmsh 2.2.
    Msh2,
}

/// Where a mesh is.
#[derive(Debug, Args)]
pub struct MeshArgs {
    /// File ending in .cdb, .msh, .inp, .vtu or .vtk, folder with NODECOORD.DAT, ELEMENTNUM.DAT and DOF.DAT, or scene file
    /// (.toml) whose solid is meant.
    pub input: PathBuf,
}
