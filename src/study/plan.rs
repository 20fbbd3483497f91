//! Runs of a study: parameter sets times seeds.

use super::axis::{Axis, MOST_RUNS, Setting, combine};
use super::extreme::{self, Extreme};
use super::factor::Factor;
use super::file::{Combine, StudyFile};
use super::hazard::{self, Hazard};
use super::label::file_names;
use super::parameter::{self, Samples};
use super::quantity::{self, Quantity};
use super::target::{self, Target};
use std::collections::BTreeSet;
use std::path::PathBuf;
use trackbed_input::scene::{Document, Problem, SceneError};
use trackbed_io::failure::Failure;

const REFERENCE: &str = "reference";
/// Default tolerance of the recommended set [-].
const TOLERANCE: f64 = 0.05;

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
    /// Column headers of the varied parameters.
    pub axes: Vec<String>,
    /// Varied parameters.
    pub factors: Vec<Factor>,
    /// Parameter values of each set; none of a separate reference.
    pub coordinates: Vec<Vec<Option<f64>>>,
    /// Combination of axes; none for sampled parameters.
    pub combine: Option<Combine>,
    /// Measured values.
    pub targets: Vec<Target>,
    /// Quantities with values of return periods.
    pub extremes: Vec<Extreme>,
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
    /// Hazard maps.
    pub hazard: Option<Hazard>,
}

impl Plan {
    /// Resolves a study.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, file: &StudyFile) -> Result<Plan, Failure> {
        let tolerance = file.tolerance.unwrap_or(TOLERANCE);
        if !(tolerance > 0.0 && tolerance <= 1.0) {
            return Err(document.error("tolerance", tolerance.to_string(), "above 0, at most 1").into());
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
        let cases = cases(document, file)?;
        let opened = Document::open(&scene).map_err(|e| of_setting(document, "base", &e))?;
        let Cases { axes, factors, coordinates, settings, reference, combine } = cases;
        let runs = runs(document, file, &opened, &settings)?;
        let cycles =
            scene_has_cycles(&opened, &file.base.set).map_err(|e| of_setting(document, "base", &e))?;
        let quantities = quantity::resolve(document, &file.quantity, cycles, tolerance)?;
        if combine.is_none() {
            quantity::reject_errors(document, &file.quantity)?;
            let named = |factor: &Factor| quantities.iter().any(|q| q.name == factor.name);
            if let Some(k) = factors.iter().position(named) {
                let found = format!("{:?}, the name of a quantity", factors[k].name);
                let sampled = file.parameter.len();
                let place = match k.checked_sub(sampled) {
                    None => format!("parameter.{k}.name"),
                    Some(k) => format!("axis.{k}.name"),
                };
                return Err(document.error(&place, found, "distinct names").into());
            }
        }
        let targets = target::resolve(document, &file.target, &quantities)?;
        let seeds = file.seeds.as_ref().map_or(1, |seeds| seeds.values.len());
        let extremes = extreme::resolve(document, &file.extreme, &quantities, seeds)?;
        let jobs = file.jobs;
        let hazard = hazard::resolve(document, file.hazard.as_ref(), file.parameter.len())?;
        Ok(Plan {
            title,
            scene,
            axes,
            factors,
            coordinates,
            combine,
            targets,
            extremes,
            settings,
            reference,
            runs,
            quantities,
            tolerance,
            jobs,
            hazard,
        })
    }

    /// Whether cases are compared with a reference.
    pub fn has_reference(&self) -> bool {
        self.combine.is_some()
    }
}

struct Cases {
    axes: Vec<String>,
    factors: Vec<Factor>,
    coordinates: Vec<Vec<Option<f64>>>,
    settings: Vec<Setting>,
    reference: usize,
    combine: Option<Combine>,
}

fn cases(document: &Document, file: &StudyFile) -> Result<Cases, SceneError> {
    let samples = parameter::resolve(document, file)?;
    let axes: Vec<Axis> =
        (0..file.axis.len()).map(|k| Axis::new(document, k, &file.axis[k])).collect::<Result<Vec<_>, _>>()?;
    if let Some(samples) = samples {
        return sampled(document, file, &axes, samples);
    }
    if axes.is_empty() && file.seeds.is_none() {
        let expected = "at least one [[axis]] or [[parameter]], or [seeds]";
        return Err(document.error("axis", "nothing", expected));
    }
    let mut settings = combine(document, file, &axes)?;
    let reference = reference(document, file, &mut settings)?;
    reject_twins(document, &settings)?;
    let (factors, columns): (Vec<Factor>, Vec<Vec<Option<f64>>>) =
        axes.iter().enumerate().map(|(k, axis)| Factor::of_axis(&axis.name, k, &settings)).unzip();
    let coordinates = (0..settings.len()).map(|row| columns.iter().map(|c| c[row]).collect()).collect();
    let axes = axes.into_iter().map(|a| a.name).collect();
    let combine = Some(file.combine.unwrap_or_default());
    Ok(Cases { axes, factors, coordinates, settings, reference, combine })
}

