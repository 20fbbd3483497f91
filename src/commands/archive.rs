//! Archives of finished runs: results and input files in one `.tar.gz` file.

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Component, Path, PathBuf};
use tar::{Archive, Builder, EntryType, Header};
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;
use trackbed_io::system;
use trackbed_io::write::{WriteError, atomic};
use trackbed_run::{Hash, RunFile, named_files};

/// Files of a results directory that are not archived.
pub const OMITTED: [&str; 2] = ["checkpoint", "run.lock"];

/// Description of the run.
const RECORD: &str = "archive.json";
const INPUTS: &str = "inputs";
const RESULTS: &str = "results";
const ENDING: &str = ".tar.gz";
const EXPECTED: &str = "an archive by `trackbed reproduce RESULTS --archive`";

/// Content of `archive.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Record {
    /// Program version of the run.
    version: String,
    /// Scene file in the archive.
    scene: String,
    /// Command-line overrides, key=value, in order.
    overrides: Vec<String>,
    /// Hashes of the input files in the archive.
    files: BTreeMap<String, String>,
    environment: Environment,
}

/// Machine that wrote the archive.
#[derive(Debug, Serialize, Deserialize)]
struct Environment {
    os: String,
    architecture: String,
    cores: usize,
    cpu: Option<String>,
}

impl Environment {
    fn of_this_machine() -> Environment {
        Environment {
            os: std::env::consts::OS.into(),
            architecture: std::env::consts::ARCH.into(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            cpu: system::cpu_name(),
        }
    }
}

fn refusal(file: &Path, found: &str, expected: &str) -> Failure {
    Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
}

/// Fault of an entry of an archive.
fn fault(archive: &Path, entry: &str, found: &str, expected: &str) -> Failure {
    Failure::Input(format!("{}: {entry}: found {found}, expected {expected}", archive.display()))
}

fn damage(archive: &Path, error: &io::Error) -> Failure {
    refusal(archive, &format!("a damaged archive ({error})"), EXPECTED)
}

/// Checks that the run in `results` can be archived and that `archive` is a new file.
///
/// # Errors
/// A run with `--from`; another extension; an existing file.
pub fn check(archive: &Path, results: &Path) -> Result<(), Failure> {
    if let Some(from) = RunFile::read(results).and_then(|run| run.from) {
        let found = format!("a run with --from {from}");
        return Err(refusal(&results.join("run.json"), &found, "a run without --from, to archive it"));
    }
    if folder(archive).is_none() {
        return Err(refusal(archive, "another extension", &format!("a name that ends with {ENDING}")));
    }
    if archive.exists() {
        return Err(refusal(archive, "an existing file", "a new file"));
    }
    Ok(())
}

/// Directory of an unpacked archive: its path without the extension.
fn folder(archive: &Path) -> Option<PathBuf> {
    let name = archive.file_name()?.to_str()?.strip_suffix(ENDING)?;
    (!name.is_empty()).then(|| archive.with_file_name(name))
}

/// Writes an archive of a run: its results by name, and the input files of its scene. Equal files give equal
/// archives.
///
/// # Errors
/// Absolute paths in the scene; I/O errors.
pub fn write(
    archive: &Path,
    run: &RunFile,
    (document, scene): (&Document, &Scene),
    results: &BTreeMap<String, PathBuf>,
) -> Result<(), Failure> {
    let (scene, inputs) = inputs(document, scene)?;
    let mut hashes = BTreeMap::new();
    for (name, path) in &inputs {
        let hash = File::open(path).and_then(|mut file| hash_of(&mut file)).map_err(unreadable(path))?;
        hashes.insert(name.clone(), hash);
    }
    let record = Record {
        version: run.version.clone(),
        scene,
        overrides: run.overrides.clone(),
        files: hashes,
        environment: Environment::of_this_machine(),
    };
    let text = serde_json::to_string_pretty(&record).map_err(|e| Failure::Other(e.to_string()))? + "\n";
    let results = results.iter().map(|(name, path)| (format!("{RESULTS}/{name}"), path.clone()));
    let files: BTreeMap<String, PathBuf> = inputs.into_iter().chain(results).collect();
    atomic::write_in_places(archive, |out| fill(archive, out, &text, &files))
}

fn unreadable(path: &Path) -> impl Fn(io::Error) -> Failure + '_ {
    move |error| Failure::Other(format!("{}: {}", path.display(), system::words(&error)))
}

