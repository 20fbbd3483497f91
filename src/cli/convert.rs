//! The command line of `convert`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `convert`.
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// Parameter deck, packing, animation (ANIMATION_3D.DAT), force chains (3DF), or the folder of a run; recognized by their content.
    pub input: PathBuf,
    /// What to write: a scene (.toml), a table (.csv), an animation (.dat), force chains (.3df), or a folder of frames.
    pub output: PathBuf,
    /// Of a deck: packing that it reads (.csv of four columns).
    #[arg(long, value_name = "FILE")]
    pub packing: Option<PathBuf>,
    /// Of a deck: surface of the terrain or of a structure.
    #[arg(long, value_name = "FILE")]
    pub terrain: Option<PathBuf>,
    /// Of a deck without packing: edges of the box that grains are scattered in [m].
    #[arg(long = "box", value_name = "X,Y,Z", value_delimiter = ',')]
    pub region: Option<Vec<f64>>,
    /// Of force chains: animation with the places of the grains, for frames.
    #[arg(long, value_name = "FILE")]
    pub grains: Option<PathBuf>,
    /// Format of frames: vtk or vtkhdf.
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// Replace what exists.
    #[arg(long)]
    pub force: bool,
}
