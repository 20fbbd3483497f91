//! Runs of a study: parameter sets times seeds.

use super::axis::{Axis, MOST_RUNS, Setting, combine};
use super::file::StudyFile;
use super::label::folder_name;
use super::quantity::{self, Quantity};
use crate::failure::Failure;
use crate::scene::{Document, Problem, Scene, SceneError};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const REFERENCE: &str = "reference";

/// Run: set and seed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Label.
    pub label: String,
    /// Directory name.
    pub folder: String,
    /// Set index.
    pub setting: usize,
    /// Overrides.
    pub set: Vec<String>,
}

/// Resolved study.
#[derive(Debug)]
pub struct Plan {
    /// Title.
    pub title: String,
    /// Scene.
    pub scene: PathBuf,
    /// Axis names.
    pub axes: Vec<String>,
    /// Parameter sets.
    pub settings: Vec<Setting>,
    /// Reference index.
    pub reference: usize,
    /// Runs, grouped by set.
    pub runs: Vec<Run>,
    /// Quantities.
    pub quantities: Vec<Quantity>,
    /// Default tolerance of the recommended set.
    pub tolerance: f64,
    /// Concurrent runs, if given.
    pub jobs: Option<usize>,
}

impl Plan {
    /// Resolves a study.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, file: &StudyFile) -> Result<Plan, Failure> {
        if !(file.tolerance > 0.0 && file.tolerance <= 1.0) {
            return Err(document.error("tolerance", file.tolerance.to_string(), "above 0, at most 1").into());
        }
        if let Some(jobs) = file.jobs.filter(|n| *n == 0) {
            return Err(document.error("jobs", jobs.to_string(), "at least 1").into());
        }
        let scene = document.resolve(&file.scene);
        if !scene.is_file() {
            return Err(document.error("scene", format!("{:?}", file.scene), "a scene file").into());
        }
        let title =
            if file.title.is_empty() { format!("{}", file.scene.display()) } else { file.title.clone() };
        let axes = (0..file.axis.len())
            .map(|k| Axis::new(document, k, &file.axis[k]))
            .collect::<Result<Vec<_>, _>>()?;
        if axes.is_empty() && file.seeds.is_none() {
            return Err(document.error("axis", "nothing", "at least one [[axis]], or [seeds]").into());
        }
        let mut settings = combine(document, file, &axes)?;
        let reference = reference(document, file, &mut settings)?;
        let mut labels = BTreeSet::new();
        if let Some(twice) = settings.iter().find(|s| !labels.insert(s.label.as_str())) {
            let found = format!("the case \"{}\" twice", twice.label);
            return Err(document.error("axis", found, "cases with distinct labels").into());
        }
        let runs = runs(document, file, &scene, &settings)?;
        let cycles =
            scene_has_cycles(&scene, &file.base.set).map_err(|e| of_setting(document, "base", &e))?;
        let quantities = quantity::resolve(document, &file.quantity, cycles, file.tolerance)?;
        let axes = axes.into_iter().map(|a| a.name).collect();
        let (tolerance, jobs) = (file.tolerance, file.jobs);
        Ok(Plan { title, scene, axes, settings, reference, runs, quantities, tolerance, jobs })
    }
}

/// A separate reference is inserted first.
fn reference(
    document: &Document,
    file: &StudyFile,
    settings: &mut Vec<Setting>,
) -> Result<usize, SceneError> {
    let Some(reference) = &file.reference else { return Ok(0) };
    match (&reference.label, &reference.set) {
        (Some(label), None) => settings.iter().position(|s| s.label == *label).ok_or_else(|| {
            let labels: Vec<String> = settings.iter().map(|s| format!("\"{}\"", s.label)).collect();
            document.error("reference.label", format!("\"{label}\""), format!("one of {}", labels.join(", ")))
        }),
        (None, Some(own)) => {
            let set = file.base.set.iter().chain(own).cloned().collect();
            settings.insert(0, Setting { label: REFERENCE.into(), levels: Vec::new(), set });
            Ok(0)
        }
        (Some(_), Some(_)) => Err(document.problem("reference.label", Problem::conflict("`set`"))),
        (None, None) => Err(document.problem("reference", Problem::missing("`label` or `set`"))),
    }
}

