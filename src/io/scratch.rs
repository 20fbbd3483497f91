//! Temporary folders of tests.

use std::path::PathBuf;

/// Creates an empty temporary folder of this process.
///
/// # Panics
///
/// On I/O errors.
pub fn folder(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("trackbed_{}_{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).expect("the temporary directory can be written");
    dir
}
