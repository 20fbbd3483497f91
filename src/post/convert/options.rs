//! Conversion options.

use std::path::PathBuf;

/// Options not contained in the files.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Deck: packing for its `restart`.
    pub packing: Option<PathBuf>,
    /// Deck: terrain or structure.
    pub terrain: Option<PathBuf>,
    /// Deck without packing: box for random grains [m].
    pub region: Option<[f64; 3]>,
    /// Chains: animation of their grains.
    pub grains: Option<PathBuf>,
    /// Directory: frame format, default `"vtk"`.
    pub format: Option<String>,
    /// Whether to replace existing files.
    pub force: bool,
}
