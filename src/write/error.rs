//! Why a result file was not written.

use std::path::{Path, PathBuf};

use crate::machine;

/// A file that could not or must not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The system refused: no space, no permission, no such folder.
    #[error("{}: cannot be written: {}", file.display(), machine::words(source))]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A result is not a number: the run is wrong, and the file is not written.
    #[error("{}: {field} at index {index} is {value}: not written", file.display())]
    NotFinite {
        /// The file.
        file: PathBuf,
        /// Name of the field.
        field: String,
        /// Index of the node, particle, contact or row.
        index: usize,
        /// The value found: NaN or an infinity.
        value: f64,
    },
    /// A field has not one value per item.
    #[error("{}: {field} has {found} values, expected {expected}", file.display())]
    Length {
        /// The file.
        file: PathBuf,
        /// Name of the field.
        field: String,
        /// Number of values given.
        found: usize,
        /// Number of values that the geometry needs.
        expected: usize,
    },
    /// The content cannot be expressed in the format.
    #[error("{}: {message}", file.display())]
    Format {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        message: String,
    },
}

impl WriteError {
    /// Wraps a system error with the file's name.
    pub(crate) fn io(file: &Path) -> impl FnOnce(std::io::Error) -> WriteError + '_ {
        |source| WriteError::Io { file: file.to_path_buf(), source }
    }

    /// Content that the format cannot hold.
    pub(crate) fn format(file: &Path, message: impl ToString) -> WriteError {
        WriteError::Format { file: file.to_path_buf(), message: message.to_string() }
    }
}

/// Refuses a field that has not `count` items of `components` finite values each.
pub(crate) fn check_field(
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
