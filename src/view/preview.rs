//! Blocks of a scene before it runs: `scene` (objects, warnings and errors in `meta`), `model` (geometry) and, if served,
//! `check` (report of `trackbed check`).

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::{Value, json};

use super::chunk::{Blocks, Chunk, Coding};
use super::lines::relative;
use crate::failure::Failure;
use crate::preview::{KINDS, Preview, Source, version};

/// Scene, or the sentences of its errors.
type Loaded = Result<Preview, Vec<String>>;
/// Report of a scene.
pub type Check = fn(&Source) -> Result<String, Failure>;

/// Preview of an exported page.
pub struct Still(pub Preview);

impl Blocks for Still {
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure> {
        Ok(match name {
            "scene" => Some(scene(Ok(&self.0), "", &self.0.title)),
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
    source: Source,
    check: Check,
    latest: Mutex<Arc<Latest>>,
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

impl Live {
    /// Reads a scene; errors are shown in the page.
    pub fn new(source: Source, check: Check) -> Live {
        let latest = Mutex::new(Arc::new(Latest::of(&source, &[])));
        Live { source, check, latest }
    }

    fn latest(&self) -> Arc<Latest> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Returns the version of the files.
    pub fn version(&self) -> String {
        version(&self.latest().files)
    }

    /// Returns the title of the page.
    pub fn title(&self) -> String {
        self.source.file.display().to_string()
    }

    fn renewed(&self) -> Arc<Latest> {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if version(&latest.files) != latest.version {
            *latest = Arc::new(Latest::of(&self.source, &latest.files));
        }
        latest.clone()
    }
}

impl Blocks for Live {
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure> {
        let title = self.title();
        Ok(match name {
            "scene" => {
                let latest = self.renewed();
                let loaded = latest.loaded.as_ref().map_err(|errors| &errors[..]);
                Some(scene(loaded, &latest.version, &title))
            }
            "model" => self.latest().loaded.as_ref().ok().map(|preview| model(preview, Coding::Exact)),
            "check" => {
                let mut chunk = Chunk::new(Coding::Exact);
                match (self.check)(&self.source) {
                    Ok(text) => chunk.meta("text", json!(text)),
                    Err(failure) => chunk.meta("errors", json!(failure.sentences())),
                }
                Some(chunk.finish())
            }
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

fn scene(loaded: Result<&Preview, &[String]>, version: &str, title: &str) -> Vec<u8> {
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
