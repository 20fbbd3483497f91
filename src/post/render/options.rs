//! Options of pictures from the command line, named as in the viewer.

use std::path::{Path, PathBuf};

use super::colours;
use super::draw::{Colour, V3};
use trackbed_io::failure::Failure;

/// Shown part of model or sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Grains.
    Grains,
    /// Force chains.
    Chains,
    /// Solid.
    Solid,
    /// Walls.
    Boundary,
    /// Sleepers and rails.
    Track,
    /// Water surface.
    Water,
    /// Supports, loads, boxes, probes of a scene.
    Marks,
    /// Sets of the mesh of a scene.
    Sets,
    /// Element edges.
    Edges,
    /// Legends.
    Legends,
    /// Title and time.
    Caption,
    /// Axis directions.
    Axes,
    /// Length scale.
    Scale,
}

const PARTS: [(Part, &str); 13] = [
    (Part::Grains, "grains"),
    (Part::Chains, "chains"),
    (Part::Solid, "solid"),
    (Part::Boundary, "boundary"),
    (Part::Track, "track"),
    (Part::Water, "water"),
    (Part::Marks, "marks"),
    (Part::Sets, "sets"),
    (Part::Edges, "edges"),
    (Part::Legends, "legends"),
    (Part::Caption, "caption"),
    (Part::Axes, "axes"),
    (Part::Scale, "scale"),
];
const BODIES: usize = 8;

/// View directions of the viewer; z points up.
const SIDES: [(&str, [f32; 3]); 7] = [
    ("oblique", [0.55, -1.0, 0.5]),
    ("front", [0.0, -1.0, 0.0]),
    ("back", [0.0, 1.0, 0.0]),
    ("left", [-1.0, 0.0, 0.0]),
    ("right", [1.0, 0.0, 0.0]),
    ("top", [0.0, 0.0, 1.0]),
    ("bottom", [0.0, 0.0, -1.0]),
];

/// Largest side [pixels].
const LARGEST: usize = 16384;
/// Most pixels: 8192 × 4096.
const MOST: usize = 1 << 25;
/// Smallest side [pixels].
const SMALLEST: usize = 16;

/// Selected frames.
#[derive(Clone, Debug, PartialEq)]
pub enum Frames {
    /// Last frame.
    Last,
    /// Frame of largest load.
    Peak,
    /// Index from 0.
    Number(usize),
    /// Frame nearest to a time [s].
    Time(f64),
    /// First and last index, inclusive, and step.
    Range(usize, usize, usize),
}

/// Clipping range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Clipped part; `None` for all.
    pub part: Option<Part>,
    /// Axis, from 0.
    pub axis: usize,
    /// Kept range [m].
    pub range: [f64; 2],
}

/// Options of a picture.
#[derive(Clone, Debug)]
pub struct Options {
    /// Results directory.
    pub dir: PathBuf,
    /// Output file.
    pub out: Option<PathBuf>,
    /// Whether to replace an existing file.
    pub force: bool,
    /// Frames.
    pub frames: Option<Frames>,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Additional parts.
    pub show: Vec<Part>,
    /// Hidden parts.
    pub hide: Vec<Part>,
    /// Fields by part.
    pub fields: Vec<(Option<Part>, String)>,
    /// Colour limits by part.
    pub ranges: Vec<(Option<Part>, [f64; 2])>,
    /// Colour maps by part.
    pub maps: Vec<(Option<Part>, String)>,
    /// Opacities by part.
    pub opacities: Vec<(Option<Part>, f32)>,
    /// Direction to the eye.
    pub towards: Option<V3>,
    /// Perspective projection.
    pub perspective: Option<bool>,
    /// Magnification.
    pub zoom: f32,
    /// Grains with a part of the solid below.
    pub near_grains: bool,
    /// Background colour.
    pub background: Colour,
    /// Clipping ranges.
    pub clips: Vec<Clip>,
    /// Displacement factor of the solid.
    pub deform: f64,
    /// Reference frame of displacements and solid fields.
    pub since: Option<usize>,
    /// Colour steps of the solid; 0 for continuous.
    pub bands: usize,
    /// Least chain force over the largest.
    pub min_force: f64,
    /// Thickness factor of chains.
    pub thickness: f64,
    /// Video frame rate [1/s].
    pub rate: f64,
}

