//! Blocks of a scene before it runs.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde_json::{Value, json};

use super::chunk::{Blocks, Chunk, Coding};
use super::lines::relative;
use crate::preview::{KINDS, Preview, Source, version};
use trackbed_io::failure::Failure;

/// Scene, or the sentences of its errors.
type Loaded = Result<Preview, Vec<String>>;
/// Report of a scene.
pub type Check = fn(&Source) -> Result<String, Failure>;

/// Preview of an exported page.
pub struct Still(pub Preview);

impl Blocks for Still {
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure> {
        Ok(match name {
            "scene" => Some(scene(Ok(&self.0), "", &self.0.title, false)),
            "model" => Some(model(&self.0, Coding::Compact)),
            _ => None,
        })
    }

    fn names(&self) -> Result<Vec<String>, Failure> {
        Ok(["scene", "model"].map(String::from).into())
    }
}

/// Preview that follows its files.
pub struct Live {
    shared: Arc<Shared>,
    check: Check,
    checks: AtomicUsize,
}

/// Longest wait of a request for the scene that is being read.
const WAIT: Duration = Duration::from_secs(2);
/// Most parallel checks, fewer than the server's threads.
const CHECKS: usize = 2;

struct Shared {
    source: Source,
    state: Mutex<State>,
    ended: Condvar,
}

struct State {
    latest: Arc<Latest>,
    /// Whether a thread reads the changed scene.
    reading: bool,
}

struct Latest {
    version: String,
    files: Vec<PathBuf>,
    loaded: Loaded,
}

impl Latest {
    fn of(source: &Source, known: &[PathBuf]) -> Latest {
        let mut files = source.files();
        // A broken file names no others.
        files.extend(known.iter().filter(|file| !files.contains(file)).cloned().collect::<Vec<_>>());
        let version = version(&files);
        let loaded = source.resolve().and_then(|(document, job)| Preview::new(&document, &job));
        Latest { version, files, loaded: loaded.map_err(|failure| failure.sentences()) }
    }
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends a reading, also after a panic.
struct Reading(Arc<Shared>);

impl Drop for Reading {
    fn drop(&mut self) {
        self.0.state().reading = false;
        self.0.ended.notify_all();
    }
}

/// Ends a check, also after a panic.
struct Checking<'a>(&'a AtomicUsize);

impl Drop for Checking<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Live {
    /// Reads a scene; errors are shown in the page.
    pub fn new(source: Source, check: Check) -> Live {
        let latest = Arc::new(Latest::of(&source, &[]));
        let state = Mutex::new(State { latest, reading: false });
        let shared = Arc::new(Shared { source, state, ended: Condvar::new() });
        Live { shared, check, checks: AtomicUsize::new(0) }
    }

    fn latest(&self) -> Arc<Latest> {
        self.shared.state().latest.clone()
    }

    /// Returns the version of the files; while they are being read, of the last state.
    pub fn version(&self) -> String {
        let (latest, reading) = {
            let state = self.shared.state();
            (state.latest.clone(), state.reading)
        };
        if reading { latest.version.clone() } else { version(&latest.files) }
    }

    /// Returns the title of the page.
    pub fn title(&self) -> String {
        self.shared.source.file.display().to_string()
    }

    fn renewed(&self) -> (Arc<Latest>, bool) {
        let latest = self.latest();
        if version(&latest.files) == latest.version {
            return (latest, false);
        }
        if !std::mem::replace(&mut self.shared.state().reading, true) {
            let reading = Reading(self.shared.clone());
            // Without a thread the last state stays.
            let _ = std::thread::Builder::new().name("scene".into()).spawn(move || {
                let latest = Arc::new(Latest::of(&reading.0.source, &latest.files));
                reading.0.state().latest = latest;
            });
        }
        let ended = self.shared.ended.wait_timeout_while(self.shared.state(), WAIT, |state| state.reading);
        let (state, _) = ended.unwrap_or_else(PoisonError::into_inner);
        (state.latest.clone(), state.reading)
    }

    fn checked(&self) -> Vec<u8> {
        let mut chunk = Chunk::new(Coding::Exact);
        let before = self.checks.fetch_add(1, Ordering::Relaxed);
        let _checking = Checking(&self.checks);
        if before >= CHECKS {
            chunk.meta(
                "text",
                json!("note: other checks of this scene are under way; reload the page later."),
            );
            return chunk.finish();
        }
        match (self.check)(&self.shared.source) {
            Ok(text) => chunk.meta("text", json!(text)),
            Err(failure) => chunk.meta("errors", json!(failure.sentences())),
        }
        chunk.finish()
    }
}

