//! Pictures of results and scenes, without a display, as PNG, JPEG, BMP or AVI files.

mod colours;
mod draw;
mod encode;
mod labels;
pub mod options;
mod parts;
mod preview;
mod run;
mod sheet;

use std::path::{Path, PathBuf};

use draw::{Camera, Room, V3};
use encode::Form;
use options::{Frames, Options, Part, joined, refuse};
use parts::{Limits, Parts};
use run::{Moment, Run, Wanted};
use sheet::{Ink, Legend, Picture, legend, marks};
use trackbed_io::failure::Failure;
use trackbed_io::results::series;
use trackbed_io::write::WriteError;

pub use preview::render as render_scene;

const NAME: &str = "picture.png";
/// Margin [sheet units].
const MARGIN: f32 = 20.0;
/// Height of the caption.
const HEAD: f32 = 58.0;
/// Height of axes and scale.
const FOOT: f32 = 44.0;
/// Depth of ground shown below grains over their extent.
const BELOW: f32 = 0.35;

/// Written file.
pub struct Written {
    /// Path of the file.
    pub file: PathBuf,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Frame indices.
    pub frames: Vec<usize>,
    /// Frame times [s].
    pub times: Vec<f64>,
}

/// Renders a picture, or a video of several frames.
///
/// # Errors
/// Missing results, frames or fields, existing file; I/O errors.
pub fn render(options: &Options) -> Result<Written, Failure> {
    let (file, form) = target(options, &options.dir.join(NAME))?;
    let run = Run::open(&options.dir)?;
    run.check_fields(options)?;
    if let Some(since) = options.since.filter(|k| *k >= run.frames.len()) {
        return Err(refuse("since", &since.to_string(), &format!("0 to {}", run.frames.len() - 1)));
    }
    let usual = if form == Form::Avi { Frames::Range(0, usize::MAX, 1) } else { Frames::Last };
    let frames = run.chosen(options.frames.as_ref().unwrap_or(&usual))?;
    if form != Form::Avi && frames.len() > 1 {
        let found = format!("{} frames for a picture", frames.len());
        return Err(refuse("frame", &found, "one, or a file that ends in avi"));
    }
    let studio = Studio::new(&run, options, &frames)?;
    match form {
        Form::Avi => {
            let frame = |k: usize| studio.picture(frames[k]).map_err(Refused::Results);
            encode::write_video(&file, options.size, options.rate, frames.len(), frame)
                .map_err(Failure::from)?;
        }
        _ => encode::write(&file, form, &studio.picture(frames[0])?).map_err(Refused::Disk)?,
    }
    let times = frames.iter().map(|k| run.frames[*k].time).collect();
    Ok(Written { file, size: options.size, frames, times })
}

/// Returns the last frame as a JPEG picture of `size`, and its caption; none without frames.
///
/// # Errors
/// Invalid results; I/O errors.
pub fn last_frame(dir: &Path, size: [usize; 2]) -> Result<Option<(Vec<u8>, String)>, Failure> {
    let options = Options { size, hide: vec![Part::Caption], ..Options::new(dir) };
    let run = Run::open(dir)?;
    let Some(last) = run.frames.len().checked_sub(1) else { return Ok(None) };
    let studio = Studio::new(&run, &options, &[last])?;
    let bytes = encode::jpg(dir, &studio.picture(last)?)?;
    Ok(Some((bytes, studio.remark(last).replace("   ", ", "))))
}

/// Returns the file to write, `usual` by default, and its format.
fn target(options: &Options, usual: &Path) -> Result<(PathBuf, Form), Failure> {
    let file = options.out.clone().unwrap_or_else(|| usual.to_path_buf());
    let form = Form::of(&file).ok_or_else(|| {
        let endings = joined(encode::ENDINGS.iter().map(|(e, _)| *e));
        refuse("out", &file.display().to_string(), &format!("a name that ends in one of {endings}"))
    })?;
    if file.is_dir() {
        return Err(Failure::Input(format!(
            "{}: found a directory, expected the name of a file",
            file.display()
        )));
    }
    if file.exists() && !options.force {
        return Err(Failure::Input(format!(
            "{}: found an existing file, expected a new file, or --force to overwrite it",
            file.display()
        )));
    }
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|p| !p.is_dir()) {
        return Err(Failure::Input(format!(
            "{}: found no directory {}, expected an existing one",
            file.display(),
            folder.display()
        )));
    }
    Ok((file, form))
}

