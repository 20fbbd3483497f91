//! What files do not say themselves.

use std::path::PathBuf;

/// What is converted to what, and what the files themselves do not say.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Of a deck: packing that its `restart` reads.
    pub packing: Option<PathBuf>,
    /// Of a deck: terrain or structure.
    pub terrain: Option<PathBuf>,
    /// Of a deck without packing: box that grains are scattered in [m].
    pub region: Option<[f64; 3]>,
    /// Of chains: animation with the places of their grains.
    pub grains: Option<PathBuf>,
    /// Of a folder: format of its frames, `"vtk"` where none is named.
    pub format: Option<String>,
    /// Whether files may be replaced.
    pub force: bool,
}
