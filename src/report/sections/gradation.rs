//! Sieve curves, logarithmic in size.

use super::overlay::overlay;
use crate::data::RunData;
use crate::page::{Section, columns, joined, plots};
use crate::plot::{Axis, figure};
use serde_json::Value;
use trackbed_io::columns::{Definition, gradation};

/// Plots target and achieved sieve curves.
pub fn gradation(runs: &[RunData]) -> Option<Section> {
    let curves = overlay(runs, |run| {
        let Some(table) = run.table("gradation") else { return Vec::new() };
        let (Some(groups), Some(sizes)) = (table.column(gradation::GROUP), table.column(gradation::SIEVE))
        else {
            return Vec::new();
        };
        let mut numbers = groups.to_vec();
        numbers.dedup();
        let mut out = Vec::new();
        for (g, number) in numbers.iter().enumerate() {
            let group = run.value(&format!("packing.gradations.{g}.group")).as_str();
            let head = group.filter(|_| numbers.len() > 1).map_or(String::new(), |g| format!("{g}: "));
            let shown: &[(&'static Definition, &str)] = match runs.len() {
                1 => &[
                    (gradation::ACHIEVED, "stones"),
                    (gradation::TARGET, "target"),
                    (gradation::LOWER_LIMIT, "lower limit"),
                    (gradation::UPPER_LIMIT, "upper limit"),
                ],
                _ => &[(gradation::ACHIEVED, "stones"), (gradation::TARGET, "target")],
            };
            for &(column, name) in shown {
                let Some(values) = table.column(column) else { continue };
                let own = (0..sizes.len()).filter(|&k| groups[k] == *number);
                out.push((format!("{head}{name}"), own.map(|k| [sizes[k], 100.0 * values[k]]).collect()));
            }
        }
        out
    });
    let y = Axis::new("passing by mass", "%").with_zero();
    let figure = figure("Sieve curves", Axis::new("sieve", "m").logarithmic(), y, curves);
    let mut names = Vec::new();
    let mut found: Vec<&Value> = Vec::new();
    for run in runs {
        for g in run.list("packing.gradations") {
            let group = g["group"].as_str().unwrap_or_default();
            names.push(if runs.len() > 1 { format!("{}: {group}", run.label) } else { group.into() });
            found.push(g);
        }
    }
    let of = |key: &str| found.iter().map(|g| g[key].as_f64()).collect();
    let figures =
        [("stones", "", of("stones")), ("largest deviation of mass passing", "", of("largest_deviation"))];
    let html = plots([figure]);
    if html.0.is_empty() {
        return None;
    }
    Section::new("gradation", "Sieve curves", joined([html, columns("group", &names, &figures)]))
}
