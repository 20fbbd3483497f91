//! Element tests of solid materials: one stress point on a path of strain and stress.
//!
//! A `file` is resolved to a `plan`; `point` derives figures from the states, `check` compares them with limits.

mod check;
mod file;
mod outcome;
mod page;
mod plan;
mod point;
mod results;

use check::Check;
use file::ElementFile;
use outcome::Outcome;
use plan::{Named, Plan, Test};
use point::Figures;
use std::path::{Path, PathBuf};
use trackbed_fem::element_test::{self, Segment};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_run::{self as run, Lock};

/// Options of a command.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Results directory; default `results/<name of the file>`.
    pub out: Option<PathBuf>,
    /// Overrides `key.path=value`.
    pub set: Vec<String>,
    /// Overwrite existing results.
    pub force: bool,
}

/// Result of a command.
#[derive(Debug)]
pub struct Finished {
    /// Figures and checks for the terminal.
    pub text: String,
    /// Content of `summary.json`.
    pub json: String,
    /// Failed checks.
    pub failure: Option<Failure>,
}

/// Runs the tests of a file and writes the results.
///
/// # Errors
/// Input and I/O errors, a step that does not converge.
pub fn execute(file: &Path, options: &Options) -> Result<Finished, Failure> {
    let mut document = Document::open(file)?;
    document.set_all(&options.set)?;
    number_materials(&mut document)?;
    let plan = Plan::new(&document, &document.read::<ElementFile>()?)?;
    let dir = options.out.clone().unwrap_or_else(|| run::default_folder(file, &options.set));
    let names = file_names(&plan);
    if !options.force {
        results::refuse_existing(&dir, &names)?;
    }
    let outcomes = outcomes(&plan, &names)?;
    let _lock = Lock::take(&dir)?;
    let json = results::write(&dir, &plan.name, &outcomes)?;
    page::write(&dir, &plan.name, &outcomes)?;
    let text = format!("{}  results are in {}\n", results::text(&plan.name, &outcomes), dir.display());
    Ok(Finished { text, json, failure: failed_checks(&outcomes) })
}

/// Numbers the materials without `id`, which only meshes need.
fn number_materials(document: &mut Document) -> Result<(), Failure> {
    let mut k = 0;
    while document.has(&format!("material.{k}")) {
        let key = format!("material.{k}.id");
        k += 1;
        if !document.has(&key) {
            document.set(&format!("{key}={k}"))?;
        }
    }
    Ok(())
}

/// Names of the tables, in the order of the tests and their materials.
fn file_names(plan: &Plan) -> Vec<String> {
    let label = |test: &Test, k: usize| match test.materials.len() {
        1 => test.name.clone(),
        _ => format!("{}, {}", test.name, plan.materials[k].name),
    };
    let labels = plan.tests.iter().flat_map(|test| test.materials.iter().map(move |k| label(test, *k)));
    let labels: Vec<String> = labels.collect();
    let names = crate::study::file_names(labels.iter().map(String::as_str));
    names.into_iter().map(|name| format!("{name}.csv")).collect()
}

fn outcomes(plan: &Plan, names: &[String]) -> Result<Vec<Outcome>, Failure> {
    let mut outcomes = Vec::new();
    for test in &plan.tests {
        for &k in &test.materials {
            outcomes.push(outcome(test, &plan.materials[k], &names[outcomes.len()])?);
        }
    }
    Ok(outcomes)
}

fn outcome(test: &Test, Named { name, material }: &Named, file: &str) -> Result<Outcome, Failure> {
    let curve = |factor: usize| {
        let finer = |s: &Segment| Segment { steps: factor * s.steps, ..s.clone() };
        let segments: Vec<Segment> = test.segments.iter().map(finer).collect();
        element_test::run(material, &test.initial, &segments).map_err(|failure| {
            let part = if factor > 1 { " with twice the steps" } else { "" };
            Failure::Numerical(format!("test \"{}\", material \"{name}\"{part}: {failure}", test.name))
        })
    };
    let (coarse, fine) = (curve(1)?, curve(2)?);
    let states = point::states(test.kind, &coarse);
    let checks = check::checks(&coarse.checks, &states, &point::states(test.kind, &fine));
    Ok(Outcome {
        test: test.name.clone(),
        material: name.clone(),
        kind: test.kind,
        file: file.into(),
        figures: Figures::of(test.kind, &states, test.segments[0].steps),
        states,
        checks,
    })
}

fn failed_checks(outcomes: &[Outcome]) -> Option<Failure> {
    let failed = outcomes.iter().flat_map(|outcome| {
        let lines = outcome.checks.iter().filter(|check| check.has_failed()).map(Check::line);
        lines.map(|line| format!("test \"{}\", material \"{}\": {line}", outcome.test, outcome.material))
    });
    let lines: Vec<String> = failed.collect();
    (!lines.is_empty()).then(|| Failure::Numerical(lines.join("; ")))
}