fn reject_twins(document: &Document, settings: &[Setting]) -> Result<(), SceneError> {
    let mut labels = BTreeSet::new();
    match settings.iter().find(|s| !labels.insert(s.label.as_str())) {
        None => Ok(()),
        Some(twice) => {
            let found = format!("the case \"{}\" twice", twice.label);
            Err(document.error("axis", found, "cases with distinct labels"))
        }
    }
}

/// All samples at each case of the axes.
fn sampled(
    document: &Document,
    file: &StudyFile,
    axes: &[Axis],
    samples: Samples,
) -> Result<Cases, SceneError> {
    let cases = combine(document, file, axes)?;
    reject_twins(document, &cases)?;
    if cases.len().saturating_mul(samples.settings.len()) > MOST_RUNS {
        return Err(document.error("axis", "too many runs", format!("at most {MOST_RUNS}")));
    }
    let together = |case: &Setting, sample: &Setting| Setting {
        label: match axes {
            [] => sample.label.clone(),
            _ => format!("{}, {}", case.label, sample.label),
        },
        levels: sample.levels.iter().chain(&case.levels).cloned().collect(),
        set: case.set.iter().chain(&sample.set).cloned().collect(),
    };
    let each = || cases.iter().flat_map(|case| samples.settings.iter().map(move |sample| (case, sample)));
    let settings: Vec<Setting> = each().map(|(case, sample)| together(case, sample)).collect();
    let count = samples.factors.len();
    let (of_axes, columns): (Vec<Factor>, Vec<Vec<Option<f64>>>) =
        axes.iter().enumerate().map(|(k, axis)| Factor::of_axis(&axis.name, count + k, &settings)).unzip();
    let row = |k: usize| {
        let own = samples.values[k % samples.values.len()].iter().copied().map(Some);
        own.chain(columns.iter().map(|column| column[k])).collect()
    };
    let coordinates = (0..settings.len()).map(row).collect();
    let factors: Vec<Factor> = samples.factors.into_iter().chain(of_axes).collect();
    if let Some(k) = (1..factors.len()).find(|k| factors[..*k].iter().any(|f| f.name == factors[*k].name)) {
        let found = format!("\"{}\" twice", factors[k].name);
        return Err(document.error(&format!("axis.{}.name", k - count), found, "distinct names"));
    }
    Ok(Cases {
        axes: factors.iter().map(Factor::head).collect(),
        factors,
        coordinates,
        settings,
        reference: 0,
        combine: None,
    })
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
    scene: &Document,
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
            runs.push(Run { folder: String::new(), label, setting: k, set });
        };
        if seeds.is_empty() {
            add(setting.label.clone(), setting.set.clone());
            continue;
        }
        let keys = match file.seeds.as_ref().and_then(|s| s.keys.clone()) {
            Some(keys) => keys,
            None => seed_keys(scene, &setting.set).map_err(|e| of_setting(document, &setting.label, &e))?,
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
    let folders = file_names(runs.iter().map(|run| run.label.as_str()));
    runs.iter_mut().zip(folders).for_each(|(run, folder)| run.folder = folder);
    Ok(runs)
}

/// Seeds of grain groups and every other `seed`.
///
/// # Errors
/// Wrong overrides.
pub fn seed_keys(scene: &Document, set: &[String]) -> Result<Vec<String>, SceneError> {
    let mut document = scene.clone();
    document.set_all(set)?;
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

fn scene_has_cycles(scene: &Document, set: &[String]) -> Result<bool, SceneError> {
    let mut document = scene.clone();
    document.set_all(set)?;
    let scene = document.scene()?;
    Ok(scene.track.is_some_and(|track| track.load.is_some()))
}

#[cfg(test)]
#[path = "plan_tests.rs"]
mod tests;
