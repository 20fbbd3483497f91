//! The command line.

mod convert;
mod render;

use clap::error::{ContextKind, ErrorKind};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use trackbed_io::failure::Failure;
use trackbed_io::progress::Verbosity;
use trackbed_io::replaced;
use trackbed_run::Place;

pub use convert::ConvertArgs;
pub use render::RenderArgs;

/// Coupled DEM–FEM solver for ballasted railway track.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Cli {
    /// Command.
    #[command(subcommand)]
    pub command: Command,
}

impl Cli {
    /// Parses the command line. Help, version and usage errors end the process.
    ///
    /// # Errors
    /// A replaced option.
    pub fn read() -> Result<Cli, Failure> {
        Cli::try_parse().map_err(|error| {
            let command = std::env::args_os().nth(1).unwrap_or_default();
            replaced_option(&error, &command.to_string_lossy()).unwrap_or_else(|| error.exit())
        })
    }
}

/// Returns the failure of a replaced option of `command`, if `error` is one.
pub fn replaced_option(error: &clap::Error, command: &str) -> Option<Failure> {
    let option = error.get(ContextKind::InvalidArg)?.to_string();
    let new = replaced::option(command, &option).filter(|_| error.kind() == ErrorKind::UnknownArgument)?;
    Some(Failure::Input(format!("{command}: found `{option}`, expected `{new}`")))
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene: packing, equilibrium, main stage; write the results.
    Run(RunArgs),
    /// Check a scene without running it; print its models, step sizes and memory.
    Check {
        /// Scene.
        #[command(flatten)]
        args: CheckArgs,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Like `check`; also stages, contact kernels, memory, and run time from a short trial run.
    Explain {
        /// Scene.
        #[command(flatten)]
        args: CheckArgs,
        /// Threads of the run [default: all cores].
        #[arg(long)]
        threads: Option<usize>,
        /// Duration of the trial run [s]; 0: no trial run and no estimate of the run time.
        #[arg(long, value_name = "SECONDS", default_value_t = 3.0)]
        trial: f64,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Run variants of a scene: sensitivity to parameters, calibration, errors and costs.
    Study(StudyArgs),
    /// Run traffic and tampings over the life of a track, with several packings.
    Life(LifeArgs),
    /// Test soil models at one stress point: triaxial, undrained, oedometer, simple shear, any path.
    Element(ElementArgs),
    /// Write an HTML report of one run or study, or a comparison of several runs.
    Report(ReportArgs),
    /// Run the scene of a finished run again and compare the results, file by file.
    Reproduce(ReproduceArgs),
    /// Recompute the verification matrix: cases with a reference, here and in other programs.
    Verify(VerifyArgs),
    /// Run a small track, about one minute, and show it in a browser.
    Demo(DemoArgs),
    /// Create a directory with a commented example scene; without arguments, list the templates.
    New(NewArgs),
    /// Print the JSON schema of scene files, for completion and validation in editors.
    Schema {
        /// Print the tables of keys in Markdown instead; with PAGE, renew the tables of this file.
        #[arg(long, value_name = "PAGE", num_args = 0..=1)]
        markdown: Option<Option<PathBuf>>,
        /// List the columns of the result tables with unit and meaning instead.
        #[arg(long, conflicts_with = "markdown")]
        columns: bool,
    },
    /// Print a completion script for a shell.
    Completions {
        /// Shell.
        shell: clap_complete::Shell,
    },
    /// Write a manual page of each command into a directory.
    Manual {
        /// Directory, created if missing.
        folder: PathBuf,
    },
    /// Compute natural frequencies and modes of the solid of a scene.
    Modal(ModalArgs),
    /// Show the results of a run, or a scene before it runs, in a browser; export them as one HTML file.
    View(ViewArgs),
    /// Render an image of a scene, or an image or video of results, to a file, without a display.
    Render(Box<RenderArgs>),
    /// Convert decks, packings, animations and force chains of older programs, and frames.
    Convert(ConvertArgs),
    /// Inspect, check or convert a mesh.
    Mesh {
        /// Command.
        #[command(subcommand)]
        command: MeshCommand,
    },
    /// Generate stones for a library, from surfaces or at random; measure libraries and surfaces.
    Stone {
        /// Command.
        #[command(subcommand)]
        command: StoneCommand,
    },
}

/// Arguments of `run`.
#[derive(Debug, Default, Args)]
pub struct RunArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Results directory [default: results/SCENE, with a hash of the overrides].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; the results do not depend on it [default: all cores].
    #[arg(long)]
    pub threads: Option<usize>,
    /// Device for the DEM steps of the main stage; unsupported contacts stay on the CPU.
    #[arg(long, value_enum, default_value_t)]
    pub device: Place,
    /// Set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Memory limit of the solid, such as 8GB; larger ones are rejected [default: free memory].
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Resume from the last checkpoint; scene and overrides unchanged, threads may differ.
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Restart from the final state of a completed run of the same model.
    #[arg(long, value_name = "DIR")]
    pub from: Option<PathBuf>,
    /// With --from: import only the grains; [[grains]] must be the same, the rest may differ.
    #[arg(long, requires = "from")]
    pub bed: bool,
    /// Overwrite the results directory, including checkpoints and unrelated files.
    #[arg(long)]
    pub force: bool,
    /// Treat warnings about implausible values as errors.
    #[arg(long)]
    pub strict: bool,
    /// Print errors only.
    #[arg(long)]
    pub quiet: bool,
    /// Print progress as a line each second, and stability numbers and factorizations.
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

/// Arguments of `reproduce`.
#[derive(Debug, Args)]
pub struct ReproduceArgs {
    /// Results directory of a finished run with unchanged input files, or its archive (.tar.gz).
    pub results: PathBuf,
    /// Run nothing: write results and input files to an archive (.tar.gz).
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out", "threads"])]
    pub archive: Option<PathBuf>,
    /// Results directory of the new run [default: RESULTS-reproduced].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; the results do not depend on it [default: all cores].
    #[arg(long)]
    pub threads: Option<usize>,
}

/// Arguments of `verify`.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Compute the rows with other programs too; missing ones are skipped.
    #[arg(long)]
    pub peers: bool,
    /// Compute the rows on a CUDA device too; without one they are skipped.
    #[arg(long)]
    pub gpu: bool,
    /// Compute the rows on several ranks too; needs mpirun and the feature `mpi`.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=64))]
    pub ranks: Option<u32>,
    /// Only these rows or groups.
    #[arg(long, value_name = "NAME", num_args = 1..)]
    pub only: Vec<String>,
    /// Results directory.
    #[arg(long, default_value = "results/verify")]
    pub out: PathBuf,
    /// Cases and programs (TOML).
    #[arg(long, value_name = "FILE", default_value = "inputs/verify/matrix.toml")]
    pub matrix: PathBuf,
    /// Python interpreter of the other programs.
    #[arg(long, value_name = "FILE", default_value = "python3", requires = "peers")]
    pub python: PathBuf,
    /// Renew the tables and the plot of this page of the guide; needs --peers.
    #[arg(long, value_name = "PAGE", requires = "peers", conflicts_with = "only")]
    pub page: Option<PathBuf>,
    /// Print errors only.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `life`.
#[derive(Debug, Args)]
pub struct LifeArgs {
    /// Life file (TOML): scene, packings, traffic, tampings.
    pub life: PathBuf,
    /// Check the file and list its runs, without running.
    #[arg(long, conflicts_with_all = ["out", "resume", "force", "quiet"])]
    pub plan: bool,
    /// Results directory [default: results/NAME of the file].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads of each run [default: cores divided by packings].
    #[arg(long)]
    pub threads: Option<usize>,
    /// Keep finished runs and resume interrupted ones.
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Overwrite existing runs.
    #[arg(long)]
    pub force: bool,
    /// Print errors only.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `demo`.
#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Directory of scene and results.
    #[arg(long, default_value = "results/demo")]
    pub out: PathBuf,
    /// Threads; the results do not depend on it [default: all cores].
    #[arg(long)]
    pub threads: Option<usize>,
    /// End after the run, without the viewer.
    #[arg(long)]
    pub no_view: bool,
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// Template: track, box, footing, …
    pub template: Option<String>,
    /// Directory to create [default: name of the template].
    pub folder: Option<PathBuf>,
}

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArgs {
    /// Study file (TOML); with --trade, a scene.
    #[arg(required_unless_present = "score")]
    pub study: Option<PathBuf>,
    /// Vary each setting of accuracy of the scene alone; the reference has the finest of each.
    #[arg(long, conflicts_with = "score")]
    pub trade: bool,
    /// With --trade: set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE", requires = "trade")]
    pub set: Vec<String>,
    /// With --trade: number of random specimens, 0 for the seeds of the scene [default: 3].
    #[arg(long, value_name = "N", requires = "trade")]
    pub seeds: Option<u64>,
    /// With --trade: largest relative error of the recommended case [default: 0.05].
    #[arg(long, value_name = "E", requires = "trade")]
    pub tolerance: Option<f64>,
    /// Run nothing: score predictions against measured values (CSV files as in inputs/ballast/blind).
    #[arg(long, num_args = 2, value_names = ["PREDICTIONS", "MEASURED"], conflicts_with_all = ["study", "out", "threads", "jobs", "task", "merge", "resume", "force", "quiet"])]
    pub score: Vec<PathBuf>,
    /// Curve given for calibration, for null models beside the predictions.
    #[arg(long, value_name = "CSV", requires = "score")]
    pub given: Option<PathBuf>,
    /// Results directory [default: results/NAME of the study file, with --trade results/NAME_trade].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads of each run [default: cores divided by simultaneous runs].
    #[arg(long)]
    pub threads: Option<usize>,
    /// Simultaneous runs [default: `jobs` of the study, or as the cores permit].
    #[arg(long)]
    pub jobs: Option<usize>,
    /// Perform only runs k, k + N, … (from 1) and write no tables; for job arrays.
    #[arg(long, value_name = "k/N", conflicts_with = "merge")]
    pub task: Option<String>,
    /// Run nothing: write the tables from existing runs and list the missing ones.
    #[arg(long, conflicts_with_all = ["resume", "force", "jobs", "threads"])]
    pub merge: bool,
    /// Skip completed runs and resume interrupted ones.
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Overwrite existing runs.
    #[arg(long)]
    pub force: bool,
    /// Print errors only.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `element`.
#[derive(Debug, Args)]
pub struct ElementArgs {
    /// File of materials and tests (TOML).
    pub file: PathBuf,
    /// Results directory [default: results/NAME of the file].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Set one key of the file, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Overwrite existing results.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Results directories.
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// HTML file to write [default for one directory: report.html in it].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Title of the report [default: title of the scene].
    #[arg(long)]
    pub title: Option<String>,
    /// Axle load of a cycle in tonnes: settlement against traffic (MGT), extrapolated.
    #[arg(long, value_name = "TONNES")]
    pub axle_load: Option<f64>,
    /// Overwrite an existing file that is no report.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `modal`.
#[derive(Debug, Args)]
pub struct ModalArgs {
    /// Scene file (TOML) with a solid.
    pub scene: PathBuf,
    /// Number of modes.
    #[arg(short = 'n', long, default_value_t = 6)]
    pub count: usize,
    /// Results directory [default: results/NAME_modes].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; the results do not depend on it [default: all cores].
    #[arg(long)]
    pub threads: Option<usize>,
    /// Set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Arguments of `view`.
#[derive(Debug, Args)]
pub struct ViewArgs {
    /// Results directory of a run, a parent of results directories, or a scene.
    pub dir: PathBuf,
    /// Set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Port on 127.0.0.1 [default: any free port].
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Write one self-contained HTML file instead of starting a server.
    #[arg(long, value_name = "FILE.html")]
    pub export: Option<PathBuf>,
    /// Export every N-th frame and the last one.
    #[arg(long, value_name = "N", default_value = "1", requires = "export")]
    pub every: NonZeroUsize,
    /// Overwrite an existing file.
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
    /// Treat warnings about implausible values as errors.
    #[arg(long)]
    pub strict: bool,
    /// Set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Memory limit of the solid, such as 8GB; larger ones are rejected [default: free memory].
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Print stability numbers, contact pairs and solver figures too.
    #[arg(long)]
    pub verbose: bool,
}

/// The commands of `mesh`.
#[derive(Debug, Subcommand)]
pub enum MeshCommand {
    /// Print counts, sizes, materials, volumes and quality.
    Info(MeshArgs),
    /// Check for defects; exit code 2 if there are any.
    Check(MeshArgs),
    /// Write the mesh in another format.
    Convert {
        /// Mesh.
        #[command(flatten)]
        mesh: MeshArgs,
        /// Output: .cdb, .msh, .inp, .vtu, .vtk; without an extension, a directory of ANSYS lists.
        output: PathBuf,
        /// Version of a .msh file [default: 4.1].
        #[arg(long)]
        format: Option<MeshFormat>,
        /// Overwrite existing files.
        #[arg(long)]
        force: bool,
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
    /// Mesh file (.cdb, .msh, .inp, .vtu, .vtk), directory of ANSYS lists, or scene (.toml).
    pub input: PathBuf,
}

/// The commands of `stone`.
#[derive(Debug, Subcommand)]
pub enum StoneCommand {
    /// Generate stones from closed surfaces.
    Make {
        /// Surfaces (.stl, .obj, or lists .dat, .txt, .tri, .srf), one stone each.
        #[arg(required = true)]
        surfaces: Vec<PathBuf>,
        /// Options of stones.
        #[command(flatten)]
        stones: StoneArgs,
    },
    /// Generate random convex stones of given elongation, flatness and angularity.
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
        /// Angularity from 0 (blunt) to 1 (sharp), a number or a range low:high.
        #[arg(long, default_value = "0.5:0.9")]
        angularity: String,
        /// Directory for the surfaces, as binary STL.
        #[arg(long)]
        surfaces: Option<PathBuf>,
        /// Options of stones.
        #[command(flatten)]
        stones: StoneArgs,
    },
    /// Generate random concave clumps of few spheres, which interlock.
    Rough(RoughArgs),
    /// Print the properties of the stones of a library (.toml) or of a surface.
    Info {
        /// Library or surface.
        input: PathBuf,
    },
}

/// Shape, number and library of rough stones.
#[derive(Debug, Args)]
pub struct RoughArgs {
    /// Number of stones.
    #[arg(long)]
    pub count: usize,
    /// Spheres of each stone, 2 to 12.
    #[arg(long, default_value_t = 4)]
    pub spheres: usize,
    /// Largest overlap of two spheres, as a fraction of the sum of their radii, 0 to 0.5.
    #[arg(long, default_value_t = 0.1)]
    pub overlap: f64,
    /// Relative variation of radii, up and down, 0 to 0.5.
    #[arg(long, default_value_t = 0.2)]
    pub spread: f64,
    /// Intermediate over longest extent (b/a), a number or a range low:high.
    #[arg(long, default_value = "0.6:0.95")]
    pub elongation: String,
    /// Shortest over intermediate extent (c/b), a number or a range low:high.
    #[arg(long, default_value = "0.6:0.95")]
    pub flatness: String,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Library to write (.toml); without it, only the properties are printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

/// Kind of stones.
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
    /// Rigid clumps or breakable bonded stones.
    #[arg(long = "as", value_name = "KIND", default_value = "clump")]
    pub kind: StoneKind,
    /// Library to write (.toml); without it, only the properties are printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
    /// Clumps: protrusion of spheres, in radii of the largest inscribed sphere [default: 0.1].
    #[arg(long)]
    pub overhang: Option<f64>,
    /// Seed of the random numbers [default: 1].
    #[arg(long)]
    pub seed: Option<u64>,
    /// Bonded stones: relative variation of radii, up and down [default: 0.2].
    #[arg(long)]
    pub spread: Option<f64>,
    /// Bonded stones: largest gap of bonded spheres, in mean radii of the pair [default: 0.2].
    #[arg(long)]
    pub gap: Option<f64>,
}
