//! Results directory: created, and cleared of earlier results.

use std::path::{Path, PathBuf};
use std::{fs, io};
use trackbed_input::model::OutputPlan;
use trackbed_io::failure::Failure;
use trackbed_io::write::{FORMATS, Format};

const FILES: [&str; 26] = [
    "push.csv",
    "breaks.csv",
    "summary.json",
    "log.txt",
    "sources.bib",
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

fn files() -> impl Iterator<Item = &'static str> {
    FILES.into_iter().chain(FORMATS.iter().flat_map(|format| format.files).copied())
}

fn failure(dir: &Path) -> impl Fn(io::Error) -> Failure + '_ {
    move |error| Failure::Other(format!("{}: {error}", dir.display()))
}

fn of_a_group(path: &Path) -> bool {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let number = name.strip_prefix("packing_").and_then(|rest| rest.strip_suffix(".csv"));
    number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

/// A missing directory is empty.
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

/// Returns an existing result file, if any.
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

fn make(dir: &Path, output: &OutputPlan) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    output.formats.iter().try_for_each(|format| fs::create_dir_all(dir.join(format.folder)))
}

/// Creates the results directory and removes earlier results only.
///
/// # Errors
/// I/O errors.
pub fn prepare(dir: &Path, output: &OutputPlan) -> Result<(), Failure> {
    let fail = failure(dir);
    // Elsewhere `nodes.csv` may be a user file.
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

/// Removes partial files before resuming.
///
/// # Errors
/// I/O errors.
pub fn resume(dir: &Path, output: &OutputPlan) -> Result<(), Failure> {
    make(dir, output).and_then(|()| remove_halves(dir)).map_err(failure(dir))
}

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

/// Removes frames from `next` on.
///
/// # Errors
/// I/O errors.
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
