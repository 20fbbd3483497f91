//! Inflow and outflow: inventory and mass flow.

use super::overlay::{facts, one, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, joined, plots, table};
use crate::plot::{Axis, figure};
use trackbed_io::columns::history;

const STRETCHES: usize = 40;

/// Formats inlets and outlets.
pub fn flow(runs: &[RunData]) -> Option<Section> {
    let mass = overlay(runs, |run| {
        let Some(table) = run.table("history") else { return Vec::new() };
        let of = |(name, column): (&str, _)| Some((name.to_string(), table.points(history::TIME, column)?));
        [("present", history::MASS_PRESENT), ("inserted", history::MASS_IN), ("removed", history::MASS_OUT)]
            .into_iter()
            .filter_map(of)
            .collect()
    });
    let time = || Axis::new("time", "s");
    let figures = plots([
        figure("Mass of grains", time(), Axis::new("mass", "kg").with_zero(), mass),
        figure("Mass flow out", time(), Axis::new("mean rate", "kg/s").with_zero(), one(runs, rate)),
    ]);
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let sums = facts(
        runs,
        &[
            ("grains at the start", &path("flow.at_start.grains", "")),
            ("grains at the end", &path("flow.at_end.grains", "")),
            ("grains inserted", &path("flow.inserted.grains", "")),
            ("grains removed", &path("flow.removed.grains", "")),
            ("mass inserted", &path("flow.inserted.mass", "kg")),
            ("mass removed", &path("flow.removed.mass", "kg")),
            ("mean mass flow in", &path("flow.mean_rate_in", "kg/s")),
            ("mean mass flow out", &path("flow.mean_rate_out", "kg/s")),
            ("mass flow in, second half of the run", &path("flow.later_rate_in", "kg/s")),
            ("mass flow out, second half of the run", &path("flow.later_rate_out", "kg/s")),
        ],
    );
    let mut rows = Vec::new();
    for run in runs {
        let name = |kind: &str, text: &str| match runs.len() {
            1 => format!("{kind} {text}"),
            _ => format!("{}: {kind} {text}", run.label),
        };
        for inlet in run.list("flow.inlets") {
            let amount = |key: &str, unit| Cell::of(inlet["amount"][key].as_f64(), unit);
            let head = name("inlet of", inlet["group"].as_str().unwrap_or_default());
            rows.push((head, vec![amount("grains", ""), amount("mass", "kg")]));
        }
        for outlet in run.list("flow.outlets") {
            let amount = |key: &str, unit| Cell::of(outlet["amount"][key].as_f64(), unit);
            let head = name("outlet", outlet["name"].as_str().unwrap_or_default());
            rows.push((head, vec![amount("grains", ""), amount("mass", "kg")]));
        }
    }
    Section::new("flow", "Inlets and outlets", joined([figures, sums, table(&["", "grains", "mass"], &rows)]))
}

fn rate(run: &RunData) -> Option<Vec<[f64; 2]>> {
    let points = run.table("history")?.points(history::TIME, history::MASS_OUT)?;
    let every = points.len().div_ceil(STRETCHES).max(1);
    let ends: Vec<&[f64; 2]> = points.iter().step_by(every).collect();
    let mean = |w: &[&[f64; 2]]| [0.5 * (w[0][0] + w[1][0]), (w[1][1] - w[0][1]) / (w[1][0] - w[0][0])];
    Some(ends.windows(2).filter(|w| w[1][0] > w[0][0]).map(mean).collect())
}