/// Creates an error: option, found, expected.
pub fn refuse(option: &str, found: &str, expected: &str) -> Failure {
    Failure::Input(format!("--{option}: found {found}, expected {expected}"))
}

/// Joins names for a message.
pub fn joined<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().collect::<Vec<_>>().join(", ")
}

fn part(option: &str, name: &str, count: usize) -> Result<Part, Failure> {
    let known = PARTS.iter().take(count).find(|(_, n)| *n == name);
    let names = || format!("one of {}", joined(PARTS.iter().take(count).map(|p| p.1)));
    known.map(|p| p.0).ok_or_else(|| refuse(option, &format!("\"{name}\""), &names()))
}

/// Parses comma-separated parts.
pub fn parts(option: &str, words: &[String]) -> Result<Vec<Part>, Failure> {
    let all = words.iter().flat_map(|w| w.split(',')).map(str::trim).filter(|w| !w.is_empty());
    all.map(|name| part(option, name, PARTS.len())).collect()
}

/// Parses `PART=VALUE`, or a value for all parts.
pub fn of_part(option: &str, word: &str) -> Result<(Option<Part>, String), Failure> {
    match word.split_once('=') {
        Some((name, value)) => Ok((Some(part(option, name.trim(), BODIES)?), value.trim().to_string())),
        None => Ok((None, word.trim().to_string())),
    }
}

/// Parses a finite number.
pub fn number(option: &str, text: &str, expected: &str) -> Result<f64, Failure> {
    let parsed = text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    parsed.ok_or_else(|| refuse(option, &format!("\"{text}\""), expected))
}

fn range(option: &str, text: &str, open: Option<f64>) -> Result<[f64; 2], Failure> {
    let expected = if open.is_some() { "LOW:HIGH, either of which may be left out" } else { "LOW:HIGH" };
    let wrong = || refuse(option, &format!("\"{text}\""), expected);
    let (low, high) = text.split_once(':').ok_or_else(wrong)?;
    let end = |word: &str, sign: f64| match (word.trim(), open) {
        ("", Some(open)) => Ok(sign * open),
        (word, _) => number(option, word, expected),
    };
    let ends = [end(low, -1.0)?, end(high, 1.0)?];
    if ends[0] < ends[1] { Ok(ends) } else { Err(refuse(option, &format!("\"{text}\""), "LOW below HIGH")) }
}

/// Parses colour limits.
pub fn limits(option: &str, text: &str) -> Result<[f64; 2], Failure> {
    range(option, text, None)
}

/// Parses `[PART:]AXIS=LOW:HIGH`.
pub fn clip(word: &str) -> Result<Clip, Failure> {
    let expected = "[PART:]AXIS=LOW:HIGH with an axis x, y or z, such as x=-1:1 or grains:y=0:";
    let wrong = || refuse("clip", &format!("\"{word}\""), expected);
    let (head, ends) = word.split_once('=').ok_or_else(wrong)?;
    let (of, axis) = match head.split_once(':') {
        Some((name, axis)) => (Some(part("clip", name.trim(), BODIES)?), axis),
        None => (None, head),
    };
    let axis = ["x", "y", "z"].iter().position(|a| *a == axis.trim()).ok_or_else(wrong)?;
    Ok(Clip { part: of, axis, range: range("clip", ends, Some(1e30))? })
}

/// Parses frames: index, time with unit, word, range.
pub fn frames(word: &str) -> Result<Frames, Failure> {
    let expected = "a number from 0, a time such as 0.5s, last, peak, all, or A:B or A:B:STEP for a video";
    let wrong = || refuse("frame", &format!("\"{word}\""), expected);
    let whole = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
    match word.trim() {
        "last" => Ok(Frames::Last),
        "peak" => Ok(Frames::Peak),
        "all" => Ok(Frames::Range(0, usize::MAX, 1)),
        text if text.contains(':') => {
            let ends: Vec<&str> = text.split(':').collect();
            let step = ends.get(2).map_or(Ok(1), |s| whole(s))?;
            let open = |text: &str, open| if text.trim().is_empty() { Ok(open) } else { whole(text) };
            let (from, to) = (open(ends[0], 0)?, open(ends[1], usize::MAX)?);
            if ends.len() > 3 || step == 0 || from > to {
                return Err(wrong());
            }
            Ok(Frames::Range(from, to, step))
        }
        text => match text.strip_suffix("ms").map(|t| (t, 1e-3)).or(text.strip_suffix('s').map(|t| (t, 1.0)))
        {
            Some((time, unit)) => Ok(Frames::Time(unit * number("frame", time, expected)?)),
            None => whole(text).map(Frames::Number),
        },
    }
}

