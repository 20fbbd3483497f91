//! Run overview: counts, materials, options.

use super::compare::shown;
use super::overlay::facts;
use crate::data::RunData;
use crate::page::{self, Cell, Section, headed, joined, paragraph, table};
use maud::{Markup, html};
use std::collections::BTreeSet;
use std::path::Path;
use trackbed_io::columns::{cycles, history};

const ELSEWHERE: [&str; 3] = ["material", "title", "probe"];
/// The scene text is complete.
const OPTIONS: usize = 60;

/// Formats the overview.
pub fn overview(runs: &[RunData]) -> Option<Section> {
    let mut parts = vec![counts(runs)];
    for (kind, what) in [
        ("material", "Materials of grains, walls and sleepers"),
        ("solid.material", "Materials of the solid"),
    ] {
        parts.push(headed(what, materials(runs, kind)));
    }
    // Differing keys are shown in the comparison.
    let whose = if runs.len() > 1 { format!(" of {}", runs[0].label) } else { String::new() };
    parts.push(options(&runs[0], &whose));
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
            ("scene file", &|r| r.file.as_ref().map_or(Cell::Nothing, |f| path_cell(Path::new(&f.scene)))),
            ("folder", &|r| path_cell(&r.dir)),
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

fn path_cell(path: &Path) -> Cell {
    Cell::Text(page::shown_path(path).display().to_string())
}

fn materials(runs: &[RunData], kind: &str) -> Markup {
    let key_of = |key: &str| {
        let rest = key.strip_prefix(kind)?.strip_prefix('.')?;
        let (index, key) = rest.split_once('.')?;
        Some((index.parse::<usize>().ok()?, key.to_string()))
    };
    let all: BTreeSet<(usize, String)> =
        runs.iter().flat_map(|run| run.keys.keys().filter_map(|key| key_of(key))).collect();
    let named = |key: &str| matches!(key, "name" | "id");
    let keys: BTreeSet<&String> = all.iter().map(|a| &a.1).filter(|k| !named(k)).collect();
    let count = all.iter().map(|a| a.0 + 1).max().unwrap_or(0);
    let value = |run: &RunData, index: usize, key: &str| {
        run.keys.get(&format!("{kind}.{index}.{key}")).map(|value| shown(value))
    };
    let cell = |index: usize, key: &str| {
        let values: Vec<Option<String>> = runs.iter().map(|run| value(run, index, key)).collect();
        if values.iter().all(|v| *v == values[0]) {
            return values[0].clone().map_or(Cell::Nothing, Cell::Text);
        }
        let texts: Vec<String> = values.into_iter().map(|v| v.unwrap_or_else(|| "\u{2013}".into())).collect();
        Cell::Html(html! { mark { (texts.join(" | ")) } })
    };
    let rows: Vec<(String, Vec<Cell>)> = (0..count)
        .map(|i| {
            let of = |key: &str| runs.iter().find_map(|run| value(run, i, key));
            let name = match (of("name"), of("id")) {
                (Some(name), Some(id)) => format!("{id}: {name}"),
                (Some(name), None) => name,
                (None, id) => id.unwrap_or_else(|| i.to_string()),
            };
            (name, keys.iter().map(|key| cell(i, key)).collect())
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
