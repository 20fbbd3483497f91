//! Result blocks of a run by name:
//!
//! | name | block |
//! |---|---|
//! | `scene` | title, times, parts, fields, origin, size: JSON in `meta` |
//! | `grains`, `solid` | data common to all frames |
//! | `grains/7`, `chains/7`, `walls/7`, `solid/7` | frame 7 |
//! | `grains/7/speed`, `walls/7/speed`, `solid/7/stress_zz` | field of frame 7 (walls: polyhedral grains) |
//! | `table/history` | table |

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use serde_json::{Value, json};

use super::chunk::{Blocks, Chunk, Coding};
use super::{grains, lines, names, solid, tables};
use crate::water::Surface;
use trackbed_io::failure::Failure;
use trackbed_io::results::grains::{Bodies, GrainFile};
use trackbed_io::results::lines::{Chains, Walls};
use trackbed_io::results::series::{self, Frame, PARTS, Part};
use trackbed_io::results::solid::{Skin, fields};

/// Results of a run.
pub struct Results {
    dir: PathBuf,
    coding: Coding,
    /// Frames.
    pub frames: Vec<Frame>,
    common: OnceLock<Common>,
    /// Last grain file: its fields are requested one by one.
    latest: Mutex<Option<(PathBuf, Arc<GrainFile>)>>,
}

struct Common {
    origin: [f64; 3],
    bounds: [[f64; 3]; 2],
    bodies: Option<Bodies>,
    grain_fields: Vec<String>,
    stone_fields: Vec<String>,
    skin: Option<Skin>,
    solid_fields: Vec<String>,
}

impl Common {
    /// From the first frames with grains and with a solid.
    fn of(frames: &[Frame]) -> Result<Common, Failure> {
        let first = |part: Part| frames.iter().find_map(|frame| frame.file(part));
        let (mut bodies, mut grain_fields, mut bounds) = (None, Vec::new(), Vec::new());
        if let Some(file) = first(Part::Grains) {
            let file = GrainFile::open(file)?;
            grain_fields = file.fields();
            bounds.extend(file.bounds());
            bodies = Some(file.bodies);
        }
        let mut stone_fields = Vec::new();
        if let Some(file) = first(Part::Walls) {
            stone_fields = Walls::open(file)?.fields();
            let more = stone_fields.iter().filter(|f| !grain_fields.contains(f)).cloned().collect::<Vec<_>>();
            grain_fields.extend(more);
        }
        let skin = first(Part::Solid).map(Skin::open).transpose()?;
        bounds.extend(skin.as_ref().map(Skin::bounds));
        let solid_fields = first(Part::Solid).map(fields).transpose()?.unwrap_or_default();
        let whole = |a: [[f64; 3]; 2], b: [[f64; 3]; 2]| {
            [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))]
        };
        let bounds = bounds.into_iter().reduce(whole).unwrap_or([[-1.0; 3], [1.0; 3]]);
        let origin = [0, 1, 2].map(|k| 0.5 * (bounds[0][k] + bounds[1][k]));
        Ok(Common { origin, bounds, bodies, grain_fields, stone_fields, skin, solid_fields })
    }
}

impl Results {
    /// Opens a results directory.
    ///
    /// # Errors
    /// No frames.
    pub fn open(dir: &Path, coding: Coding) -> Result<Results, Failure> {
        let frames = series::read(dir)?;
        Ok(Results {
            dir: dir.to_path_buf(),
            coding,
            frames,
            common: OnceLock::new(),
            latest: Mutex::default(),
        })
    }

    /// Keeps every `n`-th frame and the last.
    #[must_use]
    pub fn every(mut self, n: usize) -> Results {
        let last = self.frames.len().saturating_sub(1);
        let mut k = 0;
        self.frames.retain(|_| {
            k += 1;
            (k - 1) % n == 0 || k - 1 == last
        });
        self
    }

    fn common(&self) -> Result<&Common, Failure> {
        if let Some(common) = self.common.get() {
            return Ok(common);
        }
        let made = Common::of(&self.frames)?;
        Ok(self.common.get_or_init(|| made))
    }

    fn whole(&self, part: Part, common: &Common) -> Option<Vec<u8>> {
        match part {
            Part::Grains => common.bodies.as_ref().map(|bodies| grains::common(bodies, self.coding)),
            Part::Solid => common.skin.as_ref().map(|skin| solid::common(skin, common.origin, self.coding)),
            _ => None,
        }
    }

