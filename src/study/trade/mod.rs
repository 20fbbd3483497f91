//! Study of accuracy and cost that is made from a scene.
//!
//! Each setting of the scene is varied alone; the reference has the finest value of each.

mod choices;
mod quantities;

use choices::Choice;
use quantities::table;
use std::path::Path;
use toml::{Table, Value};
use trackbed_input::scene::Document;
use trackbed_input::scene::grains::Grains;
use trackbed_io::failure::Failure;
use trackbed_io::message;

use super::Check;

/// File of the study in its directory.
pub const FILE: &str = "trade.toml";
const MOST_SEEDS: u64 = 1000;
/// Seeds of scenes with random grains.
const SEEDS: u64 = 3;

/// Study of a scene.
#[derive(Debug)]
pub struct Trade {
    table: Table,
    /// Settings that the scene rejects, with reasons.
    pub left_out: Vec<String>,
}

/// Request of such a study.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Scene file.
    pub scene: &'a Path,
    /// Overrides of all runs.
    pub set: &'a [String],
    /// Number of seeds; default 3 with grains at random places.
    pub seeds: Option<u64>,
    /// Largest error of the recommended case; default 0.05.
    pub tolerance: Option<f64>,
    /// Whether only errors are printed.
    pub quiet: bool,
}

impl Trade {
    /// Plans the study; values that `check` rejects are left out.
    ///
    /// # Errors
    /// Input errors of the scene; a scene without settings or results to compare.
    pub fn new(request: &Request<'_>, check: Check<'_>) -> Result<Trade, Failure> {
        let Request { scene: file, set, seeds, tolerance, quiet } = *request;
        let mut document = Document::open(file)?;
        if document.has("scene") {
            let found = format!("{}: found a study with --trade", file.display());
            return Err(Failure::Input(format!("{found}, expected a scene, or no --trade")));
        }
        if let Some(t) = tolerance.filter(|t| !(*t > 0.0 && *t <= 1.0)) {
            return Err(Failure::Input(format!("--tolerance: found {t}, expected above 0, at most 1")));
        }
        if let Some(n) = seeds.filter(|n| *n > MOST_SEEDS) {
            return Err(Failure::Input(format!("--seeds: found {n}, expected at most {MOST_SEEDS}")));
        }
        document.set_all(set)?;
        let scene = document.scene()?;
        check(file, set)?;
        let accepted = |own: &[String]| check(file, &[set, own].concat());
        let mut left_out = Vec::new();
        let mut axes = Vec::new();
        let mut finest = Vec::new();
        let choices = choices::of(&scene);
        if !quiet {
            let count: usize = choices.iter().map(|choice| choice.values.len()).sum();
            message::say(&format!("checking {count} settings of the scene"));
        }
        for Choice { name, values, finest: own } in choices {
            let mut kept = vec![value("own", &[])];
            for (label, overrides) in values {
                match accepted(&overrides) {
                    Ok(()) => kept.push(value(&label, &overrides)),
                    Err(fault) if fault.is_input() => left_out.push(format!("{name}={label}: {fault}")),
                    Err(fault) => return Err(fault),
                }
            }
            if kept.len() > 1 {
                axes.push(table([("name", Value::from(name)), ("values", Value::Array(kept))]));
            }
            if !own.is_empty() && accepted(&[finest.as_slice(), &own].concat()).is_ok() {
                finest.extend(own);
            }
        }
        if axes.is_empty() {
            let expected = "a scene with settings of accuracy, such as time steps or element orders";
            return Err(document.error("scene", "nothing to vary", expected).into());
        }
        let quantities = quantities::of(&document, &scene)?;
        let mut study = Table::new();
        study.insert("title".into(), format!("Accuracy and cost: {}", title(&document)).into());
        study.insert("combine".into(), "one_at_a_time".into());
        study.extend(tolerance.map(|t| ("tolerance".to_string(), Value::from(t))));
        study.insert("base".into(), table([("set", texts(set))]));
        study.insert("reference".into(), table([("set", texts(&finest))]));
        let is_random =
            |g: &Grains| g.fill.is_some() || g.region.is_some() || g.floes.is_some() || g.inlet.is_some();
        let count = seeds.unwrap_or(if scene.grains.iter().any(is_random) { SEEDS } else { 0 });
        if count > 0 {
            let values = (1..=count).map(|k| Value::from(k as i64)).collect();
            study.insert("seeds".into(), table([("values", Value::Array(values))]));
        }
        study.insert("axis".into(), Value::Array(axes));
        study.insert("quantity".into(), Value::Array(quantities));
        Ok(Trade { table: study, left_out })
    }

    /// Returns the study file, with `scene` as the path of the scene.
    pub fn text(&self, scene: &Path) -> String {
        let mut study = self.table.clone();
        study.insert("scene".into(), scene.display().to_string().into());
        let notes = self.left_out.iter().map(|note| format!("# Left out: {}\n", note.replace('\n', " ")));
        notes.collect::<String>() + &study.to_string()
    }
}

fn title(document: &Document) -> String {
    let given = document.value("title").filter(|title| !title.is_empty());
    given.unwrap_or_else(|| document.file().display().to_string()).trim_matches('"').to_string()
}

fn value(label: &str, set: &[String]) -> Value {
    table([("label", label.into()), ("set", texts(set))])
}

fn texts(list: &[String]) -> Value {
    Value::Array(list.iter().map(|text| Value::from(text.as_str())).collect())
}
