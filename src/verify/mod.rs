//! Verification matrix: cases with a reference, computed by this program and by others.
//!
//! A `file` is resolved to a `plan`; `ours` and `peers` compute its columns.

mod cell;
mod file;
mod matrix;
mod ours;
mod page;
mod peers;
mod plan;
mod plot;
mod text;

use file::MatrixFile;
use matrix::Matrix;
pub use ours::Place;
use plan::Plan;
use std::path::{Path, PathBuf};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::write::{WriteError, atomic};
use trackbed_run::Lock;

/// Options of a verification.
#[derive(Clone, Debug)]
pub struct Options {
    /// Matrix file.
    pub matrix: PathBuf,
    /// Results directory.
    pub out: PathBuf,
    /// Names of rows or groups; all if empty.
    pub only: Vec<String>,
    /// Where rows are computed besides the CPU.
    pub places: Vec<Place>,
    /// Python interpreter of the other programs; none: without them.
    pub python: Option<PathBuf>,
    /// Page whose tables are renewed.
    pub page: Option<PathBuf>,
    /// Print errors only.
    pub quiet: bool,
}

/// Result of a verification.
#[derive(Debug)]
pub struct Finished {
    /// Table for the terminal.
    pub text: String,
    /// Own rows that fail.
    pub failure: Option<Failure>,
}

/// Computes the matrix and writes `verify.json`, `verify.md` and `verify.svg`.
///
/// # Errors
/// Input and I/O errors.
pub fn execute(options: &Options) -> Result<Finished, Failure> {
    let document = Document::open(&options.matrix)?;
    let mut plan = Plan::new(&document, &document.read::<MatrixFile>()?)?;
    plan.keep(&options.only)?;
    let dir = &options.out;
    let _lock = Lock::take(dir)?;
    let mut columns = vec![ours::column(&plan.rows, Place::Cpu, &dir.join("runs"), options.quiet)?];
    for (k, place) in options.places.iter().enumerate() {
        let folder = dir.join(format!("runs-{}", k + 2));
        columns.push(ours::column(&plan.rows, *place, &folder, options.quiet)?);
    }
    let python = options.python.as_deref();
    columns.extend(
        plan.peers.iter().map(|peer| peers::column(peer, (&options.matrix, &plan.rows), python, dir)),
    );
    let matrix = Matrix { plan, columns };
    write(&dir.join("verify.json"), &format!("{:#}\n", matrix.json()))?;
    write(&dir.join("verify.md"), &text::page(&matrix))?;
    let plot = plot::errors(&matrix);
    plot.write(&dir.join("verify.svg"))?;
    if let Some(page) = &options.page {
        renew(&matrix, page)?;
        plot.write(&page.with_extension("svg"))?;
    }
    let text = format!("{}results are in {}\n", text::printed(&matrix), dir.display());
    Ok(Finished { text, failure: failure(&matrix) })
}

fn renew(matrix: &Matrix, page: &Path) -> Result<(), Failure> {
    let text = source::text(page).map_err(|refusal| Failure::Input(refusal.sentence(page)))?;
    let text = page::fill(matrix, &text).map_err(|page::BadMark { line, name }| {
        let expected = "groups of the matrix, `programs` or `differences`";
        Failure::Input(format!("{}:{line}: verify: found {name}, expected {expected}", page.display()))
    })?;
    write(page, &text)
}

fn write(file: &Path, text: &str) -> Result<(), Failure> {
    atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))?;
    Ok(())
}

fn failure(matrix: &Matrix) -> Option<Failure> {
    let failed: Vec<&str> = matrix.failed().iter().map(|row| row.table.name.as_str()).collect();
    let (count, all) = (failed.len(), matrix.plan.rows.len());
    (count > 0).then(|| {
        Failure::Numerical(format!(
            "{count} of {all} rows beyond their tolerance or failed: {}",
            failed.join(", ")
        ))
    })
}
