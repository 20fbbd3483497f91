//! Comparison of runs: different keys and results.

use super::overlay::{Fact, facts};
use crate::data::RunData;
use crate::page::{Cell, Section, headed, joined, paragraph, table};
use maud::Markup;
use std::collections::BTreeSet;
use trackbed_io::columns::{Definition, Kind, Name, cycles, history};

const KEYS: usize = 60;

/// Compares several runs; none for one.
pub fn compare(runs: &[RunData]) -> Option<Section> {
    if runs.len() < 2 {
        return None;
    }
    Section::new("compare", "Comparison", joined([results(runs), different_keys(runs)]))
}

fn different_keys(runs: &[RunData]) -> Markup {
    let all: BTreeSet<&String> = runs.iter().flat_map(|r| r.keys.keys()).collect();
    let known = runs.iter().all(|r| !r.keys.is_empty());
    let differ = |key: &&String| runs.iter().any(|r| r.keys.get(*key) != runs[0].keys.get(*key));
    let rows: Vec<(String, Vec<Cell>)> = all
        .into_iter()
        .filter(differ)
        .take(KEYS)
        .map(|key| {
            let of = |r: &RunData| r.keys.get(key).map_or(Cell::Nothing, |v| Cell::Text(shown(v)));
            (key.clone(), runs.iter().map(of).collect())
        })
        .collect();
    if rows.is_empty() {
        let text = if known { "The scenes are identical." } else { "Not all runs have their scene file." };
        return paragraph(text);
    }
    let heads: Vec<&str> =
        std::iter::once("scene key").chain(runs.iter().map(|r| r.label.as_str())).collect();
    table(&heads, &rows)
}

/// Formats a scene value, unquoted and shortened.
pub fn shown(value: &str) -> String {
    let text = value.strip_prefix('"').and_then(|v| v.strip_suffix('"')).unwrap_or(value);
    match text.char_indices().nth(160) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text.into(),
    }
}

fn settlement_at(run: &RunData, cycle: f64) -> Option<f64> {
    let points = run.table("cycles")?.points(cycles::CYCLE, cycles::SETTLEMENT)?;
    points.iter().find(|p| p[0] == cycle).map(|p| p[1])
}

/// Returns the last value of a `cycles.csv` column.
pub fn last_of(run: &RunData, column: &'static Definition) -> Option<f64> {
    run.table("cycles")?.column(column)?.last().copied()
}

fn largest_of(run: &RunData, column: &'static Definition) -> Option<f64> {
    run.table("history")?.column(column)?.iter().copied().reduce(f64::max)
}

fn results(runs: &[RunData]) -> Markup {
    let last = runs.iter().filter_map(|r| last_of(r, cycles::CYCLE));
    let common = last.fold(f64::INFINITY, f64::min);
    let at_common = format!("settlement after cycle {common}");
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let cycle = |column: &'static Definition, unit: &'static str| {
        move |r: &RunData| Cell::of(last_of(r, column), unit)
    };
    let porosity = |r: &RunData| Cell::of(r.value("packing.measures.0.porosity").as_f64(), "");
    let wall = |r: &RunData| {
        let seconds = r.list("stages").iter().filter_map(|s| s["seconds"].as_f64());
        Cell::of((!r.list("stages").is_empty()).then(|| seconds.sum()), "s")
    };
    let sought = [
        differences(
            runs,
            &[
                (&at_common, &|r| Cell::of(settlement_at(r, common), "m")),
                ("resilient deflection in the last cycle", &cycle(cycles::RESILIENT_DEFLECTION, "m")),
                ("secant stiffness in the last cycle", &cycle(cycles::SECANT_STIFFNESS, "N/m")),
                ("resilient modulus in the last cycle", &cycle(cycles::RESILIENT_MODULUS, "Pa")),
                ("peak lateral resistance", &path("push.peak", "N")),
                ("strength of the specimen", &path("specimen.strength", "Pa")),
                ("factor of safety: stable at", &path("safety.stable_at", "")),
                ("factor of safety: unstable at", &path("safety.unstable_at", "")),
                ("largest pressure on the formation", &|r| {
                    Cell::of(largest_of(r, history::PEAK_FORMATION_PRESSURE), "Pa")
                }),
                ("largest displacement", &|r| {
                    Cell::of(r.value("statics.largest_displacement.0").as_f64(), "m")
                }),
            ],
        ),
        extremes(runs),
    ];
    let further = facts(
        runs,
        &[
            ("outcome", &|r: &RunData| r.text("verdict.outcome").map_or(Cell::Nothing, Cell::text)),
            ("cycles", &cycle(cycles::CYCLE, "")),
            ("settlement after the last cycle", &cycle(cycles::SETTLEMENT, "m")),
            ("energy dissipated in the last cycle", &cycle(cycles::DISSIPATED_ENERGY, "J")),
            ("coordination number at the end", &path("packing.coordination", "")),
            ("porosity of the first measuring box", &porosity),
            ("mean mass flow out", &path("flow.mean_rate_out", "kg/s")),
            ("bonds broken in tension", &path("bonds.broken_by_tension", "")),
            ("external work", &path("energy.work", "J")),
            ("largest energy error over reference energy", &path("energy.largest_relative_error", "")),
            ("wall time", &wall),
            ("CPU time", &path("cpu_seconds", "s")),
        ],
    );
    let whose = format!("Results, and differences from {} in per cent", runs[0].label);
    joined([headed(&whose, joined(sought)), headed("Run", further)])
}