enum Refused {
    Results(Failure),
    Disk(WriteError),
}

impl From<WriteError> for Refused {
    fn from(error: WriteError) -> Refused {
        Refused::Disk(error)
    }
}

impl From<Refused> for Failure {
    fn from(refused: Refused) -> Failure {
        use std::io::ErrorKind::{NotFound, PermissionDenied, ReadOnlyFilesystem};
        match refused {
            Refused::Results(failure) => failure,
            Refused::Disk(WriteError::Io { file, source })
                if matches!(source.kind(), NotFound | PermissionDenied | ReadOnlyFilesystem) =>
            {
                let found = format!("a file that cannot be written ({source})");
                Failure::Input(format!("{}: found {found}, expected one that can", file.display()))
            }
            Refused::Disk(error) => error.into(),
        }
    }
}

struct Studio<'a> {
    run: &'a Run,
    options: &'a Options,
    wanted: Wanted,
    origin: [f64; 3],
    limits: Limits,
    eye: Camera,
    /// Last frame read for the colour limits.
    first: Option<(usize, Moment)>,
}

impl<'a> Studio<'a> {
    /// Computes colour limits of all frames, and the camera from first and last.
    fn new(run: &'a Run, options: &'a Options, frames: &[usize]) -> Result<Studio<'a>, Failure> {
        let wanted = wanted(run, options)?;
        let ends = [frames[0], frames[frames.len() - 1]];
        let mut limits = Limits::default();
        let mut shown: Vec<V3> = Vec::new();
        let mut grains: Vec<V3> = Vec::new();
        let mut origin = None;
        let (mut last, mut plane) = (None, None);
        for frame in frames {
            let moment = run.moment(*frame, &wanted)?;
            let own = Limits::of(run, &moment, &wanted);
            limits = limits.and(own);
            if ends.contains(frame) {
                let at = *origin.get_or_insert_with(|| middle(run, &moment));
                let parts = Parts::of(run, &moment, options, &wanted, at, own)?;
                shown.extend(parts.corners);
                grains.extend(parts.bed.into_iter().flatten());
            }
            plane = flat(run, &moment);
            last = Some((*frame, moment));
        }
        if options.near_grains && !grains.is_empty() {
            shown = below(&grains);
        }
        let eye = camera(options, &shown, plane, wanted.coloured());
        let origin = origin.unwrap_or_default();
        Ok(Studio { run, options, wanted, origin, limits, eye, first: last.filter(|_| frames.len() == 1) })
    }

    fn picture(&self, frame: usize) -> Result<Picture, Failure> {
        let (run, options) = (self.run, self.options);
        let read;
        let moment = match &self.first {
            Some((known, moment)) if *known == frame => moment,
            _ => {
                read = run.moment(frame, &self.wanted)?;
                &read
            }
        };
        let parts = Parts::of(run, moment, options, &self.wanted, self.origin, self.limits)?;
        Ok(compose(
            options,
            &self.eye,
            (&parts.scene, &parts.legends),
            (&run.about.title, &self.remark(frame)),
        ))
    }

    fn remark(&self, frame: usize) -> String {
        let run = self.run;
        let mut words = vec![format!("t = {:.4} s", run.frames[frame].time), format!("frame {frame}")];
        words.extend(run.cycle(frame).map(|n| format!("cycle {n}")));
        words.extend(run.load(frame).map(|load| {
            let (factor, unit) = labels::scaled("N", load.abs());
            format!("load {} {unit}", labels::figure(load / factor, 1))
        }));
        if self.wanted.solid.is_some() && run.skin.is_some() && self.options.deform != 1.0 {
            words.push(format!("displacement × {}", self.options.deform));
        }
        if run.about.status != "done" {
            words.push(format!("run: {}", run.about.status));
        }
        words.join("   ")
    }
}