    fn frame(
        &self,
        file: &Path,
        part: Part,
        field: Option<&str>,
        common: &Common,
    ) -> Result<Vec<u8>, Failure> {
        match (part, field) {
            (Part::Grains, None) => {
                let read = self.grains(file)?;
                Ok(grains::frame(&read, common.bodies.as_ref(), common.origin, self.coding))
            }
            (Part::Grains, Some(field)) => Ok(solid::field(&self.grains(file)?.field(field)?, self.coding)),
            (Part::Solid, field) => {
                let skin = common.skin.as_ref().ok_or_else(|| Failure::Other("no mesh".to_string()))?;
                Ok(match field {
                    None => solid::displacement(&skin.displacement(file)?, self.coding),
                    Some(field) => solid::field(&skin.field(file, field)?, self.coding),
                })
            }
            (Part::Chains, _) => Ok(lines::chains(&Chains::open(file)?, common.origin, self.coding)),
            (Part::Walls, _) => Ok(lines::walls(&Walls::open(file)?, common.origin, self.coding)),
        }
    }

    fn grains(&self, file: &Path) -> Result<Arc<GrainFile>, Failure> {
        let latest = || self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, grains)) = latest().as_ref().filter(|(of, _)| of == file) {
            return Ok(grains.clone());
        }
        // Lock released: reading a million grains takes a second.
        let grains = Arc::new(GrainFile::open(file)?);
        *latest() = Some((file.to_path_buf(), grains.clone()));
        Ok(grains)
    }

    fn scene(&self) -> Result<Vec<u8>, Failure> {
        let common = self.common()?;
        let about = series::About::of(&self.dir);
        let frames: Vec<Value> = self
            .frames
            .iter()
            .map(|frame| {
                let parts = PARTS.iter().filter(|(part, _)| frame.file(*part).is_some());
                json!({ "time": frame.time, "parts": parts.map(|(_, word)| *word).collect::<Vec<_>>() })
            })
            .collect();
        let tables = tables::TABLES.iter().filter(|t| series::own(&self.dir, &format!("{t}.csv")).is_some());
        let mut chunk = Chunk::new(self.coding);
        chunk.meta("title", json!(about.title));
        chunk.meta("status", json!(about.status));
        chunk.meta("folder", json!(about.folder));
        chunk.meta("frames", json!(frames));
        chunk.meta("origin", json!(common.origin));
        chunk.meta("bounds", json!(common.bounds));
        chunk.meta("grainFields", json!(common.grain_fields));
        chunk.meta("solidFields", json!(common.solid_fields));
        chunk.meta("tables", json!(tables.collect::<Vec<_>>()));
        let [groups, materials, lines] = names::of_run(&self.dir);
        chunk.meta("groups", groups);
        chunk.meta("materials", materials);
        chunk.meta("lines", lines);
        chunk.meta("water", json!(Surface::of_run(&self.dir, &self.frames)?.map(|water| water.about())));
        Ok(chunk.finish())
    }
}

impl Blocks for Results {
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure> {
        let mut words = name.splitn(3, '/');
        let (head, number, field) = (words.next().unwrap_or_default(), words.next(), words.next());
        if head == "scene" && number.is_none() {
            return self.scene().map(Some);
        }
        if head == "table" {
            let known = tables::TABLES.into_iter().find(|t| Some(*t) == number);
            let file = known.and_then(|t| series::own(&self.dir, &format!("{t}.csv")));
            return file.map(|file| tables::table(&file)).transpose();
        }
        let Some((part, _)) = PARTS.into_iter().find(|(_, word)| *word == head) else { return Ok(None) };
        let common = self.common()?;
        let Some(number) = number else { return Ok(self.whole(part, common)) };
        let frame = number.parse::<usize>().ok().and_then(|k| self.frames.get(k));
        let Some(file) = frame.and_then(|frame| frame.file(part)) else { return Ok(None) };
        if let (Part::Walls, Some(field)) = (part, field) {
            let values = Walls::open(file)?.field(field)?;
            return Ok(values.map(|values| solid::field(&values, self.coding)));
        }
        self.frame(file, part, field, common).map(Some)
    }

    fn names(&self) -> Result<Vec<String>, Failure> {
        let common = self.common()?;
        let mut names: Vec<String> = ["scene", "grains", "solid"].map(String::from).into();
        names.extend(tables::TABLES.iter().map(|t| format!("table/{t}")));
        for (k, frame) in self.frames.iter().enumerate() {
            for (part, word) in PARTS.iter().filter(|(part, _)| frame.file(*part).is_some()) {
                names.push(format!("{word}/{k}"));
                let fields = match part {
                    Part::Grains => &common.grain_fields[..],
                    Part::Solid => &common.solid_fields[..],
                    Part::Walls => &common.stone_fields[..],
                    _ => &[],
                };
                names.extend(fields.iter().map(|field| format!("{word}/{k}/{field}")));
            }
        }
        Ok(names)
    }
}
