//! Bounded reading of whole regular files.

use std::fs::{self, File};
use std::io::{self, Read, Take};
use std::path::Path;

use crate::system;

/// Largest file of a scene, stone library or table [bytes].
pub const LARGEST_TEXT: u64 = 64 << 20;
/// Largest file of a mesh, surface, packing or checkpoint [bytes].
pub const LARGEST: u64 = 8 << 30;
/// Inverse fraction of free memory: content needs more than the file's bytes.
const SHARE: u64 = 2;

/// Reason why a file cannot be read.
#[derive(Debug)]
pub enum Refusal {
    /// I/O error.
    System(io::Error),
    /// Not readable as a whole: found and expected.
    Unfit(String, String),
}

impl Refusal {
    /// Returns found and expected; `system` words I/O errors.
    pub fn words(self, system: impl FnOnce(io::Error) -> String) -> (String, String) {
        match self {
            Refusal::System(error) => (system(error), "a readable file".into()),
            Refusal::Unfit(found, expected) => (found, expected),
        }
    }

    /// Returns the message with the file.
    pub fn sentence(self, file: &Path) -> String {
        let (found, expected) = self.words(|e| system::words(&e));
        format!("{}: found {found}, expected {expected}", file.display())
    }
}

impl From<io::Error> for Refusal {
    fn from(error: io::Error) -> Refusal {
        Refusal::System(error)
    }
}

/// Opens a regular file of at most `most` bytes and ends reading there.
///
/// # Errors
/// I/O errors; no regular file, or too large.
pub fn open(file: &Path, most: u64) -> Result<Take<File>, Refusal> {
    // Before opening: opening a pipe blocks.
    let found = fs::metadata(file)?;
    if !found.is_file() {
        let kind = if found.is_dir() { "a directory" } else { "a device or a pipe" };
        return Err(Refusal::Unfit(kind.into(), "a regular file".into()));
    }
    if found.len() > most {
        return Err(too_large(found.len(), most, ""));
    }
    Ok(File::open(file)?.take(most + 1))
}

fn too_large(size: u64, most: u64, why: &str) -> Refusal {
    Refusal::Unfit(format!("{size} bytes"), format!("at most {most} bytes{why}"))
}

/// Bytes of a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open`]; insufficient memory.
pub fn bytes(file: &Path, most: u64) -> Result<Vec<u8>, Refusal> {
    let mut source = open(file, most)?;
    let free = system::available().map_or(most, |free| free / SHARE);
    let (least, why) = if free < most { (free, ", what the free memory allows") } else { (most, "") };
    let size = source.get_ref().metadata()?.len();
    if size > least {
        return Err(too_large(size, least, why));
    }
    let mut bytes = Vec::with_capacity(size as usize);
    source.set_limit(least + 1);
    source.read_to_end(&mut bytes)?;
    if bytes.len() as u64 > least {
        return Err(too_large(bytes.len() as u64, least, why));
    }
    Ok(bytes)
}

/// Text of at most [`LARGEST_TEXT`] bytes, without byte order mark.
///
/// # Errors
/// As [`bytes`]; not UTF-8.
pub fn text(file: &Path) -> Result<String, Refusal> {
    let not_utf8 = |_| io::Error::new(io::ErrorKind::InvalidData, "stream did not contain valid UTF-8");
    let text = String::from_utf8(bytes(file, LARGEST_TEXT)?).map_err(not_utf8)?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_string).unwrap_or(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(file: &Path, most: u64) -> String {
        let (found, expected) = bytes(file, most).unwrap_err().words(|e| e.to_string());
        format!("found {found}, expected {expected}")
    }

    #[test]
    fn rejects_irregular_or_large_files() {
        let file = std::env::temp_dir().join(format!("trackbed-source-{}", std::process::id()));
        fs::write(&file, "12345").unwrap();
        assert_eq!(bytes(&file, 5).unwrap(), b"12345");
        assert_eq!(refused(&file, 4), "found 5 bytes, expected at most 4 bytes");
        assert_eq!(refused(&std::env::temp_dir(), 4), "found a directory, expected a regular file");
        fs::remove_file(&file).unwrap();
        assert!(refused(&file, 4).ends_with(", expected a readable file"));
        if cfg!(target_os = "linux") {
            let device = refused(Path::new("/dev/zero"), LARGEST);
            assert_eq!(device, "found a device or a pipe, expected a regular file");
            assert_eq!(
                refused(Path::new("/proc/self/status"), 10),
                "found 11 bytes, expected at most 10 bytes"
            );
        }
    }
}