/// Camera that shows all points, from the chosen side, else along the normal of a plane scene.
fn camera(options: &Options, shown: &[V3], plane: Option<V3>, coloured: bool) -> Camera {
    let perspective = options.perspective.unwrap_or(plane.is_none());
    let towards = options.towards.or(plane).unwrap_or_else(options::oblique);
    let u = sheet::unit(options.size[1]);
    let foot = options.shows(Part::Axes, true) || options.shows(Part::Scale, true);
    let room = Room {
        left: MARGIN * u,
        right: if options.shows(Part::Legends, true) && coloured { legend::ROOM * u } else { MARGIN * u },
        top: if options.shows(Part::Caption, true) { HEAD * u } else { MARGIN * u },
        bottom: if foot { FOOT * u } else { MARGIN * u },
    };
    let all = [V3::repeat(-1.0), V3::repeat(1.0)];
    let shown = if shown.is_empty() { &all } else { shown };
    Camera::showing(shown, towards, perspective, options.size, room, options.zoom)
}

/// Picture of a scene with legends, title and remark.
fn compose(
    options: &Options,
    eye: &Camera,
    (scene, legends): (&draw::Scene, &[Legend]),
    (title, remark): (&str, &str),
) -> Picture {
    let [width, height] = options.size;
    let pixels = draw::draw(scene, eye, options.size, options.background);
    let mut picture = Picture { width, height, pixels };
    let (u, ink) = (sheet::unit(height), Ink::on(options.background));
    let mut free = width as f32;
    if options.shows(Part::Legends, true) && !legends.is_empty() {
        legend::draw(&mut picture, legends, &ink, u);
        free -= legend::ROOM * u;
    }
    if options.shows(Part::Caption, true) {
        marks::caption(&mut picture, title, remark, free, &ink, u);
    }
    let mut from = 24.0 * u;
    if options.shows(Part::Axes, true) {
        marks::axes(&mut picture, eye, &ink, u);
        from = 124.0 * u;
    }
    if options.shows(Part::Scale, true) {
        marks::scale(&mut picture, eye, from, &ink, u);
    }
    picture
}

fn wanted(run: &Run, options: &Options) -> Result<Wanted, Failure> {
    let has_grains = run.has(series::Part::Grains);
    let grains = has_grains && options.shows(Part::Grains, true);
    // Chains are the default without grains.
    let chains = run.has(series::Part::Chains) && options.shows(Part::Chains, !has_grains);
    let solid = run.skin.is_some() && options.shows(Part::Solid, true);
    let field = |shown: bool, part| shown.then(|| run.field(options, part)).transpose();
    Ok(Wanted {
        grains: field(grains, Part::Grains)?,
        solid: field(solid, Part::Solid)?,
        chains,
        walls: run.has(series::Part::Walls),
        since: options.since,
    })
}

impl Wanted {
    fn coloured(&self) -> bool {
        let field = |f: &Option<String>| f.as_deref().is_some_and(|f| f != "constant");
        field(&self.grains) || field(&self.solid) || self.chains
    }
}

fn middle(run: &Run, moment: &Moment) -> [f64; 3] {
    let boxes = [moment.grains.as_ref().and_then(|g| g.bounds()), run.skin.as_ref().map(|s| s.bounds())];
    let found = boxes.into_iter().flatten().next().or_else(|| {
        let chains = moment.chains.as_ref()?;
        chains.ends.first_chunk::<3>().map(|x| [*x, *x])
    });
    found.map_or([0.0; 3], |b| [0, 1, 2].map(|k| 0.5 * (b[0][k] + b[1][k])))
}

fn below(grains: &[V3]) -> Vec<V3> {
    let low = grains.iter().fold(V3::repeat(f32::INFINITY), |a, b| a.inf(b));
    let high = grains.iter().fold(V3::repeat(f32::NEG_INFINITY), |a, b| a.sup(b));
    let down = BELOW * (high.x - low.x).max(high.y - low.y);
    let corner = |c: usize| {
        let low = low - V3::z() * down;
        V3::from([0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] }))
    };
    (0..8).map(corner).collect()
}

/// View direction of a 2D scene, normal to the plane of all centres.
fn flat(run: &Run, moment: &Moment) -> Option<V3> {
    let grains = moment.grains.as_ref().filter(|g| g.bodies.id.len() > 1 && run.skin.is_none())?;
    let plane = |k: &usize| {
        let along = grains.centres().iter().skip(*k).step_by(3);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |b, x| (b.0.min(*x), b.1.max(*x)));
        high - low < 1e-3 * grains.bodies.radius[0]
    };
    (0..3).find(plane).map(|k| [V3::x(), -V3::y(), V3::z()][k])
}