impl Blocks for Live {
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure> {
        let title = self.title();
        Ok(match name {
            "scene" => {
                let (latest, reading) = self.renewed();
                let loaded = latest.loaded.as_ref().map_err(|errors| &errors[..]);
                Some(scene(loaded, &latest.version, &title, reading))
            }
            "model" => self.latest().loaded.as_ref().ok().map(|preview| model(preview, Coding::Exact)),
            "check" => Some(self.checked()),
            _ => None,
        })
    }

    fn names(&self) -> Result<Vec<String>, Failure> {
        Ok(["scene", "model", "check"].map(String::from).into())
    }
}

fn origin(preview: &Preview) -> [f64; 3] {
    [0, 1, 2].map(|k| 0.5 * (preview.bounds[0][k] + preview.bounds[1][k]))
}

fn scene(loaded: Result<&Preview, &[String]>, version: &str, title: &str, reading: bool) -> Vec<u8> {
    let mut chunk = Chunk::new(Coding::Exact);
    let none: [Value; 0] = [];
    for (key, value) in [
        ("title", json!(loaded.map_or(title, |preview| &preview.title))),
        ("status", json!("scene")),
        ("folder", json!("")),
        ("version", json!(version)),
        ("frames", json!([{ "time": 0.0, "parts": none }])),
        ("origin", json!(loaded.map_or([0.0; 3], origin))),
        ("bounds", json!(loaded.map_or([[-1.0; 3], [1.0; 3]], |preview| preview.bounds))),
        ("grainFields", json!(none)),
        ("solidFields", json!(none)),
        ("tables", json!(none)),
        ("errors", json!(loaded.err())),
        ("reading", json!(reading)),
        ("model", json!(loaded.ok().map(about))),
    ] {
        chunk.meta(key, value);
    }
    chunk.finish()
}

fn about(preview: &Preview) -> Value {
    let kinds = KINDS.iter().map(|kind| {
        json!({ "word": kind.word, "label": kind.label, "shown": kind.shown, "opacity": kind.opacity })
    });
    let items = preview.items.iter().map(|item| {
        json!({ "kind": item.kind, "key": item.key, "name": item.name, "count": item.count,
            "colour": format!("#{}", item.colour), "bounds": item.shape.bounds() })
    });
    let warnings = preview
        .warnings
        .iter()
        .map(|warning| json!({ "text": warning.text, "serious": warning.serious, "item": warning.item }));
    json!({ "kinds": kinds.collect::<Vec<_>>(), "items": items.collect::<Vec<_>>(), "warnings": warnings.collect::<Vec<_>>() })
}

fn model(preview: &Preview, coding: Coding) -> Vec<u8> {
    let mut chunk = Chunk::new(coding);
    let origin = origin(preview);
    for (k, item) in preview.items.iter().enumerate() {
        let shape = &item.shape;
        chunk.places(&format!("points/{k}"), &relative(shape.points.as_flattened(), origin), 3);
        chunk.indices(&format!("triangles/{k}"), shape.triangles.as_flattened(), 3);
        chunk.indices(&format!("edges/{k}"), shape.edges.as_flattened(), 2);
        let spheres =
            shape.spheres.iter().flat_map(|[x, y, z, r]| [x - origin[0], y - origin[1], z - origin[2], *r]);
        chunk.exact(&format!("spheres/{k}"), &spheres.collect::<Vec<_>>(), 4);
        chunk.indices(&format!("ids/{k}"), &shape.ids, 1);
    }
    chunk.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_io::scratch::folder;

    fn errors(live: &Live) -> (Vec<String>, bool) {
        let (latest, reading) = live.renewed();
        (latest.loaded.as_ref().err().cloned().unwrap_or_default(), reading)
    }

    #[test]
    fn previous_state_serves_during_reload() {
        let dir = folder("live");
        let file = dir.join("scene.toml");
        std::fs::write(&file, "x = \n").unwrap();
        let live = Live::new(Source::new(&file, &[]), |_| Ok(String::new()));
        let version = live.version();
        let (first, reading) = errors(&live);
        assert!(first[0].contains("scene.toml:1: syntax") && !reading, "{first:?}");
        // Another thread reads.
        live.shared.state().reading = true;
        std::fs::write(&file, "\n\nx = \n").unwrap();
        let begun = std::time::Instant::now();
        assert_eq!(errors(&live), (first, true));
        assert!(begun.elapsed() >= WAIT);
        assert_eq!(live.version(), version);
        drop(Reading(live.shared.clone()));
        assert_ne!(live.version(), version);
        let (second, reading) = errors(&live);
        assert!(second[0].contains("scene.toml:3: syntax") && !reading, "{second:?}");
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
