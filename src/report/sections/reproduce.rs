//! Command, scene, overrides and sources of the runs.

use crate::data::RunData;
use crate::page::{self, Section, paragraph};
use maud::{Markup, html};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use trackbed_run::quoted;

/// Formats the reproduction data.
pub fn reproduce(runs: &[RunData]) -> Option<Section> {
    let sources: BTreeSet<&str> =
        runs.iter().flat_map(|r| r.list("sources")).filter_map(Value::as_str).collect();
    let html = html! {
        @for run in runs {
            @if runs.len() > 1 { h3 { (run.label) } "\n" }
            (one(run))
        }
        @if !sources.is_empty() {
            h3 { "Sources of the methods" } "\n"
            ul { "\n" @for source in &sources { li { (source) } "\n" } } "\n"
        }
    };
    Section::new("reproduce", "Reproduction", html)
}

fn one(run: &RunData) -> Markup {
    let Some(file) = &run.file else { return Markup::default() };
    let [scene, dir] = [Path::new(&file.scene), &run.dir].map(page::shown_path);
    let mut command = format!("trackbed run {} --out {}", quoted(&scene), quoted(&dir));
    file.overrides.iter().for_each(|o| command += &format!(" --set {}", quoted(Path::new(o))));
    file.source().iter().for_each(|source| command += &source.arguments());
    let hash = match run.text("scene_hash") {
        Some(hash) => format!(
            "Version {} of the program; hash of the scene, its overrides and its files {hash}. Results are bitwise identical \
             for any number of threads.",
            file.version
        ),
        None => format!("Program version {}.", file.version),
    };
    html! {
        pre { (command) } "\n"
        (paragraph(&hash))
        details { "\n" summary { "Scene file, without overrides" } "\n" pre { (file.text) } "\n" } "\n"
        @for included in &file.included {
            details { "\n" summary { "Included file " (included.name) } "\n" pre { (included.text) } "\n" } "\n"
        }
    }
}