/// Replaces values by their differences from the first run.
fn differences(runs: &[RunData], rows: &[Fact<'_>]) -> Markup {
    let first: Vec<Option<f64>> = rows
        .iter()
        .map(|(_, of)| match of(&runs[0]) {
            Cell::Value(v, _) if v != 0.0 => Some(v),
            _ => None,
        })
        .collect();
    type Of<'a> = Box<dyn Fn(&RunData) -> Cell + 'a>;
    let compared: Vec<(&str, Of<'_>)> = rows
        .iter()
        .zip(&first)
        .map(|((name, of), first)| {
            let of: Of<'_> = Box::new(move |run: &RunData| match (of(run), first) {
                (Cell::Value(v, unit), Some(first)) if !std::ptr::eq(run, &runs[0]) => {
                    Cell::Compared(v, unit, 100.0 * (v - first) / first.abs())
                }
                (cell, _) => cell,
            });
            (*name, of)
        })
        .collect();
    let rows: Vec<Fact<'_>> = compared.iter().map(|(name, of)| (*name, of.as_ref())).collect();
    facts(runs, &rows)
}

/// Columns whose extremes are compared: largest magnitude.
const EXTREMES: [(&Definition, &str); 3] = [
    (history::WALL_FORCE, "largest force on wall"),
    (history::PROBE_VERTICAL_STRESS, "largest mean vertical stress of probe"),
    (history::PROBE_STRESS, "largest vertical stress of probe"),
];

fn extremes(runs: &[RunData]) -> Markup {
    let mut rows: Vec<(String, Name<'_>)> = Vec::new();
    for (definition, what) in EXTREMES {
        let name = |item| if vector(definition) { definition.of(item).at(2) } else { definition.of(item) };
        let items = runs[0].table("history").map(|t| t.items(name(""))).unwrap_or_default();
        rows.extend(items.into_iter().map(|item| (format!("{what} {item}"), name(item))));
    }
    type Of<'a> = Box<dyn Fn(&RunData) -> Cell + 'a>;
    let facts: Vec<(String, Of<'_>)> = rows
        .into_iter()
        .map(|(text, column)| {
            let of: Of<'_> = Box::new(move |run: &RunData| {
                let values = run.table("history").and_then(|t| t.column(column));
                let largest = values.and_then(|v| v.iter().map(|x| x.abs()).reduce(f64::max));
                Cell::of(largest, column.unit())
            });
            (text, of)
        })
        .collect();
    let facts: Vec<Fact<'_>> = facts.iter().map(|(text, of)| (text.as_str(), of.as_ref())).collect();
    differences(runs, &facts)
}

/// Vertical components are compared.
fn vector(definition: &Definition) -> bool {
    !matches!(definition.kind, Kind::Scalar)
}
