//! Run overview: counts, materials, options.

use super::compare::shown;
use super::overlay::facts;
use crate::columns::{cycles, history};
use crate::report::data::RunData;
use crate::report::page::{Cell, Section, headed, joined, paragraph, table};
use maud::Markup;
use std::collections::BTreeSet;

const ELSEWHERE: [&str; 3] = ["material", "title", "probe"];
/// The scene text is complete.
const OPTIONS: usize = 60;

/// Formats the overview.
pub fn overview(runs: &[RunData]) -> Option<Section> {
    let mut parts = vec![counts(runs)];
    // Differing materials are shown in the comparison.
    let alike = |run: &RunData| run.keys == runs[0].keys;
    let shown: Vec<&RunData> = if runs.iter().all(alike) { vec![&runs[0]] } else { runs.iter().collect() };
    for run in shown {
        let whose = if runs.len() > 1 && !runs.iter().all(alike) {
            format!(" of {}", run.label)
        } else {
            String::new()
        };
        for (kind, what) in [
            ("material", "Materials of grains, walls and sleepers"),
            ("solid.material", "Materials of the solid"),
        ] {
            parts.push(headed(&format!("{what}{whose}"), materials(run, kind)));
        }
        parts.push(options(run, &whose));
    }
    Section::new("overview", "Scene and model", joined(parts))
}

fn counts(runs: &[RunData]) -> Markup {
    let path = |path: &'static str, unit: &'static str| {
        move |r: &RunData| Cell::of(r.number(path).filter(|v| *v > 0.0), unit)
    };
    let wall = |r: &RunData| {
        let seconds = r.list("stages").iter().filter_map(|s| s["seconds"].as_f64());
        Cell::of((!r.list("stages").is_empty()).then(|| seconds.sum()), "s")
    };
    let text = |text: Option<&str>| text.map_or(Cell::Nothing, Cell::text);
    facts(
        runs,
        &[
            ("scene", &|r| text(Some(r.title()))),
            ("scene file", &|r| text(r.file.as_ref().map(|f| f.scene.as_str()))),
            ("folder", &|r| Cell::Text(r.dir.display().to_string())),
            ("status", &|r| text(r.text("status"))),
            ("program version", &|r| text(r.text("version").or(r.file.as_ref().map(|f| f.version.as_str())))),
            ("nodes", &path("model.nodes", "")),
            ("elements", &path("model.elements", "")),
            ("degrees of freedom", &path("model.unknowns", "")),
            ("bodies (grains and sleepers)", &path("model.bodies", "")),
            ("spheres", &path("model.spheres", "")),
            ("simulated time", &|r| {
                Cell::of(r.table("history").and_then(|t| t.column(history::TIME)?.last().copied()), "s")
            }),
            ("load cycles", &|r| Cell::of(super::compare::last_of(r, cycles::CYCLE), "")),
            ("threads", &path("threads", "")),
            ("wall time", &wall),
            ("CPU time", &path("cpu_seconds", "s")),
            ("peak memory", &path("peak_memory", "B")),
        ],
    )
}

fn materials(run: &RunData, kind: &str) -> Markup {
    let key_of = |key: &str| {
        let rest = key.strip_prefix(kind)?.strip_prefix('.')?;
        let (index, key) = rest.split_once('.')?;
        Some((index.parse::<usize>().ok()?, key.to_string()))
    };
    let all: Vec<(usize, String, &String)> =
        run.keys.iter().filter_map(|(k, v)| key_of(k).map(|(index, key)| (index, key, v))).collect();
    let named = |key: &str| matches!(key, "name" | "id");
    let keys: BTreeSet<&String> = all.iter().map(|a| &a.1).filter(|k| !named(k)).collect();
    let count = all.iter().map(|a| a.0 + 1).max().unwrap_or(0);
    let value = |index: usize, key: &str| all.iter().find(|a| a.0 == index && a.1 == key).map(|a| shown(a.2));
    let rows: Vec<(String, Vec<Cell>)> = (0..count)
        .map(|i| {
            let name = match (value(i, "name"), value(i, "id")) {
                (Some(name), Some(id)) => format!("{id}: {name}"),
                (Some(name), None) => name,
                (None, id) => id.unwrap_or_else(|| i.to_string()),
            };
            (name, keys.iter().map(|key| value(i, key).map_or(Cell::Nothing, Cell::Text)).collect())
        })
        .collect();
    let heads: Vec<&str> = std::iter::once("material").chain(keys.iter().map(|k| k.as_str())).collect();
    table(&heads, &rows)
}

fn options(run: &RunData, whose: &str) -> Markup {
    let elsewhere = |key: &str| {
        let first = key.split('.').next().unwrap_or(key);
        ELSEWHERE.contains(&first) || key.starts_with("solid.material.")
    };
    let mut tables: Vec<(&str, Vec<String>)> = Vec::new();
    for (key, value) in run.keys.iter().filter(|(key, _)| !elsewhere(key)) {
        let (name, key) = key.rsplit_once('.').unwrap_or(("scene", key));
        let text = format!("{key} = {}", shown(value));
        match tables.iter_mut().find(|t| t.0 == name) {
            Some((_, keys)) => keys.push(text),
            None => tables.push((name, vec![text])),
        }
    }
    let shown = tables.iter().take(OPTIONS);
    let rows: Vec<(String, Vec<Cell>)> =
        shown.map(|(name, keys)| (name.to_string(), vec![Cell::Text(keys.join(", "))])).collect();
    let rest = match tables.len().saturating_sub(OPTIONS) {
        0 => Markup::default(),
        rest => paragraph(&format!("{rest} more tables in the scene below.")),
    };
    let table = table(&["table", "keys"], &rows);
    headed(&format!("Options of the scene{whose}"), joined([table, rest]))
}