/// Writes the record and all files, by name.
fn fill(
    archive: &Path,
    out: &mut BufWriter<File>,
    record: &str,
    files: &BTreeMap<String, PathBuf>,
) -> Result<(), Failure> {
    let failed = |error: io::Error| Failure::from(WriteError::io(archive)(error));
    let mut tar = Builder::new(GzEncoder::new(out, Compression::default()));
    append(&mut tar, RECORD, record.len() as u64, &mut record.as_bytes()).map_err(failed)?;
    for (name, path) in files {
        let file = File::open(path).map_err(unreadable(path))?;
        let size = file.metadata().map_err(unreadable(path))?.len();
        let mut data = file.take(size);
        append(&mut tar, name, size, &mut data).map_err(failed)?;
        if data.limit() > 0 {
            let path = path.display();
            return Err(Failure::Other(format!("{path}: found it truncated, expected no change meanwhile")));
        }
    }
    tar.into_inner().and_then(GzEncoder::finish).map_err(failed)?;
    Ok(())
}

fn append(tar: &mut Builder<impl Write>, name: &str, size: u64, data: &mut impl Read) -> io::Result<()> {
    let mut header = Header::new_gnu();
    header.set_entry_type(EntryType::Regular);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(0);
    header.set_size(size);
    tar.append_data(&mut header, name, data)
}

/// Name of the scene in the archive, and all input files by name, relative to their common directory.
fn inputs(document: &Document, scene: &Scene) -> Result<(String, BTreeMap<String, PathBuf>), Failure> {
    let own = document.file();
    let mut files = vec![own.to_path_buf()];
    for named in named_files(document, scene) {
        if named.is_absolute() {
            let found = format!("the absolute path {}", named.display());
            return Err(refusal(own, &found, "paths relative to the scene, to archive the run"));
        }
        // A directory of a mesh is named with its files, of which one is optional.
        files.extend(Some(document.resolve(&named)).filter(|path| path.is_file()));
    }
    let whole = files.iter().map(|path| normal(path)).collect::<Result<Vec<_>, _>>()?;
    let mut common = whole[0].parent().unwrap_or(Path::new("")).to_path_buf();
    while !whole.iter().all(|path| path.starts_with(&common)) && common.pop() {}
    let names = whole.iter().map(|path| name_in(&common, path)).collect::<Result<Vec<_>, _>>()?;
    Ok((names[0].clone(), names.into_iter().zip(files).collect()))
}

/// Absolute path without `.` and `..`; links are kept, as the scene names them.
fn normal(path: &Path) -> Result<PathBuf, Failure> {
    let whole = std::path::absolute(path).map_err(unreadable(path))?;
    let mut out = PathBuf::new();
    for part in whole.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    Ok(out)
}

fn name_in(common: &Path, path: &Path) -> Result<String, Failure> {
    let parts = path.strip_prefix(common).unwrap_or(path).components();
    let parts: Option<Vec<&str>> = parts.map(|part| part.as_os_str().to_str()).collect();
    let parts = parts.ok_or_else(|| refusal(path, "a name that is not UTF-8", "UTF-8, to archive it"))?;
    Ok(format!("{INPUTS}/{}", parts.join("/")))
}

