//! Arguments of `render`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `render`. Where `PART=` stands, it may be left out: all parts are meant then. Parts are grains, chains, solid, boundary,
/// track, water; of a scene also marks (supports, loads, boxes, probes), sets.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Results directory of a run, or a scene.
    pub dir: PathBuf,
    /// Set one key of the scene, as key.path=value; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Output: png, jpg, bmp, or avi for a video [default: picture.png in DIR].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
    /// Frame: index, time as 0.35s, last, peak; video: all, A:B, A:B:STEP [default: last; all].
    #[arg(long, value_name = "FRAME")]
    pub frame: Option<String>,
    /// Width and height [pixels].
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720")]
    pub size: String,
    /// Frames per second of a video.
    #[arg(long, value_name = "N", default_value_t = 10.0)]
    pub fps: f64,
    /// Parts to add: chains, boundary; separated by commas.
    #[arg(long, value_name = "PARTS")]
    pub show: Vec<String>,
    /// Parts to hide: a part, edges, legends, caption, axes, scale; separated by commas.
    #[arg(long, value_name = "PARTS")]
    pub hide: Vec<String>,
    /// Field to colour by, as grains=speed or solid=stress_zz; an unknown name lists all.
    #[arg(long, value_name = "[PART=]FIELD")]
    pub field: Vec<String>,
    /// Limits of the colours in SI units, as solid=-50e3:0 [default: range of the frames shown].
    #[arg(long, value_name = "[PART=]LOW:HIGH", allow_hyphen_values = true)]
    pub range: Vec<String>,
    /// Colour map: viridis, cividis, blue-red, diverging [default: viridis].
    #[arg(long, value_name = "[PART=]NAME")]
    pub colour_map: Vec<String>,
    /// Opacity from 0 to 1 [default: 1; boundary: 0.25; water: 0.35].
    #[arg(long, value_name = "[PART=]FRACTION")]
    pub opacity: Vec<String>,
    /// Range to keep [m], as x=-1:1, or of one part as grains:y=0:.
    #[arg(long, value_name = "[PART:]AXIS=LOW:HIGH", allow_hyphen_values = true)]
    pub clip: Vec<String>,
    /// View: oblique, front, back, left, right, top, bottom, or azimuth:elevation [deg].
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    pub view: Option<String>,
    /// Projection: perspective or parallel [default: perspective; parallel for plane models].
    #[arg(long, value_name = "KIND")]
    pub projection: Option<String>,
    /// Magnification.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub zoom: f64,
    /// Parts to fit the image to: all, or grains with the solid below them.
    #[arg(long, value_name = "WHAT", default_value = "all")]
    pub focus: String,
    /// Background: white, dark, or a colour such as #e8edf2.
    #[arg(long, value_name = "COLOUR", default_value = "white")]
    pub background: String,
    /// Scale factor of the displacements of the solid.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub deform: f64,
    /// Reference frame for displacements and the field of the solid.
    #[arg(long, value_name = "FRAME")]
    pub since: Option<usize>,
    /// Number of colour bands of the solid; 0: continuous.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub bands: usize,
    /// Smallest force of chains to draw, as a fraction of the largest.
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0)]
    pub min_force: f64,
    /// Scale factor of the thickness of chains.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub thickness: f64,
    /// Threads; the image does not depend on it [default: all cores].
    #[arg(long)]
    pub threads: Option<usize>,
}
