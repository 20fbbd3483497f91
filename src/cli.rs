//! The command line.

mod convert;
mod render;

use crate::progress::Verbosity;
use crate::run::Place;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub use convert::ConvertArgs;
pub use render::RenderArgs;

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
    Check {
        /// The scene.
        #[command(flatten)]
        args: CheckArgs,
        /// Print JSON, for programs.
        #[arg(long)]
        json: bool,
    },
    /// As `check`, with the stages, the loops, the memory per sphere and, from a short rehearsal, the time that a run will take.
    Explain {
        /// The scene.
        #[command(flatten)]
        args: CheckArgs,
        /// Threads that the run will have; default: all cores.
        #[arg(long)]
        threads: Option<usize>,
        /// Time of the rehearsal [s], more where it says little by then; 0: none, and no estimate of the time.
        #[arg(long, value_name = "SECONDS", default_value_t = 3.0)]
        rehearse: f64,
        /// Print JSON, for programs.
        #[arg(long)]
        json: bool,
    },
    /// Run variations of a scene, and compare error and cost of each: the trade of speed against accuracy.
    Study(StudyArgs),
    /// Make one page (HTML) with tables and plots of the results of one run, or of several beside each other.
    Report(ReportArgs),
    /// Make a folder with a commented scene that runs, to begin with; without arguments, list what there is.
    New(NewArgs),
    /// Print the JSON schema of scene files, by which editors complete and check keys.
    Schema {
        /// Print the tables of keys in Markdown instead; with PAGE, renew the tables of this file.
        #[arg(long, value_name = "PAGE", num_args = 0..=1)]
        markdown: Option<Option<PathBuf>>,
    },
    /// Print the completions of a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Natural frequencies and modes of the solid part of a scene.
    Modal(ModalArgs),
    /// Show the results of a run in a browser: grains, force chains, solid, walls; or write them as one HTML file.
    View(ViewArgs),
    /// Draw a picture, or a video, of the results of a run into a file: no display, no browser.
    Render(Box<RenderArgs>),
    /// Convert parameter decks, packings, animations and force chains of older programs, and frames of ours, into each other.
    Convert(ConvertArgs),
    /// Read a mesh: count and measure it, find its faults, or convert it.
    Mesh {
        /// What to do with the mesh.
        #[command(subcommand)]
        command: MeshCommand,
    },
    /// Make stones of spheres from surfaces or at random, for a stone library; measure libraries and surfaces.
    Stone {
        /// What to do with stones.
        #[command(subcommand)]
        command: StoneCommand,
    },
}

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Folder of the results; default `results/<name of the scene's folder or file>`, with a hash of the overrides.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; default all cores. The results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Where the steps of grains are computed in the run proper: spheres, clumps, planes, triangles and bonds on a CUDA device, all
    /// else on the processor.
    #[arg(long, value_enum, default_value_t)]
    pub device: Place,
    /// Replace one key of the scene, as key.path=value; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Refuse a solid that needs more memory than this, such as 8GB; default: what the machine has free.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Go on from the last checkpoint in the folder of the results. Scene and overrides must be the same, threads need not.
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Go on from the end of the finished run in a folder, with another load, other materials or more time; the model is the same.
    #[arg(long, value_name = "DIR")]
    pub from: Option<PathBuf>,
    /// With --from: put only the bed of that run into this scene, which has the same [[grains]] and may differ in all else.
    #[arg(long, requires = "from")]
    pub bed: bool,
    /// Replace what is in the folder of the results: results, the checkpoint of an interrupted run, files of others.
    #[arg(long)]
    pub force: bool,
    /// Refuse a scene with values that are not plausible, instead of remarking on them.
    #[arg(long)]
    pub strict: bool,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
    /// Print a line each second of what the run does, in place of the bar.
    #[arg(long, conflicts_with = "quiet")]
    pub verbose: bool,
}

