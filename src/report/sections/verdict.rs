//! How the runs ended, what they were judged by and what they remark: first of all.

use crate::report::data::{RunData, State};
use crate::report::page::{Cell, Section, joined, table};
use crate::report::quantity::with_unit;
use maud::{Markup, html};
use serde_json::Value;

/// Verdict and warnings.
pub fn verdict(runs: &[RunData]) -> Option<Section> {
    let cards = joined(runs.iter().map(card));
    Section::new("verdict", "Verdict and warnings", joined([cards, judged(runs)]))
}

/// A run with its state and remarks.
fn card(run: &RunData) -> Markup {
    let remarks = remarks(run);
    let class = match run.state() {
        State::Passed if !remarks.is_empty() => "warned",
        State::Passed | State::Modes => "passed",
        State::Warned => "warned",
        State::Failed | State::Stopped => "failed",
        State::Interrupted | State::Running => "open",
    };
    html! {
        div class={ "run " (class) } {
            "\n" h3 { (run.label) } "\n"
            p { strong { (word(run)) } " " (sentence(run)) } "\n"
            @if !remarks.is_empty() {
                ul { "\n" @for remark in &remarks { li { (remark) } "\n" } } "\n"
            }
        }
        "\n"
    }
}

/// The verdict in a word.
fn word(run: &RunData) -> &'static str {
    match run.state() {
        State::Passed => "Passed.",
        State::Warned => "Warned.",
        State::Failed => "Failed.",
        State::Interrupted => "Interrupted.",
        State::Running => "Still running.",
        State::Stopped => "Stopped without a summary.",
        State::Modes => "Modes.",
    }
}

/// What it means for the figures below.
fn sentence(run: &RunData) -> String {
    let judged = run.list("verdict.judged").len();
    let reached = match run.table("history").and_then(|t| t.column("time")?.last().copied()) {
        Some(time) => format!(" The last row of the history is at t = {}.", with_unit(time, "s")),
        None => " There is no history.".into(),
    };
    let checkpoint = run.dir.join("checkpoint").is_dir();
    let on = if checkpoint { " A checkpoint is there: --resume goes on from it." } else { "" };
    match run.state() {
        State::Passed if judged == 0 => "The run is done; it has no account to judge.".into(),
        State::Passed => format!("The run is done, and its accounts close: {judged} judged, none remarked."),
        State::Warned => {
            let remarked = |list: &str, key: &str| {
                let list = run.list(list);
                list.iter().filter(|j| j[key] != "passed").count()
            };
            format!(
                "The run is done; warned about: {} of {judged} accounts and {} of {} checks of validity. Look at the results with care.",
                remarked("verdict.judged", "outcome"),
                remarked("validity", "status"),
                run.list("validity").len()
            )
        }
        State::Failed => {
            let status = run.text("status").unwrap_or_default();
            let status = if status == "done" {
                "an account or a check of validity says that there is no result"
            } else {
                status
            };
            let status = status.strip_prefix("failed: ").unwrap_or(status);
            format!("{status}. What is below is what was written until then.{reached}{on}")
        }
        State::Interrupted => format!("What is below is what was written until then.{reached}{on}"),
        State::Running => {
            let process = run.process().map_or(String::new(), |p| format!(" (process {p})"));
            format!(
                "A run writes to this folder{process}: what is below is what it has written so far.{reached}"
            )
        }
        State::Stopped => {
            format!(
                "The run was killed, or the machine went down: what is below was written until then.{reached}{on}"
            )
        }
        State::Modes => "Natural modes of the solid; they have no account to judge.".into(),
    }
}

/// Remarks of the run itself, and on its files.
fn remarks(run: &RunData) -> Vec<String> {
    let mut out = Vec::new();
    for j in run.list("verdict.judged").iter().filter(|j| j["outcome"] != "passed") {
        let outcome = j["outcome"].as_str().unwrap_or("warned");
        let number = |key: &str| j[key].as_f64().map_or("?".into(), |v| format!("{v:.3e}"));
        let what = j["what"].as_str().unwrap_or_default();
        out.push(format!(
            "{outcome}: {what} is {}, expected at most {}",
            number("value"),
            number("warn_above")
        ));
    }
    out.extend(run.list("warnings").iter().filter_map(Value::as_str).map(String::from));
    for (name, rows) in run.damaged() {
        out.push(format!("{name}.csv: {rows} rows are damaged and left out"));
    }
    if run.file.is_none() && run.state() != State::Modes {
        out.push(
            "the folder has no run.json, so the scene is not known: materials and options are left out"
                .into(),
        );
    } else if run.file.is_some() && run.scene.is_none() {
        out.push("this version does not understand the scene of the run: materials and options are as its text has them".into());
    }
    let version = run.text("version").or(run.file.as_ref().map(|f| f.version.as_str()));
    if let Some(version) = version.filter(|v| *v != env!("CARGO_PKG_VERSION")) {
        out.push(format!(
            "the results are of version {version}, this report is of version {}",
            env!("CARGO_PKG_VERSION")
        ));
    }
    out
}

/// The accounts and the checks of validity with their limits.
fn judged(runs: &[RunData]) -> Markup {
    let several = runs.len() > 1;
    let mut rows = Vec::new();
    for run in runs {
        for j in run.list("verdict.judged") {
            let what = j["what"].as_str().unwrap_or_default();
            let name = if several { format!("{}: {what}", run.label) } else { what.to_string() };
            let number = |key: &str| Cell::of(j[key].as_f64(), "");
            let outcome = Cell::text(j["outcome"].as_str().unwrap_or_default());
            rows.push((name, vec![number("value"), number("warn_above"), number("stop_above"), outcome]));
        }
        for c in run.list("validity") {
            let what = format!("validity: {}", c["name"].as_str().unwrap_or_default());
            let name = if several { format!("{}: {what}", run.label) } else { what };
            let number = |key: &str| Cell::of(c[key].as_f64(), "");
            let status = Cell::text(c["status"].as_str().unwrap_or_default());
            rows.push((name, vec![number("value"), number("limit"), number("fail_above"), status]));
        }
    }
    table(&["judged", "found", "remarked above", "no result above", "outcome"], &rows)
}
