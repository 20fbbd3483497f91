//! Machine-readable tables: `study.csv`, `study.json`.

use super::file::Norm;
use super::outcome::{Outcome, cpu};
use super::plan::Plan;
use super::quantity::Quantity;
use serde_json::json;

/// Returns a column header: name and unit.
pub fn head(quantity: &Quantity, unit: &str) -> String {
    if unit.is_empty() { quantity.name.clone() } else { format!("{} [{unit}]", quantity.name) }
}

/// Formats CSV.
///
/// # Errors
/// Never: writing to memory.
pub fn csv(plan: &Plan, outcome: &Outcome) -> Result<String, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    let mut heads = vec!["setting".to_string()];
    heads.extend(plan.axes.iter().cloned());
    heads.extend(["runs", "done"].map(String::from));
    for (quantity, unit) in plan.quantities.iter().zip(&outcome.units) {
        heads.push(head(quantity, unit));
        let unit = if quantity.norm == Norm::Absolute && !unit.is_empty() {
            format!(" [{unit}]")
        } else {
            String::new()
        };
        heads.push(format!("{} deviation", quantity.name));
        heads.push(format!("{} error{unit}", quantity.name));
        heads.push(format!("{} scatter{unit}", quantity.name));
    }
    let costs = ["within", "reasons", "steps", "cpu [s]", "wall [s]", "speed_up", "peak_memory [bytes]"];
    heads.extend(costs.map(String::from));
    out.write_record(&heads)?;
    let text = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
    for row in &outcome.rows {
        let mut cells = vec![row.setting.clone()];
        cells.extend((0..plan.axes.len()).map(|k| row.levels.get(k).cloned().unwrap_or_default()));
        cells.extend([row.runs.to_string(), row.done.to_string()]);
        for cell in &row.quantities {
            cells.extend([cell.value, cell.deviation, cell.error, cell.scatter].map(text));
        }
        cells.push(if row.within { "yes" } else { "no" }.into());
        cells.push(row.reasons.join("; "));
        let cost = row.cost.as_ref();
        cells.push(text(cost.map(|c| c.steps)));
        cells.extend([cpu(row), cost.map(|c| c.wall_seconds), row.speed_up].map(text));
        cells.push(cost.and_then(|c| c.peak_memory).map_or(String::new(), |m| m.to_string()));
        out.write_record(&cells)?;
    }
    let bytes = out.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Formats all results as JSON.
pub fn json(plan: &Plan, outcome: &Outcome) -> String {
    let quantity = |(q, unit): (&Quantity, &String)| {
        json!({
            "name": q.name,
            "unit": unit,
            "norm": if q.norm == Norm::Relative { "relative" } else { "absolute" },
            "tolerance": q.tolerance,
            "exact": q.exact,
        })
    };
    let label = |k: usize| outcome.rows[k].setting.clone();
    let value = json!({
        "title": plan.title,
        "scene": plan.scene,
        "axes": plan.axes,
        "quantities": plan.quantities.iter().zip(&outcome.units).map(quantity).collect::<Vec<_>>(),
        "reference": label(outcome.reference),
        "recommended": outcome.recommended.map(label),
        "front": outcome.front.iter().copied().map(label).collect::<Vec<_>>(),
        "settings": outcome.rows,
    });
    format!("{value:#}\n")
}
