//! Python module: runs, checks, stepwise simulations.

mod errors;
mod link;
mod run;
mod scene;
mod simulation;

use pyo3::prelude::*;
use std::ffi::OsString;

/// The compiled part of the package; use `trackbed`.
#[pymodule]
fn _trackbed(m: &Bound<'_, PyModule>) -> PyResult<()> {
    trackbed::guard::install();
    // Studies start separate processes.
    let python: String = m.py().import("sys")?.getattr("executable")?.extract()?;
    trackbed::program::started_by([python, "-m".into(), "trackbed".into()].map(OsString::from).to_vec());
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add("NumericalError", m.py().get_type::<errors::NumericalError>())?;
    m.add_class::<simulation::Simulation>()?;
    m.add_function(wrap_pyfunction!(run::run, m)?)?;
    m.add_function(wrap_pyfunction!(run::check, m)?)?;
    m.add_function(wrap_pyfunction!(run::explain, m)?)?;
    m.add_function(wrap_pyfunction!(run::schema, m)?)?;
    m.add_function(wrap_pyfunction!(scene::read, m)?)?;
    m.add_function(wrap_pyfunction!(command, m)?)
}

/// Carries out a command line, given without the name of the program, as the program does; its exit code.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<String>) -> u8 {
    py.detach(|| {
        use clap::Parser;
        use trackbed::failure::Failure;
        use trackbed::{cli, commands, guard, message};
        let command = words.first().cloned().unwrap_or_default();
        let words = std::iter::once("trackbed".to_string()).chain(words);
        let cli = match cli::Cli::try_parse_from(words) {
            Ok(cli) => cli,
            Err(error) => {
                if let Some(failure) = cli::replaced_option(&error, &command) {
                    message::error(&failure.to_string());
                    return failure.code();
                }
                // Output may be closed.
                let _ = error.print();
                return u8::try_from(error.exit_code()).unwrap_or(2);
            }
        };
        match guard::guarded(|| commands::execute(cli.command)) {
            Ok(()) => 0,
            Err(failure) => {
                match failure {
                    Failure::Interrupted(_) => message::say(&failure.to_string()),
                    _ => failure.sentences().iter().for_each(|sentence| message::error(sentence)),
                }
                failure.code()
            }
        }
    })
}
