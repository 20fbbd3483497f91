//! The folder of a run's results: made, and cleared of what an earlier run left there.

use crate::failure::Failure;
use crate::model::OutputPlan;
use crate::write::{FORMATS, Format};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// What a run may leave beside the files of its formats.
const FILES: [&str; 25] = [
    "push.csv",
    "breaks.csv",
    "summary.json",
    "log.txt",
    "history.csv",
    "cycles.csv",
    "nodes.csv",
    "gauss.csv",
    "safety.csv",
    "settlement.svg",
    "sleeper.svg",
    "gradation.csv",
    "gradation.svg",
    "radial.csv",
    "packing.csv",
    "run.json",
    "end.state",
    "report.html",
    "runout.vti",
    "runout.png",
    "outline.csv",
    "fragments.csv",
    "origins.csv",
    "events.csv",
    "specimen.svg",
];

/// All files of known names.
fn files() -> impl Iterator<Item = &'static str> {
    FILES.into_iter().chain(FORMATS.iter().flat_map(|format| format.files).copied())
}

fn failure(dir: &Path) -> impl Fn(io::Error) -> Failure + '_ {
    move |error| Failure::Other(format!("{}: {error}", dir.display()))
}

/// The packing of one of several groups.
fn of_a_group(path: &Path) -> bool {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let number = name.strip_prefix("packing_").and_then(|rest| rest.strip_suffix(".csv"));
    number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

/// Removes the files of a folder that `unwanted` names; a folder that is not there has none.
fn remove(folder: &Path, unwanted: impl Fn(&Path) -> bool) -> io::Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if unwanted(&path) && path.is_file() {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}

/// A file of a folder that has the name of a result, if there is one.
pub fn first_result(dir: &Path) -> Option<PathBuf> {
    let named = files().map(|name| dir.join(name)).find(|file| file.exists());
    let found = |folder: &Path, ours: &dyn Fn(&Path) -> bool| {
        let entries = fs::read_dir(folder).ok()?;
        let mut found: Vec<PathBuf> =
            entries.filter_map(|e| Some(e.ok()?.path())).filter(|f| ours(f)).collect();
        found.sort();
        found.into_iter().next()
    };
    let frame = |format: &Format| found(&dir.join(format.folder), &|file| format.is_frame(file));
    named.or_else(|| found(dir, &of_a_group)).or_else(|| FORMATS.iter().find_map(|format| frame(format)))
}

/// Makes the folders of the frames of a run.
fn make(dir: &Path, output: &OutputPlan) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    output.formats.iter().try_for_each(|format| fs::create_dir_all(dir.join(format.folder)))
}

/// Makes the folder of the results; what an earlier run left there is removed, so that no result of another run is
/// taken for one of this. Files that are not of this program stay.
///
/// # Errors
/// The folder cannot be made or cleaned.
pub fn prepare(dir: &Path, output: &OutputPlan) -> Result<(), Failure> {
    let fail = failure(dir);
    // Only in a folder of results: a user's own `nodes.csv` elsewhere is not ours to remove.
    if dir.join("summary.json").is_file() {
        for file in files().map(|name| dir.join(name)).filter(|file| file.is_file()) {
            fs::remove_file(file).map_err(&fail)?;
        }
        remove(dir, of_a_group).map_err(&fail)?;
    }
    for format in FORMATS {
        remove(&dir.join(format.folder), |file| format.is_frame(file)).map_err(&fail)?;
    }
    make(dir, output).and_then(|()| remove_halves(dir)).map_err(&fail)
}

/// Makes the folder of the results ready for a run that goes on there: files that a stopped program left half-written go.
///
/// # Errors
/// The folder cannot be made or cleaned.
pub fn resume(dir: &Path, output: &OutputPlan) -> Result<(), Failure> {
    make(dir, output).and_then(|()| remove_halves(dir)).map_err(failure(dir))
}

/// Removes files that a stopped program left half-written.
fn remove_halves(dir: &Path) -> io::Result<()> {
    let halves = files().map(|name| PathBuf::from(format!("{name}.part"))).collect::<Vec<_>>();
    let half =
        |file: &Path| file.file_name().is_some_and(|name| halves.iter().any(|h| h.as_os_str() == name));
    remove(dir, half)?;
    for format in FORMATS {
        let part = |file: &Path| file.extension().is_some_and(|ending| ending == "part");
        remove(&dir.join(format.folder), |file| half(file) || format.is_frame(file) && part(file))?;
    }
    Ok(())
}

/// Removes the frames from number `next` on, which the run that goes on writes again.
///
/// # Errors
/// The folder cannot be cleaned.
pub fn remove_later_frames(dir: &Path, next: usize) -> Result<(), Failure> {
    let later = |file: &Path, format: &Format| {
        let number = file.file_stem().and_then(|s| s.to_str()).and_then(|s| s.rsplit_once('_'));
        let number = number.and_then(|(_, n)| n.parse::<usize>().ok());
        format.is_frame(file) && number.is_some_and(|n| n >= next)
    };
    for format in FORMATS {
        remove(&dir.join(format.folder), |file| later(file, format)).map_err(failure(dir))?;
    }
    Ok(())
}
