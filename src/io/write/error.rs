//! Errors of result files.

use std::path::{Path, PathBuf};

use crate::system;

/// Error of writing a result file.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// I/O error.
    #[error("{}: cannot be written: {}", file.display(), system::words(source))]
    Io {
        /// Path of the file.
        file: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// Non-finite result; the file is not written.
    #[error("{}: {field} at index {index} is {value}: not written", file.display())]
    NotFinite {
        /// Path of the file.
        file: PathBuf,
        /// Name of the field.
        field: String,
        /// Index of the item.
        index: usize,
        /// NaN or infinity.
        value: f64,
    },
    /// Field of wrong length.
    #[error("{}: {field} has {found} values, expected {expected}", file.display())]
    Length {
        /// Path of the file.
        file: PathBuf,
        /// Name of the field.
        field: String,
        /// Number of values given.
        found: usize,
        /// Number of values required.
        expected: usize,
    },
    /// Content not supported by the format.
    #[error("{}: {message}", file.display())]
    Format {
        /// Path of the file.
        file: PathBuf,
        /// Reason.
        message: String,
    },
}

impl WriteError {
    /// Returns a function that makes I/O errors of a file.
    pub fn io(file: &Path) -> impl FnOnce(std::io::Error) -> WriteError + '_ {
        |source| WriteError::Io { file: file.to_path_buf(), source }
    }

    /// Creates an error of a format.
    pub fn format(file: &Path, message: impl ToString) -> WriteError {
        WriteError::Format { file: file.to_path_buf(), message: message.to_string() }
    }
}

/// Checks length and finiteness of a field.
///
/// # Errors
/// Wrong length, or a value that is not finite.
pub fn check_field(
    file: &Path,
    field: &str,
    values: &[f64],
    components: usize,
    count: usize,
) -> Result<(), WriteError> {
    let (file, field) = (file.to_path_buf(), field.to_string());
    if values.len() != components * count {
        return Err(WriteError::Length { file, field, found: values.len(), expected: components * count });
    }
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(at) => Err(WriteError::NotFinite { file, field, index: at / components, value: values[at] }),
    }
}