fn runs(
    document: &Document,
    file: &StudyFile,
    scene: &Path,
    settings: &[Setting],
) -> Result<Vec<Run>, Failure> {
    let seeds = match &file.seeds {
        None => Vec::new(),
        Some(seeds) => {
            let distinct: BTreeSet<u64> = seeds.values.iter().copied().collect();
            if seeds.values.is_empty() || distinct.len() < seeds.values.len() {
                let found = format!("{:?}", seeds.values);
                return Err(document.error("seeds.values", found, "at least one seed, each once").into());
            }
            seeds.values.clone()
        }
    };
    if settings.len().saturating_mul(seeds.len().max(1)) > MOST_RUNS {
        return Err(document.error("axis", "too many runs", format!("at most {MOST_RUNS}")).into());
    }
    let mut runs = Vec::new();
    for (k, setting) in settings.iter().enumerate() {
        let mut add = |label: String, set| {
            runs.push(Run { folder: folder_name(&label), label, setting: k, set });
        };
        if seeds.is_empty() {
            add(setting.label.clone(), setting.set.clone());
            continue;
        }
        let keys = match file.seeds.as_ref().and_then(|s| s.keys.clone()) {
            Some(keys) => keys,
            None => seed_keys(scene, setting).map_err(|e| of_setting(document, &setting.label, &e))?,
        };
        if keys.is_empty() {
            let found = "nothing, and a scene without grains and without keys `seed`";
            return Err(document.error("seeds.keys", found, "the keys that seeds are given to").into());
        }
        for seed in &seeds {
            let own = keys.iter().map(|key| format!("{key}={seed}"));
            let label = format!("{}, seed={seed}", setting.label);
            add(label, setting.set.iter().cloned().chain(own).collect());
        }
    }
    Ok(runs)
}

/// Seeds of grain groups and every other `seed`.
fn seed_keys(scene: &Path, setting: &Setting) -> Result<Vec<String>, SceneError> {
    let mut document = Document::open(scene)?;
    setting.set.iter().try_for_each(|assignment| document.set(assignment))?;
    let tree: toml::Table = document.read()?;
    let mut keys = BTreeSet::new();
    for (key, value) in &tree {
        gather(key, value, &mut keys);
    }
    let groups = tree.get("grains").and_then(toml::Value::as_array).map_or(0, Vec::len);
    keys.extend((0..groups).map(|k| format!("grains.{k}.seed")));
    Ok(keys.into_iter().collect())
}

fn gather(path: &str, value: &toml::Value, keys: &mut BTreeSet<String>) {
    if path.ends_with(".seed") && value.is_integer() {
        keys.insert(path.to_string());
    }
    if let Some(table) = value.as_table() {
        table.iter().for_each(|(key, inner)| gather(&format!("{path}.{key}"), inner, keys));
    }
    for (k, inner) in value.as_array().into_iter().flatten().enumerate() {
        gather(&format!("{path}.{k}"), inner, keys);
    }
}

/// Adds study file and label to a scene error.
pub fn of_setting(document: &Document, label: &str, fault: &impl std::fmt::Display) -> Failure {
    Failure::Input(format!("{}: \"{label}\": {fault}", document.file().display()))
}

fn scene_has_cycles(scene: &Path, set: &[String]) -> Result<bool, SceneError> {
    let mut document = Document::open(scene)?;
    set.iter().try_for_each(|assignment| document.set(assignment))?;
    let scene: Scene = document.read()?;
    Ok(scene.track.is_some_and(|track| track.load.is_some()))
}

#[cfg(test)]
#[path = "plan_tests.rs"]
mod tests;