fn hash_of(data: &mut dyn Read) -> io::Result<String> {
    let mut hash = Hash::default();
    let mut block = vec![0; 1 << 16];
    loop {
        match data.read(&mut block) {
            Ok(0) => return Ok(hash.hex()),
            Ok(count) => hash.add(&block[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// Unpacks an archive into the directory of its name and returns the results directory and the scene in it.
///
/// # Errors
/// No archive; entries outside the directory; changed input files; a directory with content; I/O errors.
pub fn unpack(archive: &Path) -> Result<(PathBuf, PathBuf), Failure> {
    let Some(dir) = folder(archive) else {
        return Err(refusal(archive, "a file", &format!("a results directory, or an archive NAME{ENDING}")));
    };
    let is_free = fs::read_dir(&dir).map_or(!dir.exists(), |mut entries| entries.next().is_none());
    if !is_free {
        let found = if dir.is_dir() { "a directory that is not empty" } else { "a file" };
        return Err(refusal(&dir, found, "a new or empty directory for the content of the archive"));
    }
    let scene = checked_scene(archive)?;
    if let Err(failure) = extract(archive, &dir) {
        // Nothing incomplete stays.
        let _ = fs::remove_dir_all(&dir);
        return Err(failure);
    }
    Ok((dir.join(RESULTS), dir.join(scene)))
}

/// Name of the scene in an archive whose input files have the recorded hashes.
fn checked_scene(archive: &Path) -> Result<String, Failure> {
    let mut record: Option<Record> = None;
    let mut hashes = BTreeMap::new();
    let folder = format!("{INPUTS}/");
    each(archive, |name, data| {
        if name == RECORD {
            let content = serde_json::from_reader(data);
            record = Some(content.map_err(|e| fault(archive, RECORD, &e.to_string(), EXPECTED))?);
        } else if name.starts_with(&folder) {
            let hash = hash_of(data).map_err(|e| damage(archive, &e))?;
            hashes.insert(name.to_string(), hash);
        }
        Ok(())
    })?;
    let record = record.ok_or_else(|| refusal(archive, &format!("no {RECORD}"), EXPECTED))?;
    for (name, hash) in &record.files {
        match hashes.remove(name) {
            Some(found) if found == *hash => {}
            Some(found) => {
                let found = format!("changed content with hash {found}");
                return Err(fault(archive, name, &found, &format!("hash {hash}")));
            }
            None => return Err(fault(archive, name, "nothing", "the input file of the run")),
        }
    }
    if let Some(name) = hashes.keys().next() {
        return Err(fault(archive, name, "a file without a hash", &format!("only input files of {RECORD}")));
    }
    if !record.files.contains_key(&record.scene) {
        return Err(fault(archive, RECORD, "a scene that is no input file", EXPECTED));
    }
    Ok(record.scene)
}

/// Writes all files of an archive below `dir`.
fn extract(archive: &Path, dir: &Path) -> Result<(), Failure> {
    each(archive, |name, data| {
        let file = dir.join(name);
        let folder = file.parent().unwrap_or(dir);
        fs::create_dir_all(folder).map_err(WriteError::io(folder))?;
        atomic::write(&file, |out| io::copy(data, out).map(drop).map_err(WriteError::io(&file)))?;
        Ok(())
    })
}

/// Calls `act` with name and content of each file of an archive.
fn each(
    archive: &Path,
    mut act: impl FnMut(&str, &mut dyn Read) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let damaged = |error: io::Error| damage(archive, &error);
    let packed = File::open(archive).map_err(unreadable(archive))?;
    let mut tar = Archive::new(GzDecoder::new(packed));
    let mut names = BTreeSet::new();
    for entry in tar.entries().map_err(damaged)? {
        let mut entry = entry.map_err(damaged)?;
        let name = safe_name(archive, &entry.path().map_err(damaged)?)?;
        let kind = entry.header().entry_type();
        if kind.is_dir() {
            continue;
        }
        if !kind.is_file() {
            return Err(fault(archive, &name, "a link or a special file", "regular files only"));
        }
        act(&name, &mut entry)?;
        if let Some(name) = names.replace(name) {
            return Err(fault(archive, &name, "a second file of this name", "each name once"));
        }
    }
    // The checksum of the content is the last part.
    io::copy(&mut tar.into_inner(), &mut io::sink()).map_err(damaged)?;
    Ok(())
}

/// Name of an entry, which must lie below the directory of the archive.
fn safe_name(archive: &Path, path: &Path) -> Result<String, Failure> {
    let parts = path.components().filter(|part| *part != Component::CurDir);
    let parts: Option<Vec<&str>> = parts
        .map(|part| match part {
            Component::Normal(name) => name.to_str(),
            _ => None,
        })
        .collect();
    let expected = "a relative path in UTF-8, without `..`";
    let parts = parts.ok_or_else(|| fault(archive, &path.display().to_string(), "this entry", expected))?;
    Ok(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_outside_are_rejected() {
        let name = |path: &str| safe_name(Path::new("a.tar.gz"), Path::new(path));
        assert_eq!(name("./inputs/a b.toml").unwrap(), "inputs/a b.toml");
        for path in ["../a", "inputs/../../a", "/etc/a"] {
            let failure = name(path).unwrap_err();
            let expected = "found this entry, expected a relative path in UTF-8, without `..`";
            assert_eq!((failure.code(), failure.to_string()), (2, format!("a.tar.gz: {path}: {expected}")));
        }
    }

    #[test]
    fn directory_has_name_of_archive() {
        assert_eq!(folder(Path::new("runs/first.tar.gz")), Some(PathBuf::from("runs/first")));
        assert_eq!(folder(Path::new(".tar.gz")), None);
        assert_eq!(folder(Path::new("first.zip")), None);
    }

    #[test]
    fn paths_are_normal() {
        let here = std::env::current_dir().unwrap();
        assert_eq!(normal(Path::new("a/../b/./c.toml")).unwrap(), here.join("b/c.toml"));
        assert_eq!(name_in(&here, &here.join("b/c.toml")).unwrap(), "inputs/b/c.toml");
    }
}
