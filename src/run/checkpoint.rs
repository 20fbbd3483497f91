//! The checkpoint of a run: a file that a later start of the program goes on from, bit for bit.
//!
//! ```text
//! trackbed checkpoint 3\n        the form of the file
//! { header }\n                   JSON: program, scene, stage, step, time
//! body                           binary: every number with all its bits
//! 8 bytes                        64-bit FNV-1a checksum of all before, low byte first
//! ```
//!
//! The body is a sequence of parts in the form of the crate `postcard` (little endian, integers of variable length), read in the
//! order that they were written in; which parts they are is up to the stage that wrote them. Fields have no names there, so
//! no type in a checkpoint may leave a field out (`skip_serializing_if`).
//!
//! There are two slots. A checkpoint goes to the one that the last did not go to, beside the old file first and in its
//! place when it is whole and on the disk. So at any moment one good checkpoint exists.

use super::hash::Hash;
use crate::failure::Failure;
use crate::read::source::{self, Refusal};
use crate::scene::Document;
use crate::write::WriteError;
use crate::write::atomic;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// First line of a checkpoint, with the number of its form.
const MAGIC: &str = "trackbed checkpoint ";
/// The form that this program writes and reads.
const FORM: u32 = 5;
/// Bytes of the checksum at the end.
const CHECKSUM: usize = 8;
/// Bytes that are gathered before they are summed and written.
const BUFFER: usize = 1 << 18;

/// What a checkpoint is of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of the program.
    pub version: String,
    /// Hash of the scene, its overrides and its files.
    pub scene_hash: String,
    /// Text of the scene file.
    pub scene: String,
    /// Keys overridden on the command line, as key=value.
    pub overrides: Vec<String>,
    /// The files that the scene names, with the hash of each.
    pub files: Vec<(PathBuf, String)>,
}

/// Where in the run a checkpoint was written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Stage, such as `run`.
    pub stage: String,
    /// Steps or windows of the stage that were done.
    pub step: u64,
    /// Simulated time of the stage [s].
    pub time: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    /// Number of this checkpoint in its run; the higher one of two slots is the later.
    number: u64,
    moment: Moment,
    origin: Origin,
}

impl Origin {
    /// One sentence on what makes this scene another than the one that `old` is of; none when it is the same.
    pub fn difference(&self, old: &Origin, document: &Document) -> Option<String> {
        if old.version != self.version {
            return Some(format!("is of version {} of the program, this is {}", old.version, self.version));
        }
        if old.scene_hash == self.scene_hash {
            return None;
        }
        let wrong = "the scene is not the one of the checkpoint";
        let before = Document::parse(document.file(), old.scene.clone()).ok().and_then(|mut d| {
            old.overrides.iter().try_for_each(|o| d.set(o)).ok()?;
            Some(keys(&d))
        });
        if let Some(before) = before {
            let now = keys(document);
            let changed = before.keys().chain(now.keys()).find(|k| before.get(*k) != now.get(*k));
            if let Some(key) = changed {
                let text =
                    |keys: &BTreeMap<String, String>| keys.get(key).map_or("absent", |v| v).to_string();
                return Some(format!("{wrong}: {key} was {}, now {}", text(&before), text(&now)));
            }
        }
        let changed = self.files.iter().find(|f| !old.files.contains(f));
        Some(match changed {
            Some((file, _)) => format!("{wrong}: {} has changed", file.display()),
            None => format!("{wrong}: its text or its overrides have changed, though no key has"),
        })
    }
}

/// Every key of a scene with its value, overrides applied.
fn keys(document: &Document) -> BTreeMap<String, String> {
    fn visit(path: &str, value: &toml::Value, out: &mut BTreeMap<String, String>) {
        let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
        match value {
            toml::Value::Table(t) => t.iter().for_each(|(k, v)| visit(&below(k), v, out)),
            toml::Value::Array(a) if a.iter().any(toml::Value::is_table) => {
                a.iter().enumerate().for_each(|(i, v)| visit(&below(&i.to_string()), v, out));
            }
            other => {
                out.insert(path.to_string(), other.to_string());
            }
        }
    }
    let mut out = BTreeMap::new();
    // A tree that cannot be read shows no keys; the hash still distinguishes the scenes.
    if let Ok(tree) = document.read::<toml::Table>() {
        visit("", &toml::Value::Table(tree), &mut out);
    }
    out
}

/// The folder of the checkpoints of a run.
pub struct Slots {
    dir: PathBuf,
    origin: Origin,
    /// Number of the next checkpoint.
    next: u64,
    /// Whether the slots hold checkpoints of this run, or none.
    own: bool,
}

/// Name of the folder in the folder of the results.
pub const FOLDER: &str = "checkpoint";
const SLOTS: [&str; 2] = ["a.checkpoint", "b.checkpoint"];

impl Slots {
    /// The slots of a run that begins. What an earlier run left there stays until the first checkpoint is written, or the
    /// results of that run are cleared away.
    pub fn new(results: &Path, origin: Origin) -> Slots {
        Slots { dir: results.join(FOLDER), origin, next: 0, own: false }
    }

    /// The folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Whether there is a checkpoint, good or not, of whatever run.
    pub fn any(&self) -> bool {
        SLOTS.iter().any(|slot| self.dir.join(slot).exists())
    }

    /// Whether this run has a checkpoint.
    pub fn has_one(&self) -> bool {
        self.own && self.next > 0
    }

