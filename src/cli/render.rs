//! Arguments of `render`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `render`. Where `PART=` stands, it may be left out: all parts are meant then. Parts are grains, chains, solid, boundary,
/// track.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Folder of the results of a run.
    pub dir: PathBuf,
    /// File to write, ending in png, jpg, bmp, or avi for a video; default `picture.png` in the folder.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long)]
    pub force: bool,
    /// Frame: a number from 0, a time such as 0.35s, last, or peak (of the load); for a video all, A:B or A:B:STEP. Default last, of
    /// a video all.
    #[arg(long, value_name = "FRAME")]
    pub frame: Option<String>,
    /// Width and height [pixels].
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720")]
    pub size: String,
    /// Frames of a video in a second.
    #[arg(long, value_name = "N", default_value_t = 10.0)]
    pub fps: f64,
    /// Show also: chains, boundary; separated by commas.
    #[arg(long, value_name = "PARTS")]
    pub show: Vec<String>,
    /// Do not show: a part, edges, legends, caption, axes, scale; separated by commas.
    #[arg(long, value_name = "PARTS")]
    pub hide: Vec<String>,
    /// Colour grains or the solid by a field, as grains=speed or solid=stress_zz; a name that does not exist lists those that do.
    #[arg(long, value_name = "[PART=]FIELD")]
    pub field: Vec<String>,
    /// Limits of the colours in SI units, as solid=-50e3:0; default those of the values of all frames shown.
    #[arg(long, value_name = "[PART=]LOW:HIGH", allow_hyphen_values = true)]
    pub range: Vec<String>,
    /// Colours: viridis, cividis, blue-red, diverging; default viridis.
    #[arg(long, value_name = "[PART=]NAME")]
    pub colour_map: Vec<String>,
    /// Opacity from 0 to 1; default 1, of the boundary 0.25.
    #[arg(long, value_name = "[PART=]SHARE")]
    pub opacity: Vec<String>,
    /// Keep what lies between, in metres: x=-1:1, or of one part grains:y=0:.
    #[arg(long, value_name = "[PART:]AXIS=LOW:HIGH", allow_hyphen_values = true)]
    pub clip: Vec<String>,
    /// From where to look: oblique, front, back, left, right, top, bottom, or azimuth from x towards y and elevation [degrees] as
    /// -60:25; default oblique, of what lies in a plane straight at it.
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    pub view: Option<String>,
    /// Perspective, or parallel, which keeps lengths; default perspective, of what lies in a plane parallel.
    #[arg(long, value_name = "KIND")]
    pub projection: Option<String>,
    /// Magnification.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub zoom: f64,
    /// What the picture is filled with: all, or grains, with a part of the solid below.
    #[arg(long, value_name = "WHAT", default_value = "all")]
    pub focus: String,
    /// white, dark, or a colour such as #e8edf2.
    #[arg(long, value_name = "COLOUR", default_value = "white")]
    pub background: String,
    /// Factor of the displacement of the solid.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub deform: f64,
    /// Displacements, and the field of the solid, as change since this frame.
    #[arg(long, value_name = "FRAME")]
    pub since: Option<usize>,
    /// Colours of the solid in this many steps; default 0: even.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub bands: usize,
    /// Leave out chains below this share of the largest force.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    pub least: f64,
    /// Factor of the thickness of chains.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub thickness: f64,
    /// Threads; default all cores. The picture does not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
}
