//! Status, checks and warnings of the runs.

use crate::data::{RunData, State};
use crate::page::{Cell, Section, joined, table};
use crate::quantity::with_unit;
use maud::{Markup, html};
use serde_json::Value;
use trackbed_io::columns::history;

/// Formats checks and warnings.
pub fn verdict(runs: &[RunData]) -> Option<Section> {
    let mut order: Vec<&RunData> = runs.iter().collect();
    order.sort_by_key(|run| severity(run));
    let cards = joined(order.into_iter().map(card));
    Section::new("verdict", "Checks and warnings", joined([cards, judged(runs)]))
}

/// Failed runs come first.
fn severity(run: &RunData) -> usize {
    ["failed", "open", "warned", "passed"].iter().position(|c| *c == class(run)).unwrap_or(0)
}

fn class(run: &RunData) -> &'static str {
    match run.state() {
        State::Passed if !remarks(run).is_empty() => "warned",
        State::Passed | State::Modes => "passed",
        State::Warned => "warned",
        State::Failed | State::Stopped => "failed",
        State::Interrupted | State::Running => "open",
    }
}

fn card(run: &RunData) -> Markup {
    let (remarks, class) = (remarks(run), class(run));
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

fn word(run: &RunData) -> &'static str {
    match run.state() {
        State::Passed => "Passed.",
        State::Warned => "Warned.",
        State::Failed => "Failed.",
        State::Interrupted => "Interrupted.",
        State::Running => "Still running.",
        State::Stopped => "No summary.",
        State::Modes => "Modes.",
    }
}

fn sentence(run: &RunData) -> String {
    let judged = run.list("verdict.checks").len();
    let reached = match run.table("history").and_then(|t| t.column(history::TIME)?.last().copied()) {
        Some(time) => format!(" Last row of the history: t = {}.", with_unit(time, "s")),
        None => " No history.".into(),
    };
    let checkpoint = run.dir.join("checkpoint").is_dir();
    let on = if checkpoint { " A checkpoint exists: resume with --resume." } else { "" };
    match run.state() {
        State::Passed if judged == 0 => "Run completed; no balances to check.".into(),
        State::Passed => format!("Run completed; {judged} balances checked, no warnings."),
        State::Warned => {
            let remarked = |list: &str, key: &str| {
                let list = run.list(list);
                list.iter().filter(|j| j[key] != "passed").count()
            };
            format!(
                "Run completed with warnings: {} of {judged} balances and {} of {} validity checks exceed their warning limit.",
                remarked("verdict.checks", "outcome"),
                remarked("validity", "status"),
                run.list("validity").len()
            )
        }
        State::Failed => {
            let status = run.text("status").unwrap_or_default();
            let status = if status == "done" {
                "a balance or validity check exceeds its failure limit"
            } else {
                status
            };
            let status = status.strip_prefix("failed: ").unwrap_or(status);
            format!("{status}. Results up to the last output.{reached}{on}")
        }
        State::Interrupted => format!("Results up to the last output.{reached}{on}"),
        State::Running => {
            let process = run.process().map_or(String::new(), |p| format!(" (process {p})"));
            format!("Run in progress{process}. Results up to the last output.{reached}")
        }
        State::Stopped => {
            format!("The run was killed. Results up to the last output.{reached}{on}")
        }
        State::Modes => "Natural modes of the solid; no balances to check.".into(),
    }
}

fn remarks(run: &RunData) -> Vec<String> {
    let mut out = Vec::new();
    for j in run.list("verdict.checks").iter().filter(|j| j["outcome"] != "passed") {
        let outcome = j["outcome"].as_str().unwrap_or("warned");
        let number = |key: &str| j[key].as_f64().map_or("?".into(), |v| format!("{v:.3e}"));
        let what = j["name"].as_str().unwrap_or_default();
        out.push(format!("{outcome}: {what}: {} (limit {})", number("value"), number("warn_above")));
    }
    let failed = |text: &str| {
        run.list("validity").iter().any(|c| c["status"] == "failed" && c["message"].as_str() == Some(text))
    };
    out.extend(
        run.list("warnings")
            .iter()
            .filter_map(Value::as_str)
            .map(|text| if failed(text) { format!("failed: {text}") } else { text.to_string() }),
    );
    out.sort_by_key(|remark| !remark.starts_with("failed"));
    for (name, rows) in run.damaged() {
        out.push(format!("{name}.csv: {rows} damaged rows omitted"));
    }
    if run.file.is_none() && run.state() != State::Modes {
        out.push("run.json is missing: materials and options of the scene are omitted".into());
    } else if run.file.is_some() && run.scene.is_none() {
        out.push("scene of another program version: materials and options as in its text".into());
    }
    let version = run.text("version").or(run.file.as_ref().map(|f| f.version.as_str()));
    if let Some(version) = version.filter(|v| *v != env!("CARGO_PKG_VERSION")) {
        out.push(format!(
            "results of program version {version}, report of version {}",
            env!("CARGO_PKG_VERSION")
        ));
    }
    out
}

fn judged(runs: &[RunData]) -> Markup {
    let several = runs.len() > 1;
    let mut rows = Vec::new();
    for run in runs {
        for j in run.list("verdict.checks") {
            let what = j["name"].as_str().unwrap_or_default();
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
    table(&["check", "computed", "warning limit", "failure limit", "outcome"], &rows)
}
