//! How the results come again: command, scene, overrides, sources.

use crate::report::data::RunData;
use crate::report::page::{Section, escaped, paragraph};
use crate::run::quoted;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// How to reproduce the runs.
pub fn reproduce(runs: &[RunData]) -> Option<Section> {
    let mut html = String::new();
    for run in runs {
        if runs.len() > 1 {
            html += &format!("<h3>{}</h3>\n", escaped(&run.label));
        }
        html += &one(run);
    }
    let sources: BTreeSet<&str> =
        runs.iter().flat_map(|r| r.list("sources")).filter_map(Value::as_str).collect();
    if !sources.is_empty() {
        html += "<h3>Sources of the methods</h3>\n<ul>\n";
        sources.iter().for_each(|s| html += &format!("<li>{}</li>\n", escaped(s)));
        html += "</ul>\n";
    }
    Section::new("reproduce", "How to reproduce", html)
}

fn one(run: &RunData) -> String {
    let Some(file) = &run.file else { return String::new() };
    let mut command = format!("trackbed run {} --out {}", quoted(Path::new(&file.scene)), quoted(&run.dir));
    file.overrides.iter().for_each(|o| command += &format!(" --set {}", quoted(Path::new(o))));
    file.source().iter().for_each(|source| command += &source.words());
    let hash = match run.text("scene_hash") {
        Some(hash) => format!(
            "Version {} of the program; hash of the scene, its overrides and its files {hash}. The same scene gives the same bits \
             on any number of threads; paths are as they were given when the run began.",
            file.version
        ),
        None => format!("Version {} of the program.", file.version),
    };
    format!(
        "<pre>{}</pre>\n{}<details>\n<summary>Text of the scene, without overrides</summary>\n<pre>{}</pre>\n</details>\n",
        escaped(&command),
        paragraph(&hash),
        escaped(&file.text)
    )
}
