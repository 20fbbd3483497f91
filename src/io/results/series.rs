//! Frames of a results directory, from `results.pvd`.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;
use crate::read::xml::tags;

/// File name of the list.
pub const SERIES: &str = "results.pvd";

const DEEPEST: usize = 4;
const MOST_FOLDERS: usize = 2000;

/// Part of a frame, numbered as in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Solid (`.vtu`).
    Solid = 0,
    /// Grains, one point per sphere.
    Grains = 1,
    /// Contact lines.
    Chains = 2,
    /// Walls, sleepers, rails.
    Walls = 3,
}

/// Parts with their names in URLs.
pub const PARTS: [(Part, &str); 4] =
    [(Part::Solid, "solid"), (Part::Grains, "grains"), (Part::Chains, "chains"), (Part::Walls, "walls")];

/// Files of a frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Simulated time [s].
    pub time: f64,
    files: [Option<PathBuf>; 4],
}

impl Frame {
    /// Returns the file of a part, if present.
    pub fn file(&self, part: Part) -> Option<&Path> {
        self.files[part as usize].as_deref()
    }
}

/// Reads the list; missing files are skipped.
///
/// # Errors
/// No list, no existing file, files outside the directory.
pub fn read(dir: &Path) -> Result<Vec<Frame>, Failure> {
    let list = dir.join(SERIES);
    let fault = |found: &str, expected: &str| {
        Failure::Input(format!("{}: found {found}, expected {expected}", list.display()))
    };
    let root = dir.canonicalize()?;
    let absent = || fault("no such file", "the list of frames of a run");
    let bytes = fs::read(inside(&root, SERIES)?.ok_or_else(absent)?).map_err(|error| {
        fault(&format!("that it cannot be read ({error})"), "the list of frames of a run")
    })?;
    let mut frames: Vec<Frame> = Vec::new();
    for tag in tags(&bytes).filter(|tag| tag.name == "DataSet") {
        let time = tag.attribute("timestep").and_then(|t| t.trim().parse::<f64>().ok());
        let time =
            time.filter(|t| t.is_finite()).ok_or_else(|| fault("a frame without a time", "a number"))?;
        let name = tag.attribute("file").unwrap_or_default();
        let part = tag.attribute("part").and_then(|p| p.trim().parse::<usize>().ok()).unwrap_or(0);
        let Some(file) = inside(&root, &name)? else { continue };
        if part >= PARTS.len() {
            continue;
        }
        let same = frames.last().is_some_and(|last| last.time == time && last.files[part].is_none());
        if !same {
            frames.push(Frame { time, ..Frame::default() });
        }
        if let Some(frame) = frames.last_mut() {
            frame.files[part] = Some(file);
        }
    }
    if frames.is_empty() {
        return Err(fault("no frame whose files are there", "one or more"));
    }
    Ok(frames)
}

/// Returns a file below the canonical `root`; `None` if missing.
///
/// # Errors
/// Paths or links that leave `root`.
pub fn inside(root: &Path, name: &str) -> Result<Option<PathBuf>, Failure> {
    let out =
        || Failure::Input(format!("{}: found \"{name}\", expected a file in the directory", root.display()));
    let relative = Path::new(name);
    if name.contains('\\') || !relative.components().all(|c| matches!(c, Component::Normal(_))) {
        return Err(out());
    }
    match root.join(relative).canonicalize() {
        Ok(path) if path.starts_with(root) => Ok(Some(path)),
        Ok(_) => Err(out()),
        Err(_) => Ok(None),
    }
}

/// Description of a run.
pub struct About {
    /// Title of the scene, else the directory name.
    pub title: String,
    /// Final status; `not finished` without a summary.
    pub status: String,
    /// Directory name.
    pub folder: String,
}

impl About {
    /// Reads the summary of a directory.
    pub fn of(dir: &Path) -> About {
        let summary: serde_json::Value = own(dir, "summary.json")
            .and_then(|file| fs::read(file).ok())
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .unwrap_or_default();
        let folder = dir.canonicalize().unwrap_or_else(|_| dir.to_path_buf());
        let folder = folder.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let text = |key: &str| summary.get(key).and_then(|v| v.as_str()).map(String::from);
        let title = text("title").unwrap_or_else(|| folder.clone());
        About { title, status: text("status").unwrap_or_else(|| "not finished".to_string()), folder }
    }
}

/// Returns a file of the directory, unless a link leads elsewhere.
pub fn own(dir: &Path, name: &str) -> Option<PathBuf> {
    let root = dir.canonicalize().ok()?;
    inside(&root, name).ok().flatten().filter(|file| file.is_file())
}

/// Lists results directories relative to `root` ("" for itself), sorted. Links are not followed.
pub fn folders(root: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![(PathBuf::new(), 0)];
    let mut looked = 0;
    while let Some((folder, depth)) = open.pop() {
        looked += 1;
        if root.join(&folder).join(SERIES).is_file() {
            let names: Vec<_> = folder.iter().map(|name| name.to_string_lossy()).collect();
            found.push(names.join("/"));
        }
        let Ok(entries) = fs::read_dir(root.join(&folder)) else { continue };
        for entry in entries.flatten() {
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if is_folder && depth < DEEPEST && looked + open.len() < MOST_FOLDERS {
                open.push((folder.join(entry.file_name()), depth + 1));
            }
        }
    }
    found.sort();
    found
}
