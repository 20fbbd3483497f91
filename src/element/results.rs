//! Files and text of element tests.

use super::file::Kind;
use super::outcome::Outcome;
use super::point::{Figures, State};
use serde_json::{Value, json};
use std::path::Path;
use trackbed_io::columns::element as columns;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{History, Row};
use trackbed_io::write::{WriteError, atomic};

/// Summary of all tests.
const SUMMARY: &str = "summary.json";
/// Page of all tests.
pub const PAGE: &str = "element.html";

/// Rejects results of an earlier command.
///
/// # Errors
/// Input error.
pub fn refuse_existing(dir: &Path, tables: &[String]) -> Result<(), Failure> {
    let mut files = [SUMMARY, PAGE].into_iter().chain(tables.iter().map(String::as_str));
    match files.find(|name| dir.join(name).exists()) {
        None => Ok(()),
        Some(name) => {
            let expected = "another --out, or --force to overwrite files of the same names";
            Err(Failure::Input(format!("{}: found {name}, expected {expected}", dir.display())))
        }
    }
}

/// Writes tables and summary; returns the summary.
///
/// # Errors
/// I/O errors.
pub fn write(dir: &Path, name: &str, outcomes: &[Outcome]) -> Result<String, Failure> {
    for outcome in outcomes {
        let columns = Row::columns_of(|row| fill(row, &outcome.states[0]));
        let mut table = History::create(&dir.join(&outcome.file), columns)?;
        for state in &outcome.states {
            table.row(&Row::values_of(|row| fill(row, state)))?;
        }
    }
    let text = format!("{:#}\n", summary(name, outcomes));
    let file = dir.join(SUMMARY);
    atomic::write(&file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(&file)))?;
    Ok(text)
}

fn fill(row: &mut Row, state: &State) {
    row.put(columns::STEP, state.step as f64);
    row.put(columns::AXIAL_STRAIN, state.strain[2]);
    row.put(columns::VOLUMETRIC_STRAIN, state.volumetric());
    row.put(columns::DEVIATORIC_STRAIN, state.deviatoric());
    row.put(columns::P, state.p());
    row.put(columns::Q, state.q);
    row.tensor(columns::STRESS, state.stress);
    row.tensor(columns::STRAIN, state.strain);
    row.put(columns::EQUIVALENT_PLASTIC_STRAIN, state.kappa);
    row.put(columns::PLASTIC_WORK, state.plastic_work);
    row.put(columns::PORE_PRESSURE, state.pore_pressure);
}

fn summary(name: &str, outcomes: &[Outcome]) -> Value {
    let test = |outcome: &Outcome| {
        json!({
            "test": outcome.test,
            "material": outcome.material,
            "kind": outcome.kind,
            "file": outcome.file,
            "figures": outcome.figures,
            "checks": outcome.checks,
        })
    };
    json!({ "name": name, "tests": outcomes.iter().map(test).collect::<Vec<_>>() })
}

/// Formats figures and checks for the terminal.
pub fn text(name: &str, outcomes: &[Outcome]) -> String {
    let mut text = format!("{name}\n");
    for outcome in outcomes {
        text += &format!("  {}: {}\n", outcome.label(), figures(outcome.kind, &outcome.figures));
        for check in &outcome.checks {
            text += &format!("    {}\n", check.line());
        }
    }
    text
}

/// Name of the strain on the abscissa.
pub fn strain_name(kind: Kind) -> &'static str {
    match kind {
        Kind::SimpleShear => "shear strain",
        Kind::Path => "deviatoric strain",
        _ => "axial strain",
    }
}

fn figures(kind: Kind, figures: &Figures) -> String {
    let kilopascal = |value: f64| format!("{:.2} kPa", 1e-3 * value);
    let megapascal = |value: f64| format!("{:.2} MPa", 1e-6 * value);
    // Not -0.00.
    let degrees = |angle: f64| format!("{:.2} deg", (1e2 * angle.to_degrees()).round() / 1e2 + 0.0);
    let strain = strain_name(kind);
    let mut parts =
        vec![format!("peak q {} at {:.2} % {strain}", kilopascal(figures.peak_q), 1e2 * figures.peak_strain)];
    let others = [
        ("friction angle at peak", figures.friction_peak.map(degrees)),
        ("at end", figures.friction_end.map(degrees)),
        ("stiffness at start", figures.stiffness_start.map(megapascal)),
        ("at 50 %", figures.stiffness_50.map(megapascal)),
        ("dilation angle", figures.dilation.map(degrees)),
        ("pore pressure at end", figures.pore_pressure.map(kilopascal)),
    ];
    parts.extend(others.into_iter().filter_map(|(name, value)| Some(format!("{name} {}", value?))));
    parts.join(", ")
}