impl RunArgs {
    /// How much is printed.
    pub fn verbosity(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        }
    }
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// What to begin with: track, box, footing, …
    pub template: Option<String>,
    /// Folder to write to; default the template's name.
    pub folder: Option<PathBuf>,
}

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArgs {
    /// Study file (TOML).
    pub study: PathBuf,
    /// Folder of the results; default `results/<name of the study file>`.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads of each run; default as many as there are cores for the runs at a time.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Runs at a time; default `jobs` of the study, else as many as there are cores for.
    #[arg(long)]
    pub jobs: Option<usize>,
    /// Carry out the runs k, k + N, … alone, counted from 1, and make no tables: for arrays of jobs.
    #[arg(long, value_name = "k/N", conflicts_with = "merge")]
    pub task: Option<String>,
    /// Carry out nothing: make the tables from the runs that are there, and name those that are missing.
    #[arg(long, conflicts_with_all = ["resume", "force", "jobs", "threads"])]
    pub merge: bool,
    /// Skip the runs that are done, and go on with those that were interrupted.
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Replace the runs that are there.
    #[arg(long)]
    pub force: bool,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Folders of results.
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// The page; default `report.html` in the folder, where it is a single one.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Title of the page; default that of the scene.
    #[arg(long)]
    pub title: Option<String>,
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

/// Arguments of `view`.
#[derive(Debug, Args)]
pub struct ViewArgs {
    /// Folder of the results of a run, or one with such folders below it.
    pub dir: PathBuf,
    /// Port on this machine (127.0.0.1); default any that is free.
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Write one HTML file that needs no server and no network, instead of serving.
    #[arg(long, value_name = "FILE.html")]
    pub export: Option<PathBuf>,
    /// Every N-th frame alone, and the last one, in the exported file.
    #[arg(long, value_name = "N", default_value = "1", requires = "export")]
    pub every: NonZeroUsize,
    /// Replace the exported file if it exists.
    #[arg(long, requires = "export")]
    pub force: bool,
    /// Do not start a browser.
    #[arg(long)]
    pub no_open: bool,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Refuse a scene with values that are not plausible, instead of remarking on them.
    #[arg(long)]
    pub strict: bool,
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

/// The commands of `stone`.
#[derive(Debug, Subcommand)]
pub enum StoneCommand {
    /// Make stones of closed surfaces.
    Make {
        /// Surfaces: .stl, .obj, or lists of vertices and triangles (.dat, .txt, .tri, .srf); one stone each.
        #[arg(required = true)]
        surfaces: Vec<PathBuf>,
        /// How.
        #[command(flatten)]
        stones: StoneArgs,
    },
    /// Make random stones: convex, with given elongation, flatness and angularity.
    Random {
        /// Number of stones.
        #[arg(long)]
        count: usize,
        /// Intermediate over longest extent (b/a), a number or a range low:high.
        #[arg(long, default_value = "0.6:0.95")]
        elongation: String,
        /// Shortest over intermediate extent (c/b), a number or a range low:high.
        #[arg(long, default_value = "0.6:0.95")]
        flatness: String,
        /// From 0, blunt, to 1, sharp; a number or a range low:high.
        #[arg(long, default_value = "0.5:0.9")]
        angularity: String,
        /// Folder for the surfaces themselves, as binary STL.
        #[arg(long)]
        surfaces: Option<PathBuf>,
        /// How.
        #[command(flatten)]
        stones: StoneArgs,
    },
    /// Make rough stones at random: few spheres that hardly overlap, with hollows in which neighbours interlock.
    Rough(RoughArgs),
    /// Numbers of the stones of a library (.toml) or of a surface.
    Info {
        /// Library or surface.
        input: PathBuf,
    },
}

/// What rough stones are like, and where they go.
#[derive(Debug, Args)]
pub struct RoughArgs {
    /// Number of stones.
    #[arg(long)]
    pub count: usize,
    /// Spheres of each stone, 2 to 12.
    #[arg(long, default_value_t = 4)]
    pub spheres: usize,
    /// Largest overlap of two spheres as a share of the sum of their radii, 0 to 0.5.
    #[arg(long, default_value_t = 0.1)]
    pub overlap: f64,
    /// Radii differ by this share up and down, 0 to 0.5.
    #[arg(long, default_value_t = 0.2)]
    pub spread: f64,
    /// Intermediate over longest extent (b/a), a number or a range low:high.
    #[arg(long, default_value = "0.6:0.95")]
    pub elongation: String,
    /// Shortest over intermediate extent (c/b), a number or a range low:high.
    #[arg(long, default_value = "0.6:0.95")]
    pub flatness: String,
    /// Starts everything random.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Library to write (.toml); without it only the measures are printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Replace files that exist.
    #[arg(long)]
    pub force: bool,
}

/// What stones are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StoneKind {
    /// Overlapping spheres, rigid.
    Clump,
    /// Separate spheres with bonds, breakable.
    Bonded,
}

/// How stones are made, and where they go.
#[derive(Debug, Args)]
pub struct StoneArgs {
    /// Spheres of each stone: 1 to 200 for clumps, 1 to 2000 for bonded stones.
    #[arg(long)]
    pub spheres: usize,
    /// Rigid clumps or breakable stones.
    #[arg(long = "as", value_name = "KIND", default_value = "clump")]
    pub kind: StoneKind,
    /// Library to write (.toml); without it only the measures are printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Replace files that exist.
    #[arg(long)]
    pub force: bool,
    /// Clumps: how far spheres may stand out over the surface, as a share of the largest inscribed radius; default 0.1.
    #[arg(long)]
    pub overhang: Option<f64>,
    /// Starts everything random; default 1.
    #[arg(long)]
    pub seed: Option<u64>,
    /// Bonded stones: radii differ by this share up and down; default 0.2.
    #[arg(long)]
    pub spread: Option<f64>,
    /// Bonded stones: largest gap of bonded spheres, as a share of their mean radius; default 0.2.
    #[arg(long)]
    pub gap: Option<f64>,
}