    /// Writes a checkpoint whose parts `fill` puts in.
    ///
    /// # Errors
    /// What the system refuses; the last good checkpoint is left.
    pub fn save(
        &mut self,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.clear_others()?;
        fs::create_dir_all(&self.dir).map_err(|e| failure(&self.dir, &e))?;
        let header = Header { number: self.next, moment, origin: self.origin.clone() };
        let header = serde_json::to_string(&header).map_err(|e| Failure::Other(e.to_string()))?;
        let file = self.dir.join(SLOTS[(self.next % 2) as usize]);
        atomic::write(&file, |out| {
            let mut body = Body { out, hash: Hash::default(), buffer: Vec::with_capacity(BUFFER) };
            body.write_all(format!("{MAGIC}{FORM}\n{header}\n").as_bytes())
                .and_then(|()| fill(&mut body))
                .and_then(|()| body.finish())
                .map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        self.own = true;
        self.next += 1;
        Ok(())
    }

    /// Removes the checkpoints that another run left.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn clear_others(&mut self) -> Result<(), Failure> {
        if self.own { Ok(()) } else { self.clear() }
    }

    /// Removes all checkpoints and their folder, if nothing else is in it.
    ///
    /// # Errors
    /// What the system refuses.
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
        // Files of a user keep the folder; so does its absence.
        let _ = fs::remove_dir(&self.dir);
        (self.own, self.next) = (true, 0);
        Ok(())
    }

    /// The latest good checkpoint in the slots, which later ones then follow, and a remark on a damaged one.
    ///
    /// # Errors
    /// Bad input: there is none, all are damaged, or it is of another program or scene.
    pub fn load(&mut self, document: &Document) -> Result<(Loaded, Option<String>), Failure> {
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
            match read(bytes) {
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
                (_, true) => format!("no checkpoint in {folder}, expected one of an interrupted run"),
                (_, false) => damaged.join("; "),
            }));
        };
        if let Some(text) = self.origin.difference(&header.origin, document) {
            return Err(refuse(format!("{}: {text}", file.display())));
        }
        damaged.extend(forms);
        let remark = damaged.first().map(|text| format!("{text}; the run goes on from {}", file.display()));
        (self.own, self.next) = (true, header.number + 1);
        Ok((loaded, remark))
    }
}

fn failure(file: &Path, error: &io::Error) -> Failure {
    Failure::Other(format!("{}: {error}", file.display()))
}

/// Why a file is refused.
enum Unfit {
    Form(String),
    Damaged(String),
}

/// Whether the checksum is that of the content. A form of another program has its checksum too; one digit that flipped in the
/// number of the form has not.
fn is_whole(bytes: &[u8]) -> bool {
    let end = bytes.len().saturating_sub(CHECKSUM);
    let mut hash = Hash::default();
    hash.add(&bytes[..end]);
    bytes[end..] == hash.value().to_le_bytes()
}

fn read(bytes: Vec<u8>) -> Result<(Header, Loaded), Unfit> {
    let damaged = |text: &str| Unfit::Damaged(text.to_string());
    let line = |from: usize| bytes[from..].iter().position(|b| *b == b'\n').map(|n| from + n);
    let first = line(0).ok_or_else(|| damaged("it has no first line"))?;
    let form = std::str::from_utf8(&bytes[..first]).ok().and_then(|l| l.strip_prefix(MAGIC));
    match form.and_then(|f| f.parse::<u32>().ok()) {
        Some(other) if other != FORM && is_whole(&bytes) => {
            return Err(Unfit::Form(format!("found form {other} of a checkpoint, expected {FORM}")));
        }
        Some(_) => {}
        None => return Err(damaged("it does not begin as a checkpoint")),
    }
    if !is_whole(&bytes) {
        return Err(damaged("its checksum is not that of its content"));
    }
    let end = bytes.len().saturating_sub(CHECKSUM);
    let second = line(first + 1).ok_or_else(|| damaged("it has no header"))?;
    let header: Header =
        serde_json::from_slice(&bytes[first + 1..second]).map_err(|e| Unfit::Damaged(e.to_string()))?;
    let moment = header.moment.clone();
    Ok((header, Loaded { moment, at: second + 1, end, bytes }))
}

/// Takes the parts of a checkpoint in.
pub struct Body<'a> {
    out: &'a mut dyn Write,
    hash: Hash,
    buffer: Vec<u8>,
}

impl Body<'_> {
    /// Adds a part.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn put<T: Serialize + ?Sized>(&mut self, part: &T) -> io::Result<()> {
        postcard::to_io(part, self).map(|_| ()).map_err(io::Error::other)
    }

    fn pass(&mut self) -> io::Result<()> {
        self.hash.add(&self.buffer);
        self.out.write_all(&self.buffer)?;
        self.buffer.clear();
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        self.pass()?;
        self.out.write_all(&self.hash.value().to_le_bytes())
    }
}

impl Write for Body<'_> {
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= BUFFER {
            self.pass()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A checkpoint that was read.
pub struct Loaded {
    /// Where in the run it was written.
    pub moment: Moment,
    bytes: Vec<u8>,
    at: usize,
    end: usize,
}

impl Loaded {
    /// The next part.
    ///
    /// # Errors
    /// The part is not of this type: the program that wrote it was another one of the same version.
    pub fn take<T: DeserializeOwned>(&mut self) -> Result<T, Failure> {
        let (part, rest) = postcard::take_from_bytes(&self.bytes[self.at..self.end]).map_err(|e| {
            Failure::Input(format!("--resume: the checkpoint was not written by this program: {e}"))
        })?;
        self.at = self.end - rest.len();
        Ok(part)
    }
}

#[cfg(test)]
#[path = "checkpoint_tests.rs"]
mod tests;
