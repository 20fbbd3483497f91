//! Atomic replacement of files: `NAME.part` is flushed to disk, then renamed.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::WriteError;

/// Writes `file` by `fill`; on errors the previous file stays.
///
/// # Errors
/// I/O errors, and errors of `fill`.
pub fn write(
    file: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    write_in_places(file, |out| fill(out))
}

/// As [`write`]; `fill` may seek and has other error types.
///
/// # Errors
/// As [`write`].
pub fn write_in_places<E: From<WriteError>>(
    file: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let part = part_name(file);
    let result = write_part(file, &part, fill)
        .and_then(|()| fs::rename(&part, file).map_err(|error| WriteError::io(file)(error).into()));
    if result.is_err() {
        // The part file may not exist.
        let _ = fs::remove_file(&part);
    }
    result
}

fn write_part<E: From<WriteError>>(
    file: &Path,
    part: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let raw = File::create(part).map_err(WriteError::io(file))?;
    let mut out = BufWriter::with_capacity(1 << 16, raw);
    fill(&mut out)?;
    let raw = out.into_inner().map_err(|error| WriteError::io(file)(error.into_error()))?;
    Ok(raw.sync_data().map_err(WriteError::io(file))?)
}

fn part_name(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".part");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample::folder;

    #[test]
    fn failed_write_keeps_old_file() {
        let dir = folder("atomic");
        let file = dir.join("a.txt");
        let text = |text: &'static str| {
            let at = file.clone();
            move |out: &mut dyn Write| out.write_all(text.as_bytes()).map_err(WriteError::io(&at))
        };
        write(&file, text("one")).unwrap();
        let error = write(&file, |out| {
            text("half")(out)?;
            Err(WriteError::format(&file, "enough"))
        });
        assert_eq!(error.unwrap_err().to_string(), format!("{}: enough", file.display()));
        assert_eq!(fs::read_to_string(&file).unwrap(), "one");
        assert_eq!(fs::read_dir(&dir).unwrap().count(), 1, "no part is left");
        write(&file, text("two")).unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "two");
        assert_eq!(fs::read_dir(&dir).unwrap().count(), 1);
        fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn a_missing_folder_is_named() {
        let dir = folder("atomic_missing");
        let file = dir.join("no/such/a.txt");
        let error = write(&file, |_| Ok(())).unwrap_err();
        assert!(error.to_string().starts_with(&format!("{}: cannot be written", file.display())), "{error}");
        fs::remove_dir_all(&dir).unwrap();
    }
}
