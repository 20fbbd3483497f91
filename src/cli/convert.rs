//! Arguments of `convert`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `convert`.
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// Deck, packing, animation (ANIMATION_3D.DAT), force chains (3DF), or results directory.
    pub input: PathBuf,
    /// Output: scene (.toml), table (.csv), animation (.dat), chains (.3df), or frame directory.
    pub output: PathBuf,
    /// Deck: packing that it reads (.csv of four columns).
    #[arg(long, value_name = "FILE")]
    pub packing: Option<PathBuf>,
    /// Deck: surface of the terrain or of a structure.
    #[arg(long, value_name = "FILE")]
    pub terrain: Option<PathBuf>,
    /// Deck without packing: edges of the box in which grains are placed at random [m].
    #[arg(long = "box", value_name = "X,Y,Z", value_delimiter = ',')]
    pub region: Option<Vec<f64>>,
    /// Force chains to frames: animation with the positions of the grains.
    #[arg(long, value_name = "FILE")]
    pub grains: Option<PathBuf>,
    /// Format of frames: vtk or vtkhdf.
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}
