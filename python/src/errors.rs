//! Failures as Python exceptions.

use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use trackbed::failure::Failure;

create_exception!(
    trackbed,
    NumericalError,
    PyRuntimeError,
    "A run that has failed numerically: what, where, when, and where its last checkpoint is."
);

/// Converts a failure with its sentences.
pub fn raised(failure: &Failure) -> PyErr {
    let text = failure.sentences().join("\n");
    match failure {
        Failure::Input(_) | Failure::Faults(_) => PyValueError::new_err(text),
        Failure::Numerical(_) => NumericalError::new_err(text),
        Failure::Interrupted(_) => PyKeyboardInterrupt::new_err(text),
        Failure::Other(_) => PyOSError::new_err(text),
    }
}
