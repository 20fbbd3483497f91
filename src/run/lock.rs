//! Lock of a results directory.
//!
//! `run.lock` contains process id and scene, under an advisory lock that ends with the process.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::{message, system};

/// File name.
pub const FILE: &str = "run.lock";
/// Other processes may be removing their locks.
const TRIES: usize = 20;

/// Locked directory.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    file: File,
    made: Vec<PathBuf>,
    /// Whether a killed run left its lock.
    pub left_behind: bool,
}

/// Whether a lock file exists, active or left behind.
pub fn is_there(dir: &Path) -> bool {
    dir.join(FILE).is_file()
}

impl Lock {
    /// Locks a directory, created if missing, removed on drop if empty.
    ///
    /// # Errors
    /// Locked by another process, no directory; I/O errors.
    pub fn take(dir: &Path) -> Result<Lock, Failure> {
        refuse_file(dir)?;
        let system = |e: io::Error| {
            let found = system::words(&e);
            Failure::Other(format!("{}: found {found}, expected a writable directory", dir.display()))
        };
        let missing = dir.ancestors().take_while(|d| !d.as_os_str().is_empty() && !d.exists());
        let mut made: Vec<PathBuf> = missing.map(PathBuf::from).collect();
        made.reverse();
        fs::create_dir_all(dir).map_err(system)?;
        let path = dir.join(FILE);
        let locked = lock(&path);
        if !matches!(locked, Ok(Some(_))) {
            remove(&made);
        }
        match locked.map_err(system)? {
            Some((file, left_behind)) => Ok(Lock { path, file, made, left_behind }),
            None => {
                let process = fs::read_to_string(&path).unwrap_or_default();
                let process = process
                    .lines()
                    .next()
                    .unwrap_or_default()
                    .trim()
                    .parse::<u32>()
                    .map_or(String::new(), |n| format!(" {n}"));
                let expected = "a directory without an active run (--out)";
                let dir = dir.display();
                Err(Failure::Input(format!(
                    "{dir}: found it in use by process{process}, expected {expected}"
                )))
            }
        }
    }
}

impl Lock {
    /// Adds the scene, so that namesakes use other directories.
    pub fn name(&mut self, scene: &Path) {
        // The name is optional.
        let _ = self.file.write_all(format!("{}\n", scene.display()).as_bytes());
    }

    /// Returns the new location of a moved directory, if known.
    pub fn moved(&self) -> Option<Option<PathBuf>> {
        if system::is_at(&self.file, &self.path) {
            return None;
        }
        Some(
            system::path_of(&self.file)
                .and_then(|file| Some(file.parent()?.to_path_buf()))
                .filter(|dir| dir.join(FILE).exists()),
        )
    }
}

/// File, and whether it existed; none if locked by another process.
fn lock(path: &Path) -> io::Result<Option<(File, bool)>> {
    let own = format!("{}\n", std::process::id());
    for _ in 0..TRIES {
        let before = path.exists();
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match system::try_lock(&file) {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            // Some file systems do not support locks.
            Err(TryLockError::Error(e)) => {
                message::warn(&format!("{}: cannot be locked against other runs ({e})", path.display()));
            }
        }
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(own.as_bytes())?;
        // The previous owner may have removed the file.
        let mut there = String::new();
        match File::open(path).and_then(|mut f| f.read_to_string(&mut there)) {
            Ok(_) if there == own => return Ok(Some((file, before))),
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
            _ => {}
        }
    }
    Ok(None)
}

/// Rejects a file, or a link without target, in place of a directory or above it.
fn refuse_file(dir: &Path) -> Result<(), Failure> {
    let is_there = |path: &&Path| !path.as_os_str().is_empty() && path.symlink_metadata().is_ok();
    match dir.ancestors().find(is_there).filter(|path| !path.is_dir()) {
        None => Ok(()),
        Some(path) => {
            let found = if path.exists() { "a file" } else { "a link without target" };
            Err(Failure::Input(format!("{}: found {found}, expected a directory", path.display())))
        }
    }
}

fn remove(made: &[PathBuf]) {
    // Non-empty directories stay.
    made.iter().rev().for_each(|dir| drop(fs::remove_dir(dir)));
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Removed while locked, so that no other lock is deleted.
        match self.moved() {
            None => drop(fs::remove_file(&self.path)),
            Some(place) => drop(place.map(|dir| fs::remove_file(dir.join(FILE)))),
        }
        let _ = self.file.unlock();
        remove(&self.made);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_io::scratch::folder;

    #[test]
    fn locks_once_and_ignores_dead_processes() {
        let dir = folder("lock");
        let inner = dir.join("a/b");
        let lock = Lock::take(&inner).unwrap();
        assert!(!lock.left_behind);
        let error = Lock::take(&inner).unwrap_err();
        let process = std::process::id();
        assert_eq!(
            (error.code(), error.to_string()),
            (
                2,
                format!(
                    "{}: found it in use by process {process}, expected a directory without an active run (--out)",
                    inner.display()
                )
            )
        );
        drop(lock);
        assert!(!dir.join("a").exists(), "folders that were made for nothing go");
        fs::create_dir_all(&inner).unwrap();
        fs::write(inner.join(FILE), "1\n").unwrap();
        assert!(Lock::take(&inner).unwrap().left_behind);
        assert!(inner.is_dir() && !inner.join(FILE).exists());
        fs::write(dir.join("file"), "").unwrap();
        let sentence = |name: &str, found: &str| {
            format!("{}: found {found}, expected a directory", dir.join(name).display())
        };
        let error = Lock::take(&dir.join("file")).unwrap_err();
        assert_eq!((error.code(), error.to_string()), (2, sentence("file", "a file")));
        let error = Lock::take(&dir.join("file/x")).unwrap_err();
        assert_eq!((error.code(), error.to_string()), (2, sentence("file", "a file")));
        assert_eq!(fs::read(dir.join("file")).unwrap(), b"");
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("loop", dir.join("loop")).unwrap();
            let error = Lock::take(&dir.join("loop")).unwrap_err();
            assert_eq!((error.code(), error.to_string()), (2, sentence("loop", "a link without target")));
        }
        fs::remove_dir_all(&dir).unwrap();
    }
}
