//! Steps, windows, coupling, and stage times.

use super::overlay::facts;
use crate::data::RunData;
use crate::page::{Cell, Section, table};
use maud::{Markup, html};
use serde_json::Value;

/// Longest bar [px].
const BAR: f64 = 220.0;

/// Formats steps and windows.
pub fn steps(runs: &[RunData]) -> Option<Section> {
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let text = |path: &'static str| move |r: &RunData| r.text(path).map_or(Cell::Nothing, Cell::text);
    let sum = |key: &'static str| {
        move |r: &RunData| {
            let all: f64 = r.list("stages").iter().filter_map(|s| s[key].as_f64()).sum();
            Cell::of((all > 0.0).then_some(all), "")
        }
    };
    let scheme = |r: &RunData| match r.value("coupling.scheme") {
        Value::Null => Cell::Nothing,
        Value::String(name) => Cell::text(name),
        other => Cell::Text(other.to_string()),
    };
    let html = facts(
        runs,
        &[
            ("DEM time step at the end", &path("model.grain_step", "s")),
            ("critical DEM time step", &path("model.grain_step_limit", "s")),
            ("set by", &text("model.grain_step_set_by")),
            ("FEM time step", &path("model.solid_step", "s")),
            ("DEM time steps, all stages", &sum("grain_steps")),
            ("FEM time steps, all stages", &sum("solid_steps")),
            ("coupling scheme", &scheme),
            ("DEM sub-steps per coupling window", &path("coupling.substeps", "")),
            ("windows", &path("coupling.passes.windows", "")),
            ("coupling iterations", &path("coupling.passes.passes", "")),
            ("windows not converged", &path("coupling.passes.unconverged", "")),
            ("coupling stability: stiffness W", &path("coupling.stability.stiffness", "")),
            ("coupling stability: damping D", &path("coupling.stability.damping", "")),
            ("transfer of contact forces", &text("coupling.transfer_kind")),
        ],
    );
    Section::new("steps", "Time steps and coupling windows", html)
}

fn bar(width: f64, share: f64) -> Markup {
    html! { span class="bar" style={ "width:" (width) "px" } {} " " (format!("{share:.0}")) " %" }
}

/// Formats wall times of stages.
pub fn timings(runs: &[RunData]) -> Option<Section> {
    let seconds = |s: &Value| s["seconds"].as_f64().unwrap_or(0.0);
    let longest = runs.iter().flat_map(|r| r.list("stages")).map(seconds).fold(0.0, f64::max);
    let mut rows = Vec::new();
    for run in runs {
        let all: f64 = run.list("stages").iter().map(seconds).sum();
        for s in run.list("stages") {
            let stage = s["name"].as_str().unwrap_or_default();
            let name = if runs.len() > 1 { format!("{}: {stage}", run.label) } else { stage.to_string() };
            let count = |key: &str| Cell::of(s[key].as_f64().filter(|v| *v > 0.0), "");
            let width = (BAR * seconds(s) / longest.max(f64::MIN_POSITIVE)).round();
            let share = 100.0 * seconds(s) / all.max(f64::MIN_POSITIVE);
            rows.push((
                name,
                vec![
                    Cell::of(s["seconds"].as_f64(), "s"),
                    Cell::Html(bar(width, share)),
                    count("grain_steps"),
                    count("solid_steps"),
                    count("windows"),
                ],
            ));
        }
    }
    let heads = ["stage", "wall time", "fraction", "DEM steps", "FEM steps", "windows"];
    Section::new("timings", "Time of stages", table(&heads, &rows))
}
