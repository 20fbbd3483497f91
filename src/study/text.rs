//! Readable tables of errors and costs.

use super::file::Norm;
use super::layout::{self, four_digits};
use super::outcome::{Cell, Outcome, Row, cpu};
use super::plan::Plan;
use super::quantity::Quantity;
use super::table::head;

/// Formats the Markdown table.
pub fn markdown(plan: &Plan, outcome: &Outcome) -> String {
    let mut text = format!("# {}\n\n", plan.title.replace('\n', " "));
    text += &format!(
        "Scene `{}`, {} cases, {} runs. Errors are against `{}`{}; CPU time is user and system time of one run, on all its threads.\n\n",
        plan.scene.display(),
        outcome.rows.len(),
        plan.runs.len(),
        outcome.rows[outcome.reference].case,
        exact_words(plan),
    );
    let rows = cells(plan, outcome, usize::MAX);
    text += &layout::markdown(&rows);
    text += &format!("\n{}\n\n{}\n", front(outcome), recommendation(plan, outcome));
    if outcome.rows.iter().any(|row| row.quantities.iter().any(|c| c.error_standard_error.is_some())) {
        text += "\n± is the standard error over the seeds. An error below it is not significant.\n";
    }
    let remarks = remarks(plan, outcome);
    if !remarks.is_empty() {
        text += "\n";
        remarks.iter().for_each(|remark| text += &format!("* {remark}\n"));
    }
    text
}

fn exact_words(plan: &Plan) -> String {
    let known: Vec<&str> =
        plan.quantities.iter().filter(|q| q.exact.is_some()).map(|q| q.name.as_str()).collect();
    if known.is_empty() { String::new() } else { format!(", of {} against known values", known.join(", ")) }
}

/// Formats the first rows for a terminal.
pub fn printed(plan: &Plan, outcome: &Outcome, most: usize) -> String {
    let rows = cells(plan, outcome, most);
    let mut text = layout::aligned(&rows, |k| k == 1);
    if outcome.rows.len() > most {
        text += &format!("  … {} more in study.md\n", outcome.rows.len() - most);
    }
    text
}

fn cells(plan: &Plan, outcome: &Outcome, most: usize) -> Vec<Vec<String>> {
    let mut heads = vec!["#".to_string(), "case".to_string()];
    for (quantity, unit) in plan.quantities.iter().zip(&outcome.units) {
        heads.extend([head(quantity, unit), "error".into()]);
    }
    heads.extend(["steps", "CPU [s]", "speed-up"].map(String::from));
    let row = |(k, row): (usize, &Row)| {
        let mark = if outcome.recommended == Some(k) { "*" } else { "" };
        let mut cells = vec![format!("{}{mark}", k + 1), row.case.clone()];
        for (cell, quantity) in row.quantities.iter().zip(&plan.quantities) {
            cells.push(cell.value.map_or("–".into(), four_digits));
            cells.push(error_text(cell, quantity));
        }
        cells.push(row.cost.as_ref().map_or("–".into(), |c| format!("{:.0}", c.steps)));
        cells.push(cpu(row).map_or("–".into(), |s| format!("{s:.2}")));
        cells.push(row.speed_up.map_or("–".into(), |s| format!("{s:.2}")));
        cells
    };
    std::iter::once(heads).chain(outcome.rows.iter().enumerate().take(most).map(row)).collect()
}

fn error_text(cell: &Cell, quantity: &Quantity) -> String {
    let text = |value: f64| match quantity.norm {
        Norm::Relative => percent(value),
        Norm::Absolute => four_digits(value),
    };
    match (cell.error, cell.error_standard_error) {
        (None, _) => "–".into(),
        (Some(error), None) => text(error),
        (Some(error), Some(own)) => {
            let mark = if cell.significant { "" } else { ", not significant" };
            format!("{} ± {}{mark}", text(error), text(own))
        }
    }
}

fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent.abs() {
        0.0 => "0 %".into(),
        p if p < 0.01 => format!("{percent:.1e} %"),
        p if p < 10.0 => format!("{percent:.2} %"),
        _ => format!("{percent:.1} %"),
    }
}

fn plain_percent(share: f64) -> String {
    let text = format!("{:.6}", 100.0 * share);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// Formats the Pareto front, cheapest case first.
pub fn front(outcome: &Outcome) -> String {
    let case = |k: &usize| {
        let row = &outcome.rows[*k];
        let over = row.error_over_tolerance.map_or("–".into(), four_digits);
        format!("\"{}\" ({} s, {over})", row.case, cpu(row).map_or("–".into(), |s| format!("{s:.2}")))
    };
    if outcome.front.is_empty() {
        return "No Pareto front: no case has an error.".into();
    }
    let cases: Vec<String> = outcome.front.iter().map(case).collect();
    format!("Pareto front, with CPU time and largest error in tolerances: {}.", cases.join(", "))
}

/// Formats the recommendation.
pub fn recommendation(plan: &Plan, outcome: &Outcome) -> String {
    let uniform = plan.quantities.iter().all(|q| q.norm == Norm::Relative && q.tolerance == plan.tolerance);
    let within = if uniform {
        format!("within {}", plain_percent(plan.tolerance))
    } else {
        "within the tolerances".into()
    };
    let reference = &outcome.rows[outcome.reference];
    let Some(k) = outcome.recommended else {
        return format!("No case is {within} for all quantities.");
    };
    let row = &outcome.rows[k];
    let others = outcome.rows.iter().enumerate().any(|(k, row)| k != outcome.reference && row.within);
    if k == outcome.reference && !others && outcome.rows.len() > 1 {
        return format!("No case but the reference \"{}\" is {within} for all quantities.", reference.case);
    }
    let largest = row.quantities.iter().zip(&plan.quantities).max_by(|a, b| {
        let over = |(cell, quantity): &(&Cell, &Quantity)| cell.error.unwrap_or(0.0) / quantity.tolerance;
        over(a).total_cmp(&over(b))
    });
    let largest =
        largest.map_or(String::new(), |(c, q)| format!("; largest error {} ({})", error_text(c, q), q.name));
    let speed = match row.speed_up {
        _ if k == outcome.reference => ", the reference itself".to_string(),
        Some(speed) => format!(", {speed:.2} times as fast as the reference"),
        None => String::new(),
    };
    let cost = cpu(row).map_or(String::new(), |s| format!(": CPU time {s:.2} s{speed}"));
    format!("Cheapest case {within}: \"{}\"{cost}{largest}.", row.case)
}

/// Returns notes on the rows.
pub fn remarks(plan: &Plan, outcome: &Outcome) -> Vec<String> {
    let mut remarks = Vec::new();
    for row in &outcome.rows {
        remarks.extend(row.reasons.iter().map(|reason| format!("not in the table: {reason}")));
        for (cell, quantity) in row.quantities.iter().zip(&plan.quantities) {
            if let Some(remark) = cell.remark.as_ref().filter(|_| row.done > 0) {
                remarks.push(format!("{}, {}: {remark}", row.case, quantity.name));
            }
        }
    }
    remarks
}
