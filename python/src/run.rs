//! Whole runs, checks, estimates.

use crate::errors::raised;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use trackbed::commands::{check as checking, explain as explaining};
use trackbed::failure::Failure;
use trackbed::preview::Source;
use trackbed::run::{self as running, Interrupt, Options, Outcome, Verbosity};
use trackbed::scene;

const LOOK: Duration = Duration::from_millis(50);

/// Converts Python arguments to run options.
#[expect(clippy::too_many_arguments, reason = "one for each option of the program")]
pub fn options(
    text: Option<String>,
    out: Option<PathBuf>,
    set: Vec<String>,
    threads: Option<usize>,
    memory: Option<&str>,
    resume: bool,
    from_run: Option<PathBuf>,
    bed: bool,
    force: bool,
    strict: bool,
    progress: bool,
) -> PyResult<Options> {
    let size = |text: &str| {
        running::parse_size(text).ok_or_else(|| {
            let expected = "a size above 0 such as 800MB or 8GB";
            raised(&Failure::Input(format!("memory: found {text}, expected {expected}")))
        })
    };
    Ok(Options {
        text,
        out,
        threads,
        set,
        memory: memory.map(size).transpose()?,
        resume,
        from: from_run,
        bed,
        force,
        strict,
        verbosity: if progress { Verbosity::default() } else { Verbosity::Quiet },
        ..Options::default()
    })
}

/// Returns the results directory.
///
/// # Errors
/// Failures of the run.
pub fn folder(outcome: Result<Outcome, Failure>) -> PyResult<PathBuf> {
    match outcome {
        Ok(Outcome::Done(summary)) => Ok(summary.dir.clone()),
        Ok(Outcome::WasDone(dir)) => Ok(dir),
        Err(failure) => Err(raised(&failure)),
    }
}

/// Receiver usable without the interpreter.
pub type Reports<T> = Mutex<Receiver<T>>;

/// Waits for a report without the interpreter lock. Signals raise `request`; their exception is returned with
/// the report.
///
/// # Errors
/// Thread ended without a report.
pub fn wait<T: Send>(
    py: Python<'_>,
    reports: &Reports<T>,
    request: impl Fn(),
) -> PyResult<(T, Option<PyErr>)> {
    let mut signal = None;
    loop {
        let report = py.detach(|| {
            let reports = reports.lock().unwrap_or_else(PoisonError::into_inner);
            reports.recv_timeout(LOOK)
        });
        match report {
            Ok(report) => return Ok((report, signal)),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(raised(&Failure::Other("the run has ended without a report".into())));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = py.check_signals() {
                    request();
                    signal = Some(error);
                }
            }
        }
    }
}

/// Runs a scene; the folder of its results.
#[pyfunction]
#[pyo3(signature = (scene, text, out, set, threads, memory, resume, from_run, bed, force, strict, progress))]
#[expect(clippy::too_many_arguments, reason = "one for each option of the program")]
pub fn run(
    py: Python<'_>,
    scene: PathBuf,
    text: Option<String>,
    out: Option<PathBuf>,
    set: Vec<String>,
    threads: Option<usize>,
    memory: Option<&str>,
    resume: bool,
    from_run: Option<PathBuf>,
    bed: bool,
    force: bool,
    strict: bool,
    progress: bool,
) -> PyResult<PathBuf> {
    let options = options(text, out, set, threads, memory, resume, from_run, bed, force, strict, progress)?;
    let interrupt: Interrupt = options.interrupt.clone();
    let (send, reports) = mpsc::channel();
    let worker = thread::spawn(move || {
        let outcome = trackbed::guard::guarded(|| running::run(&scene, &options));
        // The receiver waits for this.
        let _ = send.send(outcome);
    });
    let (outcome, signal) = wait(py, &Mutex::new(reports), || interrupt.request())?;
    // It has reported and ends.
    let _ = worker.join();
    // Ctrl-C is raised although the run completed.
    folder(outcome).and_then(|dir| signal.map_or(Ok(dir), Err))
}

/// What `trackbed check --json` prints.
#[pyfunction]
#[pyo3(signature = (scene, text, set, strict))]
pub fn check(
    py: Python<'_>,
    scene: PathBuf,
    text: Option<String>,
    set: Vec<String>,
    strict: bool,
) -> PyResult<String> {
    let source = Source { file: scene, text, set };
    let report = py.detach(|| checking::check(&source, None, strict));
    report.map(|report| report.json()).map_err(|failure| raised(&failure))
}

/// What `trackbed explain --json` prints.
#[pyfunction]
#[pyo3(signature = (scene, text, set, threads, trial))]
pub fn explain(
    py: Python<'_>,
    scene: PathBuf,
    text: Option<String>,
    set: Vec<String>,
    threads: Option<usize>,
    trial: f64,
) -> PyResult<String> {
    let how = explaining::How { memory: None, strict: false, threads, trial };
    let source = Source { file: scene, text, set };
    let report = py.detach(|| explaining::explain(&source, &how));
    report.map(|report| report.json()).map_err(|failure| raised(&failure))
}

/// JSON schema of scenes.
#[pyfunction]
pub fn schema() -> String {
    format!("{:#}", scene::schema::schema())
}
