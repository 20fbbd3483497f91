//! The lock of a folder of results: one command at a time writes there.
//!
//! The file `run.lock` holds the number of the process and the scene that it runs, and is locked by the system (advisory), which ends with the process
//! however that ends: the file that a killed run leaves behind locks nobody out. It is removed at the end.

use crate::failure::Failure;
use crate::{machine, message};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// Name of the file.
pub const FILE: &str = "run.lock";
/// Times that a lock is tried to be taken, where another process removes its own meanwhile.
const TRIES: usize = 20;

/// A folder that nobody else writes to.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    file: File,
    /// Folders that were made for it, the outer ones first.
    made: Vec<PathBuf>,
    /// Whether a run that was killed has left its lock.
    pub left_behind: bool,
}

/// Whether the lock of a run is in a folder: of one at work there, or of one that was killed.
pub fn is_there(dir: &Path) -> bool {
    dir.join(FILE).is_file()
}

impl Lock {
    /// Locks a folder, which is made where it is missing; goes again with the lock if nothing was put there.
    ///
    /// # Errors
    /// Bad input: another process has it. It is no folder; what the system refuses.
    pub fn take(dir: &Path) -> Result<Lock, Failure> {
        if dir.exists() && !dir.is_dir() {
            return Err(Failure::Other(format!("{}: found a file, expected a directory", dir.display())));
        }
        let system = |e: io::Error| Failure::Other(format!("{}: {}", dir.display(), machine::words(&e)));
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
    /// Adds to the lock which scene is run, so that another one of its name goes elsewhere from the beginning.
    pub fn name(&mut self, scene: &Path) {
        // A lock without a name locks as well.
        let _ = self.file.write_all(format!("{}\n", scene.display()).as_bytes());
    }

    /// Where the folder is if it is no longer where it was: its new place, if the system tells it.
    pub fn moved(&self) -> Option<Option<PathBuf>> {
        if self.is_there() {
            return None;
        }
        Some(
            place(&self.file)
                .and_then(|file| Some(file.parent()?.to_path_buf()))
                .filter(|dir| dir.join(FILE).exists()),
        )
    }

    /// Whether the lock is the file of its name.
    #[cfg(unix)]
    fn is_there(&self) -> bool {
        use std::os::unix::fs::MetadataExt;
        let (Ok(own), Ok(named)) = (self.file.metadata(), fs::metadata(&self.path)) else { return false };
        (own.dev(), own.ino()) == (named.dev(), named.ino())
    }

    #[cfg(not(unix))]
    fn is_there(&self) -> bool {
        self.path.exists()
    }
}

/// Where an open file is now, by the system's own account.
#[cfg(target_os = "linux")]
fn place(file: &File) -> Option<PathBuf> {
    use std::os::fd::AsRawFd;
    fs::read_link(format!("/proc/self/fd/{}", file.as_raw_fd())).ok()
}

#[cfg(not(target_os = "linux"))]
fn place(_: &File) -> Option<PathBuf> {
    None
}

/// The locked file and whether it was there before; none where another process has it.
fn lock(path: &Path) -> io::Result<Option<(File, bool)>> {
    let own = format!("{}\n", std::process::id());
    for _ in 0..TRIES {
        let before = path.exists();
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            // Some file systems know no locks.
            Err(TryLockError::Error(e)) => {
                message::warn(&format!("{}: cannot be locked against other runs ({e})", path.display()));
            }
        }
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(own.as_bytes())?;
        // The process that had it may have removed the file between its opening and its lock.
        let mut there = String::new();
        match File::open(path).and_then(|mut f| f.read_to_string(&mut there)) {
            Ok(_) if there == own => return Ok(Some((file, before))),
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
            _ => {}
        }
    }
    Ok(None)
}

fn remove(made: &[PathBuf]) {
    // Folders that hold something stay.
    made.iter().rev().for_each(|dir| drop(fs::remove_dir(dir)));
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While it is locked, so that no lock of another process is removed; what cannot be removed locks nobody out.
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
    use crate::write::sample::folder;

    #[test]
    fn one_at_a_time_and_what_is_dead_locks_nobody_out() {
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
        let error = Lock::take(&dir.join("file")).unwrap_err();
        assert!(
            error.code() == 1 && error.to_string().ends_with("found a file, expected a directory"),
            "{error}"
        );
        fs::remove_dir_all(&dir).unwrap();
    }
}
