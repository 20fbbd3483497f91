//! Report of runs, from results directories only.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

mod data;
pub mod page;
pub mod plot;
mod quantity;
mod sections;

pub use data::RunData;
use maud::Markup;
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::write::{WriteError, atomic};

/// Report options.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Results directories.
    pub folders: Vec<PathBuf>,
    /// Output file; default `report.html` in the directory.
    pub out: Option<PathBuf>,
    /// Page title; default: scene title.
    pub title: Option<String>,
    /// Axle load of a cycle [t], for settlement against traffic.
    pub axle_load: Option<f64>,
    /// Overwrite files other than reports.
    pub force: bool,
}

/// Text of every report.
const MARK: &str = "; report by trackbed ";

/// Writes a report and returns its path.
///
/// # Errors
/// Input and I/O errors.
pub fn write(options: &Options) -> Result<PathBuf, Failure> {
    if let Some(load) = options.axle_load.filter(|t| !(*t > 0.0 && *t <= 100.0)) {
        return Err(Failure::Input(format!("--axle-load: found {load}, expected above 0, at most 100 t")));
    }
    let out = output_file(options)?;
    let mut runs = options.folders.iter().map(|dir| RunData::read(dir)).collect::<Result<Vec<_>, _>>()?;
    data::distinguish(&mut runs);
    let title = options.title.clone().unwrap_or_else(|| title(&runs));
    let whose = match runs.as_slice() {
        [run] => results_in(&run.dir),
        _ => "Results of several runs".into(),
    };
    save(&out, &title, &whose, &sections::all(&runs, options.axle_load))?;
    Ok(out)
}

/// Returns the output file, if it may be written.
///
/// # Errors
/// Missing or invalid `--out`, an existing file that is no report.
pub fn output_file(options: &Options) -> Result<PathBuf, Failure> {
    let out = match (&options.out, options.folders.as_slice()) {
        (Some(out), _) => out.clone(),
        (None, [dir]) => dir.join("report.html"),
        (None, _) => {
            let expected = "a file such as report.html for several directories";
            return Err(Failure::Input(format!("--out: found nothing, expected {expected}")));
        }
    };
    let ending = out.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if !matches!(ending.as_deref(), Some("html" | "htm")) {
        let found = out.display();
        return Err(Failure::Input(format!("--out: found {found}, expected a file .html")));
    }
    if out.is_dir() {
        let found = out.display();
        return Err(Failure::Input(format!("--out: found the directory {found}, expected a file")));
    }
    if out.exists() && !options.force && !is_report(&out) {
        let found = out.display();
        let expected = "a new file, a report, or --force to overwrite it";
        return Err(Failure::Input(format!("{found}: found an existing file, expected {expected}")));
    }
    Ok(out)
}

/// Returns the origin of the results of a directory.
pub fn results_in(dir: &Path) -> String {
    format!("Results in {}", page::shown_path(dir).display())
}

/// Writes a page of `sections`; `whose`: origin of the results.
///
/// # Errors
/// I/O errors.
pub fn save(out: &Path, title: &str, whose: &str, sections: &[page::Section]) -> Result<(), Failure> {
    put(out, &page::page(title, &head(whose), sections))
}

fn is_report(file: &Path) -> bool {
    let text = source::text(file).unwrap_or_default();
    text.lines().any(|line| line.contains("<p class=\"note\">Results ") && line.contains(MARK))
}

fn put(out: &Path, text: &str) -> Result<(), Failure> {
    atomic::write(out, |file| file.write_all(text.as_bytes()).map_err(WriteError::io(out)))?;
    Ok(())
}

fn title(runs: &[RunData]) -> String {
    let first = runs[0].title();
    match (runs.len(), runs.iter().all(|r| r.title() == first)) {
        (1, _) => first.into(),
        (n, true) => format!("{first}: {n} runs"),
        (n, false) => format!("Comparison of {n} runs"),
    }
}

fn head(whose: &str) -> Markup {
    let version = env!("CARGO_PKG_VERSION");
    page::paragraph(&format!(
        "{whose}{MARK}{version}. Hover over a value to see it in SI units, as in the files."
    ))
}
