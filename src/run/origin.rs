//! Origin of a run, its results directory, and resume command.

use super::checkpoint::{self, Origin};
use super::hash::Hash;
use super::lock;
use super::run_file::{RunFile, Source};
use std::fs;
use std::path::{Path, PathBuf};
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;
use trackbed_io::read::{mesh_files, source};

/// Whether `dir` contains final results of the scene, without a later checkpoint.
///
/// # Errors
/// Results of another scene.
pub fn was_done(dir: &Path, scene_hash: &str) -> Result<bool, Failure> {
    let bytes = source::bytes(&dir.join("summary.json"), source::LARGEST_TEXT).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&bytes).unwrap_or_default();
    if summary["status"] != "done" || dir.join(checkpoint::FOLDER).exists() {
        return Ok(false);
    }
    if summary["scene_hash"] != scene_hash {
        let dir = dir.display();
        return Err(Failure::Input(format!("--resume: {dir} contains the completed run of another scene")));
    }
    Ok(true)
}

/// Returns the resume command.
pub fn resume_command(scene: &Path, dir: &Path, set: &[String], from: Option<Source<'_>>) -> String {
    let mut command = format!("trackbed run {} --resume --out {}", quoted(scene), quoted(dir));
    set.iter().for_each(|s| command += &format!(" --set {}", quoted(Path::new(s))));
    from.iter().for_each(|source| command += &source.arguments());
    command
}

/// Returns the resume call of a scene built in Python.
pub fn resume_call(dir: &Path) -> String {
    format!("trackbed.run(scene, {:?}, resume=True)", dir.display().to_string())
}

impl Source<'_> {
    /// Formats as command-line options.
    pub fn arguments(&self) -> String {
        format!(" --from {}{}", quoted(self.dir), if self.bed { " --bed" } else { "" })
    }
}

/// Quotes a path as a shell word.
pub fn quoted(text: &Path) -> String {
    let text = text.display().to_string();
    match text.chars().all(|c| c.is_alphanumeric() || "/._-=+".contains(c)) {
        true => text,
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

/// Returns the hash of all data that determine the results.
pub fn scene_hash(document: &Document, scene: &Scene) -> String {
    origin(document, scene).scene_hash
}

/// Returns `results/` with scene name (or directory, for `scene.toml`), overrides and their hash; for
/// namesakes also a path hash.
pub fn default_folder(scene: &Path, set: &[String]) -> PathBuf {
    let mut name = plain_name(scene);
    if !set.is_empty() {
        name += &format!("-{}", short_hash(set.iter().map(String::as_bytes)));
    }
    let results = Path::new("results");
    let whole = fs::canonicalize(scene).unwrap_or_else(|_| scene.to_path_buf());
    let own =
        results.join(format!("{name}-{}", short_hash([whole.as_os_str().as_encoded_bytes()].into_iter())));
    let plain = results.join(name);
    if own.exists() || is_of_another(&plain, scene, &whole) { own } else { plain }
}

fn short_hash<'a>(parts: impl Iterator<Item = &'a [u8]>) -> String {
    let mut hash = Hash::default();
    parts.for_each(|part| hash.add(part));
    hash.hex()[..6].into()
}

fn is_of_another(dir: &Path, scene: &Path, whole: &Path) -> bool {
    let same = |path: &str| fs::canonicalize(path).ok().map(|path| path == whole);
    let lock = fs::read_to_string(dir.join(lock::FILE)).unwrap_or_default();
    if let Some(running) = lock.lines().nth(1) {
        return same(running) == Some(false);
    }
    let Some(file) = RunFile::read(dir) else { return false };
    // Moved scenes are identified by text.
    same(&file.scene).map_or_else(|| source::text(scene).is_ok_and(|text| text != file.text), |same| !same)
}

fn plain_name(scene: &Path) -> String {
    let stem = scene.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = scene.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    match (stem.as_str(), folder) {
        ("scene", Some(folder)) => folder,
        _ => stem,
    }
}

/// Returns the origin: scene, overrides, named files.
pub fn origin(document: &Document, scene: &Scene) -> Origin {
    let mut hash = Hash::default();
    hash.add(document.text().as_bytes());
    for (key, value) in document.overrides() {
        hash.add(key.as_bytes());
        hash.add(value.as_bytes());
    }
    let mut files = Vec::new();
    for file in named_files(document, scene) {
        // Missing files change the hash; the model rejects unreadable ones.
        let content = source::bytes(&document.resolve(&file), source::LARGEST).unwrap_or_default();
        hash.add(&content);
        let mut own = Hash::default();
        own.add(&content);
        files.push((file, own.hex()));
    }
    Origin {
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: hash.hex(),
        scene: document.text().into(),
        overrides: document.overrides().iter().map(|(k, v)| format!("{k}={v}")).collect(),
        files,
        processor: checkpoint::processor(),
    }
}

/// Returns the files that a scene names, directly or in its mesh file.
pub fn named_files(document: &Document, scene: &Scene) -> Vec<PathBuf> {
    let named = document.included().chain(files_of(scene)).map(Path::to_path_buf);
    named.chain(behind_the_mesh(document, scene)).collect()
}

/// Files named only in mesh files: lists, includes.
fn behind_the_mesh(document: &Document, scene: &Scene) -> Vec<PathBuf> {
    let Some(mesh) = scene.solid.as_ref().and_then(|s| s.mesh.as_ref()) else { return Vec::new() };
    let path = document.resolve(mesh);
    let files = mesh_files(&path).into_iter().filter(|file| *file != path);
    // Independent of the working directory.
    let folder = document.file().parent().unwrap_or(Path::new(""));
    files.map(|file| file.strip_prefix(folder).map_or(file.clone(), Path::to_path_buf)).collect()
}

fn files_of(scene: &Scene) -> Vec<&Path> {
    let mut files: Vec<&Path> = Vec::new();
    if let Some(s) = &scene.solid {
        files.extend(
            [&s.mesh, &s.nodes, &s.elements, &s.constraints].into_iter().flatten().map(PathBuf::as_path),
        );
        let histories = s.load.iter().map(|l| &l.history).chain(s.support.iter().map(|l| &l.history));
        files.extend(histories.flatten().filter_map(|h| h.file.as_deref()));
        files.extend(s.material.iter().filter_map(|m| Some(m.umat.as_ref()?.library.as_path())));
    }
    for g in &scene.grains {
        files.extend(g.library.as_deref());
        files.extend(g.packing.as_deref());
        files.extend(g.gradation.as_ref().map(|g| g.file.as_path()));
        files.extend(g.region.as_ref().and_then(|r| r.surface.as_deref()));
    }
    files.extend(scene.track.iter().filter_map(|t| t.load.as_ref()?.file.as_deref()));
    let rails = scene.track.iter().filter_map(|t| t.rail.as_ref());
    files.extend(rails.filter_map(|r| r.irregularity.as_ref()?.file.as_deref()));
    files.extend(scene.walls.iter().filter_map(|w| w.file.as_deref()));
    files.extend(scene.bond.iter().filter_map(|b| b.pairs.as_deref()));
    files
}