/// Parses columns and rows: `1280x720`.
pub fn size(word: &str) -> Result<[usize; 2], Failure> {
    let expected = format!("WIDTHxHEIGHT, {SMALLEST} to {LARGEST} pixels each and at most {MOST} together");
    let wrong = || refuse("size", &format!("\"{word}\""), &expected);
    let (wide, high) = word.split_once(['x', '×']).ok_or_else(wrong)?;
    let side = |text: &str| text.trim().parse::<usize>().ok().filter(|n| (SMALLEST..=LARGEST).contains(n));
    match (side(wide), side(high)) {
        (Some(w), Some(h)) if w * h <= MOST => Ok([w, h]),
        _ => Err(wrong()),
    }
}

/// Parses a view direction: name, or azimuth from x towards y and elevation [degrees].
pub fn towards(word: &str) -> Result<V3, Failure> {
    if let Some((_, side)) = SIDES.iter().find(|(name, _)| *name == word) {
        return Ok(V3::from(*side));
    }
    let expected = format!(
        "one of {}, or AZIMUTH:ELEVATION in degrees, such as -60:30",
        joined(SIDES.iter().map(|s| s.0))
    );
    let wrong = || refuse("view", &format!("\"{word}\""), &expected);
    let (azimuth, elevation) = word.split_once(':').ok_or_else(wrong)?;
    let [a, e] = [number("view", azimuth, &expected)?, number("view", elevation, &expected)?];
    if !(-90.0..=90.0).contains(&e) || a.abs() > 360.0 {
        return Err(wrong());
    }
    let (a, e) = (a.to_radians(), e.to_radians());
    let direction = [libm::cos(e) * libm::cos(a), libm::cos(e) * libm::sin(a), libm::sin(e)];
    Ok(V3::from(direction.map(|v| v as f32)))
}

/// Returns the default direction for 3D scenes.
pub fn oblique() -> V3 {
    V3::from(SIDES[0].1)
}

/// Parses a background: word or colour.
pub fn background(word: &str) -> Result<Colour, Failure> {
    let known = match word {
        "white" => Some([1.0; 3]),
        "dark" => colours::parse("1f2730"),
        _ => colours::parse(word),
    };
    known.ok_or_else(|| {
        refuse("background", &format!("\"{word}\""), "white, dark or a colour such as #e8edf2")
    })
}

/// Checks a map name.
pub fn map(name: &str) -> Result<(), Failure> {
    let expected = || format!("one of {}", joined(colours::maps()));
    match colours::maps().any(|m| m == name) {
        true => Ok(()),
        false => Err(refuse("colour-map", &format!("\"{name}\""), &expected())),
    }
}

impl Options {
    /// Returns the default options for a results directory.
    pub fn new(dir: &Path) -> Options {
        Options {
            dir: dir.to_path_buf(),
            out: None,
            force: false,
            frames: None,
            size: [1280, 720],
            show: Vec::new(),
            hide: Vec::new(),
            fields: Vec::new(),
            ranges: Vec::new(),
            maps: Vec::new(),
            opacities: Vec::new(),
            towards: None,
            perspective: None,
            zoom: 1.0,
            near_grains: false,
            background: [1.0; 3],
            clips: Vec::new(),
            deform: 1.0,
            since: None,
            bands: 0,
            min_force: 0.0,
            thickness: 1.0,
            rate: 10.0,
        }
    }

    /// Returns the last choice.
    pub fn of<T: Clone>(list: &[(Option<Part>, T)], part: Part) -> Option<T> {
        list.iter().rev().find(|(of, _)| of.is_none_or(|of| of == part)).map(|(_, value)| value.clone())
    }

    /// Returns the clipping ranges of a part.
    pub fn clips_of(&self, part: Part) -> impl Iterator<Item = &Clip> {
        self.clips.iter().filter(move |c| c.part.is_none_or(|of| of == part))
    }

    /// Whether a part is shown, by default `normally`.
    pub fn shows(&self, part: Part, normally: bool) -> bool {
        !self.hide.contains(&part) && (normally || self.show.contains(&part))
    }
}
