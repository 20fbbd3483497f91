//! Checkpoints from which a run resumes bitwise identically.
//!
//! A new file replaces the older slot once it is synced, so one valid checkpoint always exists.

mod form;
mod origin;

pub use form::{Body, Loaded, Moment};
pub use origin::{Origin, processor};

use crate::hash::Hash;
use form::{Header, Unfit};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::read::source::{self, Refusal};
use trackbed_io::write::{WriteError, atomic};

/// Reads a state file: origin, state, hash.
///
/// # Errors
/// Unreadable, damaged, or of another program.
pub fn read_file(file: &Path) -> Result<(Origin, Loaded, String), Failure> {
    let name = file.display();
    let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
    let mut hash = Hash::default();
    hash.add(&bytes);
    let (header, loaded) = form::read(bytes).map_err(|unfit| match unfit {
        Unfit::Form(text) => Failure::Input(format!("{name}: {text}")),
        Unfit::Damaged(text) => Failure::Input(format!("{name}: damaged: {text}")),
    })?;
    Ok((header.origin, loaded, hash.hex()))
}

/// Validates a checkpoint or state file.
///
/// # Errors
/// As `read_file`.
pub fn check_file(file: &Path) -> Result<(), Failure> {
    read_file(file).map(drop)
}

/// Returns the latest valid checkpoint of any run.
pub fn latest(results: &Path) -> Option<Loaded> {
    let bytes =
        SLOTS.iter().filter_map(|slot| source::bytes(&results.join(FOLDER).join(slot), source::LARGEST).ok());
    let read = bytes.filter_map(|bytes| form::read(bytes).ok());
    read.max_by_key(|(header, _)| header.number).map(|(_, loaded)| loaded)
}

/// Checkpoint directory of a run.
pub struct Slots {
    dir: PathBuf,
    origin: Origin,
    next: u64,
    /// Whether the slots are of this run.
    own: bool,
}

/// Directory name in the results directory.
pub const FOLDER: &str = "checkpoint";
const SLOTS: [&str; 2] = ["a.checkpoint", "b.checkpoint"];

impl Slots {
    /// Creates the slots of a new run.
    pub fn new(results: &Path, origin: Origin) -> Slots {
        Slots { dir: results.join(FOLDER), origin, next: 0, own: false }
    }

    /// Returns the directory.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Whether any checkpoint exists, valid or not.
    pub fn any(&self) -> bool {
        SLOTS.iter().any(|slot| self.dir.join(slot).exists())
    }

    /// Whether this run has a checkpoint.
    pub fn has_one(&self) -> bool {
        self.own && self.next > 0
    }

    /// Writes a checkpoint.
    ///
    /// # Errors
    /// I/O errors; the last valid checkpoint remains.
    pub fn save(
        &mut self,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.clear_others()?;
        // Not recursive: a new directory at the path of a renamed one would split the run.
        match fs::create_dir(&self.dir) {
            Err(e) if e.kind() != io::ErrorKind::AlreadyExists => return Err(failure(&self.dir, &e)),
            _ => {}
        }
        let header = Header { number: self.next, moment, origin: self.origin.clone() };
        let file = self.dir.join(SLOTS[(self.next % 2) as usize]);
        atomic::write(&file, |out| {
            form::write(out, &header, fill).map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        self.own = true;
        self.next += 1;
        Ok(())
    }

    /// Writes a state file.
    ///
    /// # Errors
    /// I/O errors.
    pub fn save_file(
        &self,
        file: &Path,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let header = Header { number: 0, moment, origin: self.origin.clone() };
        Ok(atomic::write(file, |out| form::write(out, &header, fill).map_err(WriteError::io(file)))?)
    }

    /// Removes checkpoints of another run.
    ///
    /// # Errors
    /// I/O errors.
    pub fn clear_others(&mut self) -> Result<(), Failure> {
        if self.own { Ok(()) } else { self.clear() }
    }

    /// Removes all checkpoints.
    ///
    /// # Errors
    /// I/O errors.
    pub fn clear(&mut self) -> Result<(), Failure> {
        for slot in SLOTS {
            for name in [slot.to_string(), format!("{slot}.part")] {
                let file = self.dir.join(name);
                match fs::remove_file(&file) {
                    Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(failure(&file, &e)),
                    _ => {}
                }
            }
        }
        // User files or a missing directory are harmless.
        let _ = fs::remove_dir(&self.dir);
        (self.own, self.next) = (true, 0);
        Ok(())
    }

    /// Loads the latest valid checkpoint, with warnings about a damaged slot or another CPU.
    ///
    /// # Errors
    /// None, all damaged, or of another program or scene.
    pub fn load(&mut self, document: &Document) -> Result<(Loaded, Vec<String>), Failure> {
        let refuse = |text: String| Failure::Input(format!("--resume: {text}"));
        let (mut found, mut damaged, mut forms) = (Vec::new(), Vec::new(), Vec::new());
        for slot in SLOTS {
            let file = self.dir.join(slot);
            let bytes = match source::bytes(&file, source::LARGEST) {
                Err(Refusal::System(e)) if e.kind() == io::ErrorKind::NotFound => continue,
                bytes => bytes.map_err(|refusal| {
                    let (found, expected) = refusal.words(|e| format!("that it cannot be read ({e})"));
                    refuse(format!("{}: found {found}, expected {expected}", file.display()))
                })?,
            };
            match form::read(bytes) {
                Ok(loaded) => found.push((file, loaded)),
                Err(Unfit::Form(text)) => forms.push(format!("{}: {text}", file.display())),
                Err(Unfit::Damaged(text)) => damaged.push(format!("{} is damaged: {text}", file.display())),
            }
        }
        found.sort_by_key(|(_, (header, _))| header.number);
        let Some((file, (header, loaded))) = found.pop() else {
            let folder = self.dir.display();
            return Err(refuse(match (forms.is_empty(), damaged.is_empty()) {
                (false, _) => forms.join("; "),
                (_, true) => {
                    format!("no checkpoint in {folder}, expected the checkpoint of an interrupted run")
                }
                (_, false) => damaged.join("; "),
            }));
        };
        if let Some(text) = self.origin.difference(&header.origin, document) {
            return Err(refuse(format!("{}: {text}", file.display())));
        }
        damaged.extend(forms);
        let mut remarks: Vec<String> = self.origin.other_processor(&header.origin).into_iter().collect();
        remarks
            .extend(damaged.first().map(|text| format!("{text}; the run resumes from {}", file.display())));
        (self.own, self.next) = (true, header.number + 1);
        Ok((loaded, remarks))
    }
}

fn failure(file: &Path, error: &io::Error) -> Failure {
    Failure::Other(format!("{}: {error}", file.display()))
}

#[cfg(test)]
mod tests;
